// Paths of bodies, as pieces with their times: the whole path lies on the graphics card, and the moment decides how much of it
// is seen.
import type { Run, Vec3 } from "../data/clip.ts";
import { from_text, mixed } from "./color.ts";
import { add, distance, rotate } from "./math.ts";
import { style } from "./overlay_style.ts";
import type { ScreenShape, ScreenShapes } from "./screen_shapes.ts";

/** Of the viewing distance: a path may be left by so much to have fewer pieces. */
const tolerance = 1e-3;

interface Sample {
  time: number;
  at: Vec3;
}

/** Fills the pieces of all trails of a run, in the order in which they are passed. Returns the times at which they start, s. */
export function add_trails(run: Run, viewing_distance: number, to: ScreenShapes): Float64Array {
  const pale = (color: Vec3) => mixed(color, [1, 1, 1], style.trail_paleness);
  const body_color = (body: number) => pale(from_text(run.scene.bodies[body].color));
  const points: { body: number; point: Vec3 | null; color: Vec3 }[] = run.overlays.trail_points.length
    ? run.overlays.trail_points.map(({ body, point, color }) => ({ body, point, color: color ? from_text(color) : body_color(body) }))
    : run.overlays.bodies.map((body) => ({ body, point: null, color: body_color(body) }));
  const pieces: ScreenShape[] = [];
  for (const { body, point, color } of points) {
    if (run.motion.kind(body) === "still") continue;
    const samples = times_of(run, body).filter((time) => run.motion.shows(body, time)).map((time): Sample => {
      const { position, origin, rotation } = run.motion.state(body, time);
      return { time, at: point ? add(origin, rotate(rotation, point)) : position };
    });
    if (samples.length === 0) continue;
    const kept = simplified(samples, tolerance * viewing_distance);
    for (let i = 0; i + 1 < kept.length; ++i)
      pieces.push({
        from: kept[i].at, from_w: kept[i].time, to: kept[i + 1].at, to_w: kept[i + 1].time, color, opacity: style.trail_opacity, allowance: 0,
        form: style.trail_width,
      });
  }
  pieces.sort((a, b) => a.from_w - b.from_w);
  to.begin();
  for (const piece of pieces) to.add(piece);
  to.end();
  return Float64Array.from(pieces, (piece) => piece.from_w);
}

/** How many of the ascending times are not after a moment. */
export function started(times: Float64Array, time: number): number {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle + 1;
    else high = middle;
  }
  return low;
}

// Of all frames, and of the body's impacts, where its path has a corner.
function times_of(run: Run, body: number): number[] {
  const times = Array.from({ length: run.frames }, (_, frame) => frame / run.fps);
  for (const impact of run.impacts) if (impact.body_a === body || impact.body_b === body) times.push(impact.time);
  return times.sort((a, b) => a - b);
}

// Douglas and Peucker 1973: the path between two samples is straight if no sample in between is farther than the tolerance.
function simplified(samples: Sample[], most: number): Sample[] {
  const kept = new Set([0, samples.length - 1]);
  const open: [number, number][] = [[0, samples.length - 1]];
  for (let next = open.pop(); next; next = open.pop()) {
    const [first, last] = next;
    let farthest = -1;
    let deviation = most;
    for (let i = first + 1; i < last; ++i) {
      const off = off_piece(samples[i], samples[first], samples[last]);
      if (off > deviation) [farthest, deviation] = [i, off];
    }
    if (farthest < 0) continue;
    kept.add(farthest);
    open.push([first, farthest], [farthest, last]);
  }
  return [...kept].sort((a, b) => a - b).map((i) => samples[i]);
}

// The piece is passed at constant speed, so that its visible end is where the body is: time counts, not only the line.
function off_piece(sample: Sample, first: Sample, last: Sample): number {
  const whole = last.time - first.time;
  const share = whole > 0 ? (sample.time - first.time) / whole : 0;
  return distance(sample.at, mixed(first.at, last.at, share));
}
