// Playing: the time follows the clock of the browser, not a count of frames.
import type { PlayerState } from "./player_state.ts";

/** The time of the scene (s) after some seconds of the clip, from a time of the scene on, for frames at those times. */
export function paced_time(pace: number[], fps: number, start: number, seconds: number): number {
  if (pace.length < 2) return start + seconds;
  // Before which frame it starts; of a motion that stands still, the first one.
  const next = pace.findIndex((time) => time >= start);
  const end = pace.length - 1;
  if (next < 0) return start + seconds;
  const way = next > 0 ? pace[next] - pace[next - 1] : 1;
  const frame = Math.min(next - (pace[next] - start) / way + seconds * fps, end);
  const before = Math.min(Math.floor(frame), end - 1);
  const time = pace[before] + (frame - before) * (pace[before + 1] - pace[before]);
  return frame < end ? time : Infinity;
}

export function run_clock(state: PlayerState): () => void {
  let request = 0;
  let start_time = 0;
  let start_clock = 0;

  const tick = (clock: number): void => {
    if (!state.get("playing")) return;
    const { pace, fps } = state.clip.runs[state.get("run")];
    const time = paced_time(pace, fps, start_time, Math.max(0, (clock - start_clock) / 1000) * state.get("speed"));
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
  const stop = state.on(["playing", "speed", "run"], restart);
  restart();
  return () => { stop(); cancelAnimationFrame(request); };
}
