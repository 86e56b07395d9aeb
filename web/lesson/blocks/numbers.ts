// The block `numbers`: an equation into which the page puts the numbers of an impact or of a moment.
import { ExpressionError, parse_expression, place_in_value, type Tree } from "../expression.ts";
import { json_attribute } from "../html.ts";
import type { Place } from "../problems.ts";
import { moments, type Moment } from "../symbols.ts";
import type { Table } from "../table.ts";
import { block_table, places_of, type BlockContext, type BlockText } from "./block.ts";

/** `data-numbers` in the page. */
export interface NumbersData {
  stage: string;
  moment: Moment;
  /** From 1. */
  impact: number;
  value: Tree;
  expression: Tree;
}

/** What the program checks: both sides agree in the run. */
export interface NumbersBlock {
  stage: string;
  data: NumbersData;
  /** Index of the run, from 0. */
  run: number;
  /** Largest residual. */
  tolerance: number;
  place: Place;
  places: Record<string, Place>;
}

/** Impacts keep all their digits; pages keep the motion between them in quanta. */
const usual_tolerance: Record<Moment, number> = { impact: 1e-6, now: 1e-3 };

function read_expression(table: Table, key: string, moment: Moment): { tree: Tree; type: string } | null {
  table.require(key, key === "value" ? "the left side of the equation" : "the right side of the equation");
  const text = table.text(key);
  if (text === undefined) return null;
  try {
    return parse_expression(text, moment);
  } catch (error) {
    if (!(error instanceof ExpressionError)) throw error;
    const place = table.place(key);
    table.source.problem(place_in_value(table.source.lines[place.line - 1], place, text, error.offset),
      `${key}: ${error.message}`);
    return null;
  }
}

/** Null without an equation to check. */
export function read_numbers(block: BlockText, context: BlockContext): { numbers: NumbersBlock; html: string } | null {
  const table = block_table(block);
  if (!table) return null;
  const stage = context.use_stage(table);
  const moment = (table.choice("moment", moments) ?? "impact") as Moment;
  const impact = table.whole("impact", 1) ?? 1;
  table.require("equation", "its TeX");
  const equation = context.math(table, "equation");
  const value = read_expression(table, "value", moment);
  const expression = read_expression(table, "expression", moment);
  if (value && expression && value.type !== expression.type)
    table.problem("value", `value: a ${value.type} cannot equal the expression, a ${expression.type}`);
  const caption = table.has("caption") ? `<p class="numbers-caption">${context.markdown(table, "caption", true)}</p>` : "";
  table.text("caption");
  table.text("equation");
  const run = table.whole("run", 0) ?? 0;
  const tolerance = table.number("tolerance", 0) ?? usual_tolerance[moment];
  table.finish();
  if (!value || !expression) return null;
  const data: NumbersData = { stage, moment, impact, value: value.tree, expression: expression.tree };
  const html = `<div class="numbers" role="group" data-numbers="${json_attribute(data)}" aria-label="An equation with numbers">
<div class="numbers-equation">${equation}</div>${caption}
</div>
`;
  return { numbers: { stage, data, run, tolerance, place: block.place, places: places_of(table, ["value", "expression", "impact", "run"]) }, html };
}
