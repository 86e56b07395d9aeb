// How the chosen run was computed, and how exactly the page shows it.
import { h } from "../ui/dom.ts";
import { count_text, number_text, trimmed_text } from "../ui/format.ts";
import type { PlayerState } from "../ui/player_state.ts";

export function build_about(state: PlayerState): HTMLElement {
  const list = h("dl", { class: "tp-about" });
  const show = (): void => {
    const run = state.run;
    const { settings, motion } = run;
    const moving = run.scene.bodies.map((_, index) => motion.kind(index)).filter((kind) => kind !== "still");
    const exact = moving.filter((kind) => kind === "keys").length;
    const facts: [string, string][] = [
      ["Program", state.clip.generator],
      ["Length", `${trimmed_text(run.duration)} s, ${count_text(run.frames, "frame")} at ${trimmed_text(run.fps)} per second`],
      ["Bodies", `${run.scene.bodies.length}, of which ${moving.length} move`],
      ["Integrator", `${settings.integrator}, step ${trimmed_text(settings.step)} s`],
      ["Impacts", settings.impacts === "exact" ? "exact: each at its own time" : "stepped: resolved in the steps"],
      ["Method", settings.method],
      ["Gravity", `(${settings.gravity.map((value) => trimmed_text(value)).join(", ")}) m/s\u00b2`],
      ["Motion", `${exact} of ${moving.length} bodies exact between keys, the others interpolated between frames`],
      ["Largest deviation", `${number_text(motion.error.position, 3)} m, ${number_text(motion.error.rotation, 3)} rad, ` +
        `${number_text(motion.error.velocity, 3)} m/s, ${number_text(motion.error.angular_velocity, 3)} rad/s`],
    ];
    list.replaceChildren(...facts.map(([name, value]) => h("div", {}, h("dt", {}, name), h("dd", {}, value))));
  };
  state.on(["run"], show);
  show();
  return list;
}
