// Keys of the focused player. One table serves the keyboard and the help.
import type { Actions } from "./actions.ts";
import type { PlayerState } from "./player_state.ts";
import { text_of } from "../texts/texts.ts";
import type { StageView } from "./stage_view.ts";
import { reset_view } from "./toolbar.ts";

export interface KeyTargets {
  state: PlayerState;
  actions: Actions;
  view: StageView;
  /** The first control of a part: overlays or panels. */
  focus(part: "overlays" | "panels"): void;
  full_screen(): void;
  show_help(): void;
}

interface KeyBinding {
  /** As in KeyboardEvent.key, after the modifiers in this order: alt+shift+ArrowLeft. */
  keys: string[];
  shown: string;
  does: string;
  run(targets: KeyTargets, key: string): void;
}

const shift_key = text_of("key_shift");
const turn = 0.08;
const shift = 0.04;
const zoom_step = 0.85;

export const key_bindings: KeyBinding[] = [
  { keys: [" "], shown: text_of("key_space"), does: text_of("do_play"), run: (t) => t.actions.toggle_play() },
  { keys: ["ArrowLeft", "ArrowRight"], shown: "\u2190 \u2192", does: text_of("do_frame"),
    run: (t, key) => t.actions.step_frame(key.endsWith("Right") ? 1 : -1) },
  { keys: ["shift+ArrowLeft", "shift+ArrowRight"], shown: `${shift_key} + \u2190 \u2192`, does: text_of("do_impact"),
    run: (t, key) => t.actions.step_impact(key.endsWith("Right") ? 1 : -1) },
  { keys: ["Home", "End"], shown: `${text_of("key_home")}, ${text_of("key_end")}`, does: text_of("do_ends"),
    run: (t, key) => t.actions.seek(key === "Home" ? 0 : t.state.duration) },
  { keys: ["ArrowUp", "ArrowDown"], shown: "\u2191 \u2193", does: text_of("do_speed"),
    run: (t, key) => t.actions.change_speed(key.endsWith("Up") ? 1 : -1) },
  { keys: ["l"], shown: "l", does: text_of("do_loop"), run: (t) => t.state.set({ loop: !t.state.get("loop") }) },
  { keys: ["b"], shown: "b", does: text_of("do_before"), run: (t) => t.actions.toggle_before() },
  { keys: ["n", "shift+N"], shown: `n, ${shift_key} + n`, does: text_of("do_body"),
    run: (t, key) => t.actions.choose_body(key === "n" ? 1 : -1) },
  { keys: ["alt+ArrowLeft", "alt+ArrowRight", "alt+ArrowUp", "alt+ArrowDown"], shown: `alt + ${text_of("key_arrows")}`, does: text_of("do_orbit"),
    run: (t, key) => {
      t.view.awake?.orbit(key.endsWith("Left") ? -turn : key.endsWith("Right") ? turn : 0,
        key.endsWith("Up") ? -turn : key.endsWith("Down") ? turn : 0);
    } },
  { keys: ["alt+shift+ArrowLeft", "alt+shift+ArrowRight", "alt+shift+ArrowUp", "alt+shift+ArrowDown"],
    shown: `alt + ${shift_key} + ${text_of("key_arrows")}`, does: text_of("do_pan"),
    run: (t, key) => {
      t.view.awake?.pan(key.endsWith("Left") ? -shift : key.endsWith("Right") ? shift : 0,
        key.endsWith("Up") ? shift : key.endsWith("Down") ? -shift : 0);
    } },
  { keys: ["+", "shift++", "=", "-"], shown: "+ \u2212", does: text_of("do_zoom"),
    run: (t, key) => t.view.awake?.zoom(key === "-" ? 1 / zoom_step : zoom_step) },
  { keys: ["r"], shown: "r", does: text_of("do_reset"), run: (t) => reset_view(t.state, t.view) },
  { keys: ["f"], shown: "f", does: text_of("do_follow"), run: (t) => t.state.set({ follow: !t.state.get("follow") }) },
  { keys: ["shift+F"], shown: `${shift_key} + f`, does: text_of("do_full_screen"), run: (t) => t.full_screen() },
  { keys: ["o"], shown: "o", does: text_of("do_overlays"), run: (t) => t.focus("overlays") },
  { keys: ["p"], shown: "p", does: text_of("do_panels"), run: (t) => t.focus("panels") },
  { keys: ["?", "shift+?"], shown: "?", does: text_of("do_help"), run: (t) => t.show_help() },
];

/** Elements whose own keys come first. */
function keeps_key(target: EventTarget | null, key: string): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.closest("dialog, textarea, input:not([type=checkbox]):not([type=radio])")) return true;
  if (target.tagName === "SELECT") return /^(Arrow|Home|End| |[a-z]$)/i.test(key);
  if (target.closest("button, summary, a[href]")) return key === " " || key === "Enter";
  if (target.tagName === "VIDEO") return true;
  return false;
}

export function listen_to_keys(element: HTMLElement, targets: KeyTargets): void {
  element.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || keeps_key(event.target, event.key)) return;
    const name = `${event.altKey ? "alt+" : ""}${event.shiftKey ? "shift+" : ""}${event.key}`;
    const binding = key_bindings.find((each) => each.keys.includes(name));
    if (!binding) return;
    event.preventDefault();
    binding.run(targets, event.key);
  });
}
