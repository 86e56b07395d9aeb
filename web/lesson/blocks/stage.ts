// The block `tumble`: a scene, and how the page shows it.
import type { Place } from "../problems.ts";
import type { Table } from "../table.ts";
import { block_table, places_of, type BlockContext, type BlockText } from "./block.ts";
import { read_scene_text } from "./scene_text.ts";

/** A slider, or a choice; numbers as decimal text, as the scene gets them. */
export interface LiveControlText {
  key: string;
  label: string;
  unit: string;
  min: string;
  max: string;
  step: string;
  choices: string[];
}

export interface StageBlock {
  id: string;
  place: Place;
  places: Record<string, Place>;
  /** File of the scene, relative to the lesson's; else `text`. */
  scene?: string;
  /** The scene's own text on the lines where it stands in the lesson's file, so that places of mistakes are right. */
  text?: string;
  set: string[];
  vary: string[];
  /** Of the runs; empty: made from `vary`. */
  labels: string[];
  /** Values that the reader may change, of a live stage. */
  live: LiveControlText[];
  /** `data-options` of the player. */
  options: Record<string, unknown>;
  caption: string;
  alt: string;
}

const overlays = [
  "contacts", "normals", "impulses", "forces", "loads", "velocity", "omega", "momentum", "angular-momentum", "trails",
  "ghosts", "aabb", "axes", "com", "islands", "sleep", "names",
];
const panels = ["plots", "state", "impacts", "source"];
const compare = ["single", "ghost", "side-by-side"];

/** Scene of a stage or of a convergence block. */
export function read_scene(block: BlockText, table: Table, stage: Table): Pick<StageBlock, "scene" | "text" | "set" | "places"> {
  const scene = stage.text("scene");
  const set = stage.texts("set") ?? [];
  const places = places_of(stage, ["scene", "set", "vary", "labels", "live", "plot", "follow", "body"]);
  const rest = Object.keys(table.values).filter((key) => key !== "stage");
  if (scene !== undefined) {
    const key = rest.find((name) => !known_beside_scene.has(name));
    if (key) table.problem(key, `'${key}' stands beside scene = "${scene}": give the scene's file or its text, not both`);
    return { scene, set, places };
  }
  if (!("format" in table.values))
    block.source.problem(stage.start, "no scene: give scene = \"FILE.toml\", or the scene's own text with format = 1 above [stage]");
  return { text: read_scene_text(block), set, places };
}
/** Keys of convergence blocks, which are cut from the scene's text. */
const known_beside_scene = new Set(["of", "at", "integrators", "steps_per_frame", "exact", "reference", "slopes"]);

/** Without exponent. */
function decimal(value: number | undefined): string {
  return value === undefined ? "" : value.toFixed(12).replace(/\.?0+$/, "");
}

function read_live(stage: Table): LiveControlText[] {
  return (stage.tables("live") ?? []).map((table) => {
    table.require("key", "the key of the scene, as of --set");
    const control: LiveControlText = {
      key: table.text("key") ?? "", label: table.text("label") ?? "", unit: table.text("unit") ?? "",
      min: decimal(table.number("min")), max: decimal(table.number("max")), step: decimal(table.number("step")),
      choices: table.texts("choices") ?? [],
    };
    const numbers = [control.min, control.max, control.step].filter((each) => each !== "").length;
    if (control.choices.length === 1) table.problem("choices", "choices: at least two (given 1)");
    if (control.choices.length > 0 ? numbers > 0 : numbers !== 0 && numbers !== 3)
      table.problem("key", `live: give min, max and step, or choices (of '${control.key}')`);
    table.finish();
    return control;
  });
}

export function read_stage(block: BlockText, context: BlockContext): StageBlock | null {
  const table = block_table(block);
  if (!table) return null;
  const stage = table.table("stage");
  if (!stage) {
    if (!table.has("stage")) block.source.problem(block.place, "[stage] is missing: id and alt are required");
    return null;
  }
  stage.require("id", "a name, unique in the lesson");
  stage.require("alt", "a text for readers who do not see the stage");
  const id = stage.text("id") ?? "";
  if (id && !/^[a-z][a-z0-9-]*$/.test(id))
    stage.problem("id", `id: must be small letters, digits and '-' (given '${id}')`);
  const options: Record<string, unknown> = { layout: "lesson" };
  const keep = (key: string, value: unknown) => {
    if (value !== undefined) options[key] = value;
  };
  keep("overlay", stage.texts("overlay", overlays));
  keep("plot", stage.text("plot"));
  const view = stage.table("view");
  if (view) {
    const eye = view.numbers("eye", 3);
    const target = view.numbers("target", 3);
    view.require("eye", "the place of the camera, m");
    view.require("target", "the point that it looks at, m");
    view.finish();
    keep("view", { eye, target });
  }
  keep("time", stage.number("time", 0));
  keep("run", stage.whole("run", 0));
  keep("follow", stage.text("follow"));
  keep("body", stage.text("body"));
  keep("compare", stage.choice("compare", compare));
  keep("panels", stage.texts("panels", panels) ?? (options.plot === undefined ? [] : ["plots"]));
  const result: StageBlock = {
    id, place: block.place, live: read_live(stage), vary: stage.texts("vary") ?? [], labels: stage.texts("labels") ?? [], options,
    caption: stage.has("caption") ? context.markdown(stage, "caption", true) : "",
    alt: stage.text("alt") ?? "",
    ...read_scene(block, table, stage),
  };
  stage.text("caption");
  stage.finish();
  return result;
}
