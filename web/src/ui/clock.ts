// Playing: the time follows the clock of the browser, not a count of frames.
import type { PlayerState } from "./player_state.ts";

export function run_clock(state: PlayerState): () => void {
  let request = 0;
  let start_time = 0;
  let start_clock = 0;

  const tick = (clock: number): void => {
    if (!state.get("playing")) return;
    const time = start_time + Math.max(0, (clock - start_clock) / 1000) * state.get("speed");
    if (time < state.duration) {
      state.set({ time });
    } else if (state.get("loop")) {
      start_time = 0;
      start_clock = clock;
      state.set({ time: 0 });
    } else {
      state.set({ time: state.duration, playing: false });
      return;
    }
    request = requestAnimationFrame(tick);
  };
  const restart = (): void => {
    cancelAnimationFrame(request);
    if (!state.get("playing")) return;
    start_time = state.get("time");
    start_clock = performance.now();
    request = requestAnimationFrame(tick);
  };
  const stop = state.on(["playing", "speed"], restart);
  restart();
  return () => { stop(); cancelAnimationFrame(request); };
}
