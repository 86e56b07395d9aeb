// The choice of the run and of the comparison, the chosen body, and the buttons of the view.
import { h } from "./dom.ts";
import type { CompareMode, PlayerState } from "./player_state.ts";
import type { StageView } from "./stage_view.ts";
import { icon_button } from "./transport.ts";
import { term_of, text_of } from "../texts/texts.ts";

const modes: { mode: CompareMode; label: string }[] = [
  { mode: "single", label: text_of("one") },
  { mode: "ghost", label: text_of("ghosts") },
  { mode: "side-by-side", label: text_of("side_by_side") },
];
/** More runs become a list. */
const most_segments = 5;

/** Buttons of which one is pressed. */
function segments<T>(label: string, values: { value: T; label: string; swatch?: number }[], chosen: () => T, choose: (value: T) => void):
    { element: HTMLElement; show: () => void } {
  const buttons = values.map(({ value, label: text, swatch }) =>
    h("button", { type: "button", class: "tp-segment", onclick: () => choose(value) },
      swatch === undefined ? null : h("span", { class: `tp-run-swatch tp-run-${swatch % 7}` }), text));
  const show = (): void => {
    for (const [index, button] of buttons.entries()) button.setAttribute("aria-pressed", String(values[index].value === chosen()));
  };
  return { element: h("div", { class: "tp-segments", role: "group", "aria-label": label }, ...buttons), show };
}

function run_label(state: PlayerState, index: number): string {
  return state.clip.runs[index].label || text_of("run_number", { number: index + 1 });
}

export function build_run_bar(state: PlayerState): HTMLElement | null {
  const runs = state.clip.runs;
  if (runs.length < 2) return null;
  const compare = segments(text_of("comparison"), modes.map(({ mode, label }) => ({ value: mode, label })),
    () => state.get("compare"), (mode) => state.set({ compare: mode }));
  let choice: { element: HTMLElement; show: () => void };
  if (runs.length <= most_segments) {
    choice = segments(text_of("run"), runs.map((_, index) => ({ value: index, label: run_label(state, index), swatch: index })),
      () => state.get("run"), (run) => state.set({ run }));
  } else {
    const select = h("select", { class: "tp-select", "aria-label": text_of("run"), onchange: () => state.set({ run: Number(select.value) }) },
      ...runs.map((_, index) => h("option", { value: index }, run_label(state, index))));
    choice = { element: select, show: () => { select.value = String(state.get("run")); } };
  }
  const show = (): void => { choice.show(); compare.show(); };
  state.on(["run", "compare"], show);
  show();
  return h("div", { class: "tp-runs" }, choice.element, compare.element);
}

export function build_body_select(state: PlayerState): HTMLSelectElement {
  const select = h("select", {
    class: "tp-select", "aria-label": text_of("body"), title: `${text_of("body")} (n)`, onchange: () => state.set({ body: Number(select.value) }),
  });
  const fill = (): void => {
    select.replaceChildren(...state.run.scene.bodies.map((body, index) =>
      h("option", { value: index }, body.type === "dynamic" ? body.name : `${body.name} (${term_of(body.type)})`)));
    show();
  };
  const show = (): void => { select.value = String(state.get("body") ?? -1); };
  state.on(["run"], fill);
  state.on(["body"], show);
  fill();
  return select;
}

export function build_view_buttons(state: PlayerState, view: StageView, full_screen: () => void): HTMLElement {
  const follow = icon_button("follow", text_of("follow"), "f", () => state.set({ follow: !state.get("follow") }));
  const show = (): void => follow.setAttribute("aria-pressed", String(state.get("follow")));
  state.on(["follow"], show);
  show();
  return h("div", { class: "tp-view-buttons", role: "group", "aria-label": text_of("view") },
    follow,
    icon_button("reset", text_of("reset_view"), "r", () => reset_view(state, view)),
    document.fullscreenEnabled && icon_button("full_screen", text_of("full_screen"), `${text_of("key_shift")} + f`, full_screen));
}

export function reset_view(state: PlayerState, view: StageView): void {
  state.set({ follow: false });
  view.awake?.reset_view();
}
