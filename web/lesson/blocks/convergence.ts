// The block `convergence`: errors of integrators against the step.
import type { Place } from "../problems.ts";
import { block_table, places_of, type BlockContext, type BlockText } from "./block.ts";
import { read_scene_text } from "./scene_text.ts";
import { read_scene, type StageBlock } from "./stage.ts";

export interface ConvergenceBlock extends Pick<StageBlock, "scene" | "text" | "set" | "places"> {
  place: Place;
  of: string;
  at: number;
  integrators: string[];
  steps_per_frame: number[];
  exact?: number;
  /** Integrator whose run is taken as exact. */
  reference?: string;
  slopes: Record<string, number>;
  caption: string;
  alt: string;
}

const keys = ["of", "at", "integrators", "steps_per_frame", "exact", "reference", "slopes"] as const;
const most_steps = 1e6;
/** "rk4" of scenes has its long name too, for readers of the plot. */
const integrators = ["explicit-euler", "symplectic-euler", "splitting", "runge-kutta-4", "rk4", "exact"];

export function read_convergence(block: BlockText, context: BlockContext): ConvergenceBlock | null {
  const table = block_table(block);
  if (!table) return null;
  const stage = table.table("stage");
  if (!stage) {
    if (!table.has("stage")) block.source.problem(block.place, "[stage] is missing: alt is required");
    return null;
  }
  table.require("of", "the quantity whose error is shown");
  table.require("at", "the time in s");
  table.require("integrators", `a list of ${integrators.join(", ")}`);
  table.require("steps_per_frame", "a list of numbers of steps");
  stage.require("alt", "a text for readers who do not see the plot");
  const result: ConvergenceBlock = {
    place: block.place,
    of: table.text("of") ?? "",
    at: table.number("at", 0) ?? 0,
    integrators: table.texts("integrators", integrators) ?? [],
    steps_per_frame: table.numbers("steps_per_frame") ?? [],
    exact: table.number("exact"),
    reference: table.choice("reference", integrators),
    slopes: {},
    caption: stage.has("caption") ? context.markdown(stage, "caption", true) : "",
    alt: stage.text("alt") ?? "",
    ...read_scene(block, table, stage),
  };
  stage.text("caption");
  stage.text("id");
  stage.finish();
  Object.assign(result.places, places_of(table, keys));
  if (result.text !== undefined) result.text = read_scene_text(block, ["slopes"], keys);
  if ((result.exact === undefined) === (result.reference === undefined))
    block.source.problem(block.place, "give one of exact = NUMBER and reference = \"INTEGRATOR\"");
  if (result.steps_per_frame.some((steps) => !Number.isInteger(steps) || steps < 1 || steps > most_steps) || result.steps_per_frame.length < 2)
    table.problem("steps_per_frame", `steps_per_frame: must be two whole numbers or more, each in 1 to ${most_steps}`);
  const slopes = table.table("slopes");
  for (const name of Object.keys(slopes?.values ?? {})) {
    const slope = slopes!.number(name);
    if (!result.integrators.includes(name)) slopes!.problem(name, `slopes: '${name}' is none of the block's integrators`);
    else if (slope !== undefined) result.slopes[name] = slope;
  }
  return result;
}
