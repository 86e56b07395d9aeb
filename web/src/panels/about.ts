// How the chosen run was computed, and how exactly the page shows it.
import { h } from "../ui/dom.ts";
import { number_text, trimmed_text } from "../ui/format.ts";
import type { PlayerState } from "../ui/player_state.ts";
import { text_of } from "../texts/texts.ts";

export function build_about(state: PlayerState): HTMLElement {
  const list = h("dl", { class: "tp-about" });
  const show = (): void => {
    const run = state.run;
    const { settings, motion } = run;
    const moving = run.scene.bodies.map((_, index) => motion.kind(index)).filter((kind) => kind !== "still");
    const exact = moving.filter((kind) => kind === "keys").length;
    const facts: [string, string][] = [
      [text_of("program"), state.clip.generator],
      [text_of("length"), text_of("length_value", {
        seconds: trimmed_text(run.duration), frames: text_of("frames", { count: run.frames }), fps: trimmed_text(run.fps),
      })],
      [text_of("bodies"), text_of("bodies_value", { count: run.scene.bodies.length, moving: moving.length })],
      [text_of("integrator"), text_of("integrator_value", { integrator: settings.integrator, step: trimmed_text(settings.step) })],
      [text_of("panel_impacts"), text_of(settings.impacts === "exact" ? "impacts_exact" : "impacts_stepped")],
      [text_of("method"), settings.method],
      [text_of("gravity"), `(${settings.gravity.map((value) => trimmed_text(value)).join(", ")}) m/s\u00b2`],
      [text_of("motion"), text_of("motion_value", { exact, moving: moving.length })],
      [text_of("deviation"), `${number_text(motion.error.position, 3)} m, ${number_text(motion.error.rotation, 3)} rad, ` +
        `${number_text(motion.error.velocity, 3)} m/s, ${number_text(motion.error.angular_velocity, 3)} rad/s`],
    ];
    list.replaceChildren(...facts.map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value))));
  };
  state.on(["run"], show);
  show();
  return list;
}
