// Toggles of the overlays that make sense for the clip, with the scale of the arrows that are on.
import overlay_style from "../../../src/overlay/overlay_style.json";
import { contact_states, type ArrowQuantity, type Clip, type OverlayName, type Run } from "../data/clip.ts";
import { text_of } from "../texts/texts.ts";
import { h } from "./dom.ts";
import { short_text } from "./format.ts";
import type { PlayerState } from "./player_state.ts";

interface OverlayKind {
  name: OverlayName;
  quantity?: ArrowQuantity;
  makes_sense(run: Run): boolean;
}

const arrow_unit = (quantity: ArrowQuantity) => overlay_style.arrows.find(({ name }) => name === quantity)!.unit;
const always = (): boolean => true;
const dynamic = (run: Run): boolean => run.scene.bodies.some((body) => body.type === "dynamic");
const has_contacts = (run: Run): boolean => run.contacts.a.length > 0;
const turns = (run: Run): boolean => run.scene.bodies.some((body, index) =>
  body.type !== "fixed" && [0, 0.25, 0.5, 0.75, 1].some((part) =>
    run.motion.state(index, part * run.duration).angular_velocity.some((component) => Math.abs(component) > 1e-9)));
const sleeps = (run: Run): boolean => run.contacts.state.includes(contact_states.indexOf("asleep")) ||
  run.scene.bodies.some((body, index) => body.type === "dynamic" && run.motion.state(index, run.duration).asleep);

const kinds: OverlayKind[] = [
  { name: "velocity", quantity: "velocity", makes_sense: dynamic },
  { name: "omega", quantity: "omega", makes_sense: turns },
  { name: "momentum", quantity: "momentum", makes_sense: dynamic },
  { name: "angular-momentum", quantity: "angular-momentum", makes_sense: turns },
  { name: "impulses", quantity: "impulse", makes_sense: (run) => run.impacts.length > 0 },
  { name: "forces", quantity: "force", makes_sense: has_contacts },
  { name: "loads", quantity: "force", makes_sense: dynamic },
  { name: "contacts", makes_sense: has_contacts },
  { name: "normals", makes_sense: has_contacts },
  { name: "trails", makes_sense: dynamic },
  { name: "ghosts", makes_sense: dynamic },
  { name: "com", makes_sense: dynamic },
  { name: "axes", makes_sense: dynamic },
  { name: "aabb", makes_sense: always },
  { name: "joints", makes_sense: (run) => run.joint_marks.length > 0 },
  { name: "cracks", makes_sense: (run) => run.cracks.length > 0 },
  { name: "islands", makes_sense: has_contacts },
  { name: "sleep", makes_sense: sleeps },
  { name: "names", makes_sense: always },
];

/** At first only these and the ones that are on; the others behind "More". */
const common: OverlayName[] = ["velocity", "momentum", "angular-momentum", "omega", "impulses", "forces", "joints", "cracks", "contacts", "trails"];

function overlays_of(clip: Clip): OverlayName[] {
  return kinds.filter((kind) => clip.runs.some((run) => kind.makes_sense(run))).map((kind) => kind.name);
}

export function build_overlay_chips(state: PlayerState): HTMLElement {
  const offered = overlays_of(state.clip);
  const settings = state.run.overlays;
  const toggle = (name: OverlayName): void => {
    const overlays = new Set(state.get("overlays"));
    if (!overlays.delete(name)) overlays.add(name);
    state.set({ overlays });
  };
  const chips = kinds.filter((kind) => offered.includes(kind.name)).map((kind) => {
    const color = kind.quantity ? settings.color[kind.quantity] : null;
    const button = h("button", { type: "button", class: "tp-chip", "data-overlay": kind.name, onclick: () => toggle(kind.name) },
      h("span", { class: "tp-swatch", style: color ? `--swatch: ${color}` : null }), text_of(`overlay_${kind.name}`));
    const rare = !common.includes(kind.name) && !state.get("overlays").has(kind.name);
    if (rare) button.dataset.rare = "";
    return { kind, button };
  });
  const legend = h("p", { class: "tp-legend" });
  const list = h("div", { class: "tp-chip-list", role: "group", "aria-label": text_of("overlays") }, ...chips.map((chip) => chip.button));
  if (chips.some((chip) => "rare" in chip.button.dataset)) {
    const more = h("button", {
      type: "button", class: "tp-chip tp-more", "aria-expanded": "false",
      onclick: () => {
        const open = list.classList.toggle("tp-open");
        more.setAttribute("aria-expanded", String(open));
        more.textContent = text_of(open ? "fewer" : "more");
      },
    }, text_of("more"));
    list.append(more);
  }

  const show = (): void => {
    const on = state.get("overlays");
    const scales = new Map<string, string>();
    for (const { kind, button } of chips) {
      button.setAttribute("aria-pressed", String(on.has(kind.name)));
      if (!on.has(kind.name) || !kind.quantity) continue;
      const scale = state.run.overlays.scale[kind.quantity];
      if (scale > 0) scales.set(kind.quantity, `${short_text(1 / scale)} ${arrow_unit(kind.quantity)}`);
    }
    legend.replaceChildren(...[...scales].map(([quantity, text]) => h("span", {},
      h("span", { class: "tp-arrow", style: `--swatch: ${settings.color[quantity as ArrowQuantity]}` }), text_of("arrow_scale", { scale: text }))));
    legend.hidden = scales.size === 0;
  };
  state.on(["overlays", "run"], show);
  show();
  return h("div", { class: "tp-overlays" }, list, legend);
}
