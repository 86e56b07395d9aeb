// The numbers of a plot: one row of times, one row of values for each curve. Impacts are two rows, before and after, so that
// velocities jump.
import type { EnergyTable, Run } from "../data/clip.ts";
import { same_time } from "../ui/player_state.ts";
import { body_quantities, joint_column, scene_quantities, type PlotSubject } from "./quantities.ts";
import { text_of } from "../texts/texts.ts";

export interface Series {
  label: string;
  values: Float64Array | (number | null)[];
  /** Value at any time, as shown beside the curve's name. */
  at(time: number, before: boolean): number;
}

export interface PlotData {
  times: Float64Array;
  unit: string;
  series: Series[];
}

/** Impact times of one body beyond this many are left out of the curve: the frames show it. */
const most_impacts = 2000;

/** Times of all frames of the runs, and twice those of the body's impacts. */
function sample_times(runs: Run[], body: number): Float64Array {
  const moments: { time: number; impact: boolean }[] = [];
  for (const run of runs) {
    for (let frame = 0; frame < run.frames; frame += 1) moments.push({ time: frame / run.fps, impact: false });
    const impacts = run.impacts.filter((impact) => impact.body_a === body || impact.body_b === body);
    for (const impact of impacts.slice(0, most_impacts)) moments.push({ time: impact.time, impact: true });
  }
  moments.sort((a, b) => a.time - b.time);
  const kept: number[] = [];
  let doubled = false;
  for (const { time, impact } of moments) {
    const same = kept.length > 0 && time - kept[kept.length - 1] < same_time;
    if (!same) doubled = false;
    if (!same || (impact && !doubled)) kept.push(time);
    if (impact && !doubled) {
      if (!same) kept.push(time);
      doubled = true;
    }
  }
  return Float64Array.from(kept);
}

function body_series(runs: Run[], subject: { quantity: string; body: number }): PlotData {
  const quantity = body_quantities.get(subject.quantity)!;
  const times = sample_times(runs, subject.body);
  const series = runs.map((run): Series => {
    const at = (time: number, before: boolean): number => {
      const motion = run.motion;
      return quantity.value(run, subject.body, before ? motion.state_before(subject.body, time) : motion.state(subject.body, time));
    };
    const values = Array.from(times, (time, index) => {
      if (time > run.duration + same_time) return null;
      const first_of_two = index + 1 < times.length && times[index + 1] - time < same_time;
      return at(time, first_of_two);
    });
    return { label: run.label, values, at };
  });
  return { times, unit: quantity.unit, series };
}

/** Of a column of frames: linear in between. */
function between_frames(run: Run, time: number, value: (frame: number) => number): number {
  const position = Math.min(Math.max(time * run.fps, 0), run.frames - 1);
  const frame = Math.min(Math.floor(position + 1e-9), run.frames - 1);
  const part = Math.max(0, position - frame);
  if (part < 1e-6 || frame + 1 >= run.frames) return value(frame);
  return value(frame) * (1 - part) + value(frame + 1) * part;
}

function frame_times(runs: Run[]): Float64Array {
  return sample_times(runs, -1);
}

function frame_series(runs: Run[], unit: string, value: (run: Run, frame: number) => number): PlotData {
  const times = frame_times(runs);
  const series = runs.map((run): Series => {
    const at = (time: number): number => between_frames(run, time, (frame) => value(run, frame));
    const shown = (time: number): number | null => {
      const value_there = at(time);
      return time > run.duration + same_time || Number.isNaN(value_there) ? null : value_there;
    };
    return { label: run.label, values: Array.from(times, shown), at };
  });
  return { times, unit, series };
}

/** From the bottom. */
const energy_layers = (["potential", "elastic", "kinetic_linear", "kinetic_angular", "impact_loss", "friction_loss"] as const)
  .map((key) => ({ key, label: text_of(`layer_${key}`) }));

export interface EnergyStack {
  times: Float64Array;
  /** Layers that are not zero throughout, with their upper edges. */
  layers: { key: keyof EnergyTable; label: string; edge: Float64Array; at(time: number): number }[];
  /** Energy at the start plus the work done since: the upper edge, if nothing is lost unseen. */
  supply: { values: Float64Array; at(time: number): number };
  /** Added to the potential energy, so that it is not negative, J. */
  shift: number;
}

export function energy_stack(run: Run): EnergyStack {
  const table = run.energy;
  const times = Float64Array.from({ length: run.frames }, (_, frame) => frame / run.fps);
  const largest = Math.max(...energy_layers.map(({ key }) => table[key].reduce((most, value) => Math.max(most, Math.abs(value)), 0)));
  const lowest = table.potential.reduce((least, value) => Math.min(least, value), Infinity);
  const shift = lowest < 0 ? -lowest : 0;
  const sum = new Float64Array(run.frames);
  const layers: EnergyStack["layers"] = [];
  for (const { key, label } of energy_layers) {
    const column = table[key];
    const value = (frame: number): number => column[frame] + (key === "potential" ? shift : 0);
    if (!column.some((each) => Math.abs(each) > 1e-9 * largest)) continue;
    for (let frame = 0; frame < run.frames; frame += 1) sum[frame] += value(frame);
    layers.push({ key, label, edge: sum.slice(), at: (time) => between_frames(run, time, value) });
  }
  const start = energy_layers.reduce((total, { key }) => total + table[key][0], 0) + shift;
  const supplied = (frame: number): number => start + table.work[frame];
  return {
    times, layers, shift,
    supply: { values: Float64Array.from({ length: run.frames }, (_, frame) => supplied(frame)), at: (time) => between_frames(run, time, supplied) },
  };
}

export function plot_series(runs: Run[], subject: Exclude<PlotSubject, { kind: "energy" }>): PlotData {
  if (subject.kind === "body") return body_series(runs, subject);
  if (subject.kind === "joint")
    return frame_series(runs, joint_column(subject.quantity).unit, (run, frame) => run.joints.get(subject.quantity)?.[frame] ?? NaN);
  const quantity = scene_quantities.get(subject.quantity)!;
  return frame_series(runs, quantity.unit, quantity.value);
}
