// Play, steps, speed and the readout of the time.
import type { Actions } from "./actions.ts";
import { h, set_text } from "./dom.ts";
import { speed_text, time_text } from "./format.ts";
import { icon, set_icon, type IconName } from "./icons.ts";
import { speeds, type PlayerState } from "./player_state.ts";
import { ScrubBar } from "./scrub_bar.ts";

export function icon_button(name: IconName, label: string, keys: string, onclick: () => void): HTMLButtonElement {
  return h("button", { type: "button", class: "tp-icon", "aria-label": label, title: keys ? `${label} (${keys})` : label, onclick },
    icon(name));
}

export function build_transport(state: PlayerState, actions: Actions, show_help: () => void): HTMLElement {
  const play = icon_button("play", "Play", "space", () => actions.toggle_play());
  play.classList.add("tp-play");
  const loop = icon_button("loop", "Loop", "l", () => state.set({ loop: !state.get("loop") }));
  const time = h("span", { class: "tp-time" });
  const frame = h("span", { class: "tp-frame" });
  const speed = h("select", {
    class: "tp-select tp-speed", "aria-label": "Speed", title: "Speed (up, down)",
    onchange: () => state.set({ speed: Number(speed.value) }),
  }, ...speeds.map((value) => h("option", { value }, speed_text(value))));

  const show_playing = (): void => {
    const playing = state.get("playing");
    set_icon(play, playing ? "pause" : "play");
    play.setAttribute("aria-label", playing ? "Pause" : "Play");
    play.title = playing ? "Pause (space)" : "Play (space)";
    loop.setAttribute("aria-pressed", String(state.get("loop")));
    speed.value = String(state.get("speed"));
  };
  const show_time = (): void => {
    set_text(time, time_text(state.get("time")));
    set_text(frame, `frame ${state.frame} of ${state.run.frames - 1}`);
  };
  state.on(["playing", "loop", "speed"], show_playing);
  state.on(["time", "run"], show_time);
  show_playing();
  show_time();

  const impacts = (direction: 1 | -1): HTMLButtonElement =>
    icon_button(direction > 0 ? "next_impact" : "previous_impact", direction > 0 ? "Next impact" : "Previous impact",
      direction > 0 ? "shift + right" : "shift + left", () => actions.step_impact(direction));
  const has_impacts = state.clip.runs.some((run) => run.impacts.length > 0);
  return h("div", { class: "tp-transport" },
    new ScrubBar(state, actions).element,
    h("div", { class: "tp-controls", role: "group", "aria-label": "Playing" },
      h("div", { class: "tp-buttons" },
        has_impacts && impacts(-1),
        icon_button("previous_frame", "Previous frame", "left", () => actions.step_frame(-1)),
        play,
        icon_button("next_frame", "Next frame", "right", () => actions.step_frame(1)),
        has_impacts && impacts(1)),
      h("div", { class: "tp-readout" }, time, frame),
      h("div", { class: "tp-buttons tp-right" }, speed, loop, icon_button("help", "Keys", "?", show_help))));
}
