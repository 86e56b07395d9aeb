// Steps in time, shared by buttons, keys and panels.
import { moment_at, moment_text, next_moment, previous_moment } from "./moments.ts";
import type { Announcer } from "./live_region.ts";
import { speeds, type PlayerState } from "./player_state.ts";
import { text_of } from "../texts/texts.ts";

export class Actions {
  constructor(private readonly state: PlayerState, private readonly announcer: Announcer) {}

  seek(time: number): void {
    this.state.set({ time, playing: false });
  }

  toggle_play(): void {
    const state = this.state;
    if (!state.get("playing") && state.get("time") >= state.duration) state.set({ time: 0, playing: true });
    else state.set({ playing: !state.get("playing") });
  }

  /** To the frame before or after the time; between frames to the nearest one on that side. */
  step_frame(direction: 1 | -1): void {
    const position = this.state.get("time") * this.state.run.fps;
    const frame = direction > 0 ? Math.floor(position + 1e-6) + 1 : Math.ceil(position - 1e-6) - 1;
    this.seek(frame / this.state.run.fps);
  }

  step_impact(direction: 1 | -1): void {
    const run = this.state.run;
    const moment = (direction > 0 ? next_moment : previous_moment)(run, this.state.get("time"));
    if (!moment) {
      this.announcer.say(text_of(direction > 0 ? "no_impact_after" : "no_impact_before"));
      return;
    }
    this.state.set({ time: moment.time, playing: false, impact: moment.first });
    this.announcer.say(moment_text(run, moment));
  }

  go_to_impact(index: number): void {
    const run = this.state.run;
    const impact = run.impacts[index];
    this.state.set({ time: impact.time, playing: false, impact: index });
    this.announcer.say(moment_text(run, { time: impact.time, first: index, last: index }));
  }

  change_speed(direction: 1 | -1): void {
    const index = speeds.indexOf(this.state.get("speed")) + direction;
    if (index < 0 || index >= speeds.length) return;
    this.state.set({ speed: speeds[index] });
    this.announcer.say(text_of("speed_now", { speed: speeds[index] }));
  }

  /** The impulse side of the shown moment: before or after. */
  toggle_before(): void {
    if (!moment_at(this.state.run, this.state.get("time"))) {
      this.announcer.say(text_of("no_impact_here"));
      return;
    }
    const before = !this.state.get("before");
    this.state.set({ before });
    this.announcer.say(text_of(before ? "velocities_before" : "velocities_after"));
  }

  choose_body(direction: 1 | -1): void {
    const bodies = this.state.run.scene.bodies;
    const candidates = bodies.map((_, index) => index).filter((index) => bodies[index].type !== "fixed");
    if (candidates.length === 0) return;
    const at = candidates.indexOf(this.state.get("body") ?? -1);
    const body = candidates[(at + direction + candidates.length) % candidates.length];
    this.state.set({ body });
    this.announcer.say(text_of("body_chosen", { body: bodies[body].name }));
  }
}
