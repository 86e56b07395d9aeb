// Play, steps, speed and the readout of the time.
import type { Actions } from "./actions.ts";
import { h, set_text } from "./dom.ts";
import { speed_text, time_text } from "./format.ts";
import { icon, set_icon, type IconName } from "./icons.ts";
import { speeds, type PlayerState } from "./player_state.ts";
import { ScrubBar } from "./scrub_bar.ts";
import { text_of } from "../texts/texts.ts";

export function icon_button(name: IconName, label: string, keys: string, onclick: () => void): HTMLButtonElement {
  return h("button", { type: "button", class: "tp-icon", "aria-label": label, title: keys ? `${label} (${keys})` : label, onclick },
    icon(name));
}

export function build_transport(state: PlayerState, actions: Actions, show_help: () => void): HTMLElement {
  const play = icon_button("play", text_of("play"), text_of("key_space"), () => actions.toggle_play());
  play.classList.add("tp-play");
  const loop = icon_button("loop", text_of("loop"), "l", () => state.set({ loop: !state.get("loop") }));
  const time = h("span", { class: "tp-time" });
  const frame = h("span", { class: "tp-frame" });
  const speed = h("select", {
    class: "tp-select tp-speed", "aria-label": text_of("speed"), title: `${text_of("speed")} (${text_of("key_up")}, ${text_of("key_down")})`,
    onchange: () => state.set({ speed: Number(speed.value) }),
  }, ...speeds.map((value) => h("option", { value }, speed_text(value))));

  const show_playing = (): void => {
    const playing = state.get("playing");
    set_icon(play, playing ? "pause" : "play");
    const label = text_of(playing ? "pause" : "play");
    play.setAttribute("aria-label", label);
    play.title = `${label} (${text_of("key_space")})`;
    loop.setAttribute("aria-pressed", String(state.get("loop")));
    speed.value = String(state.get("speed"));
  };
  const show_time = (): void => {
    set_text(time, time_text(state.get("time")));
    set_text(frame, text_of("frame_of", { frame: state.frame, last: state.run.frames - 1 }));
  };
  state.on(["playing", "loop", "speed"], show_playing);
  state.on(["time", "run"], show_time);
  show_playing();
  show_time();

  const impacts = (direction: 1 | -1): HTMLButtonElement =>
    icon_button(direction > 0 ? "next_impact" : "previous_impact", text_of(direction > 0 ? "next_impact" : "previous_impact"),
      `${text_of("key_shift")} + ${text_of(direction > 0 ? "key_right" : "key_left")}`, () => actions.step_impact(direction));
  const has_impacts = state.clip.runs.some((run) => run.impacts.length > 0);
  return h("div", { class: "tp-transport" },
    new ScrubBar(state, actions).element,
    h("div", { class: "tp-controls", role: "group", "aria-label": text_of("playing") },
      h("div", { class: "tp-buttons" },
        has_impacts && impacts(-1),
        icon_button("previous_frame", text_of("previous_frame"), text_of("key_left"), () => actions.step_frame(-1)),
        play,
        icon_button("next_frame", text_of("next_frame"), text_of("key_right"), () => actions.step_frame(1)),
        has_impacts && impacts(1)),
      h("div", { class: "tp-readout" }, time, frame),
      h("div", { class: "tp-buttons tp-right" }, speed, loop, icon_button("help", text_of("keys"), "?", show_help))));
}
