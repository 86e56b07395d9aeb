// Decodes the motion of a body from quantized values at each frame (src/page/frame_channels.h).
import { sum_differences } from "./container.ts";
import type { Quat, Vec3 } from "./clip.ts";
import type { Moment } from "./segment.ts";
import { moved, normalized, product, scaled, sum, turn_by } from "./vectors.ts";

export const channel_count = 12;

/** Derivative at frame n of the parabola through three frames; steps[i]: from frame i - 1 to frame i. */
function rate_at(n: number, steps: Vec3[], fps: number): Vec3 {
  const count = steps.length;
  if (count === 2) return scaled(fps, steps[1]);
  if (n === 0) return scaled(fps, moved(scaled(1.5, steps[1]), -0.5, steps[2]));
  if (n + 1 === count) return scaled(fps, moved(scaled(1.5, steps[n]), -0.5, steps[n - 1]));
  return scaled(0.5 * fps, sum(steps[n], steps[n + 1]));
}

/** The nearest multiple, so that the velocity of a body at rest is zero and not a rounding of the places. */
function snapped(value: Vec3, quantum: number): Vec3 {
  const nearest = (x: number) => Math.sign(x) * quantum * Math.round(Math.abs(x) / quantum);
  return [nearest(value[0]), nearest(value[1]), nearest(value[2])];
}

/** `values`: the body's channels one after the other; changed. */
export function decode_frames(values: Float64Array, orders: Float64Array, quanta: [number, number, number, number], fps: number): Moment[] {
  const count = values.length / channel_count;
  for (let k = 0; k < channel_count; ++k) sum_differences(values.subarray(k * count, (k + 1) * count), orders[k]);
  const vector = (channel: number, n: number, quantum: number): Vec3 => [
    quantum * values[channel * count + n],
    quantum * values[(channel + 1) * count + n],
    quantum * values[(channel + 2) * count + n],
  ];
  const places: Vec3[] = [], ways: Vec3[] = [], turns: Vec3[] = [], rotations: Quat[] = [];
  let rotation: Quat = [1, 0, 0, 0];
  for (let n = 0; n < count; ++n) {
    places.push(vector(0, n, quanta[0]));
    ways.push(n > 0 ? moved(places[n], -1, places[n - 1]) : [0, 0, 0]);
    turns.push(vector(3, n, quanta[1]));
    rotation = normalized(product(turn_by(turns[n]), rotation));
    rotations.push(rotation);
  }
  return places.map((position, n) => ({
    time: n / fps,
    position,
    rotation: rotations[n],
    velocity: snapped(sum(rate_at(n, ways, fps), vector(6, n, quanta[2])), quanta[2]),
    angular_velocity: snapped(sum(rate_at(n, turns, fps), vector(9, n, quanta[3])), quanta[3]),
  }));
}
