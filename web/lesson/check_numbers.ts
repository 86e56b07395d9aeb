// Equations with numbers, checked in the runs of their stages: with the data and the code of the page, so that a reader sees
// what was checked.
import { Buffer } from "node:buffer";
import { inflateRawSync } from "node:zlib";
import type { Run } from "../src/data/clip.ts";
import { read_clip } from "../src/data/decode_clip.ts";
import { difference, evaluate, magnitude, type Value } from "../src/lesson/evaluate.ts";
import { impact_values, moment_values } from "../src/lesson/symbol_values.ts";
import type { NumbersData } from "./blocks/numbers.ts";

/** As the program gives it. */
export interface NumbersTask {
  /** Base64 of deflated clips. */
  clips: string[];
  blocks: { clip: number; run: number; data: NumbersData; /** Name; empty: the body that the page shows first. */ body: string }[];
}

/** Of each block: both sides where they differ most, or a problem. */
export type NumbersResult = { problem: string } | { left: number[]; right: number[]; residual: number; time: number };

interface Sides {
  time: number;
  left: Value;
  right: Value;
}

const list = (value: Value): number[] => (typeof value === "number" ? [value] : [...value]);

function sides_of(run: Run, data: NumbersData, body: number): Sides[] {
  const at = (time: number, values: ReturnType<typeof impact_values>): Sides =>
    ({ time, left: evaluate(data.value, values), right: evaluate(data.expression, values) });
  if (data.moment === "impact") return [at(run.impacts[data.impact - 1].time, impact_values(run, data.impact - 1))];
  return Array.from({ length: run.frames }, (_, frame) => at(frame / run.fps, moment_values(run, frame / run.fps, body, false)));
}

function check_block(run: Run, data: NumbersData, body_name: string): NumbersResult {
  if (data.moment === "impact" && data.impact > run.impacts.length)
    return { problem: `impact: the run has ${run.impacts.length} impacts (asked for impact ${data.impact})` };
  const body = run.scene.bodies.findIndex((each) => (body_name ? each.name === body_name : each.type === "dynamic"));
  if (data.moment === "now" && body < 0) return { problem: "value: the stage shows no body" };
  const sides = sides_of(run, data, body);
  const odd = sides.find(({ left, right }) => ![...list(left), ...list(right)].every(Number.isFinite));
  if (odd) return { problem: `value: a side is no finite number at ${odd.time.toPrecision(4)} s: masses of fixed bodies are infinite, their inverses ima and imb are 0` };
  // Relative to the largest number of the run: near 0 there is only rounding.
  const scale = Math.max(...sides.map(({ left, right }) => Math.max(magnitude(left), magnitude(right))));
  const worst = sides.reduce((a, b) => (difference(b.left, b.right) > difference(a.left, a.right) ? b : a));
  return {
    left: list(worst.left), right: list(worst.right), time: worst.time,
    residual: scale > 0 ? difference(worst.left, worst.right) / scale : 0,
  };
}

export function check_numbers({ clips, blocks }: NumbersTask): NumbersResult[] {
  const read = clips.map((clip) => read_clip(inflateRawSync(Buffer.from(clip, "base64"))));
  return blocks.map(({ clip, run, data, body }) => {
    const { runs } = read[clip];
    if (run >= runs.length) return { problem: `run: the stage has ${runs.length} runs, numbered from 0 (run = ${run})` };
    return check_block(runs[run], data, body);
  });
}
