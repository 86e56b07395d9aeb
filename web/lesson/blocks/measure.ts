// The block `measure`: a table of numbers that theory gives and that the run gives.
import type { Place } from "../problems.ts";
import { escape_html, number_html } from "../html.ts";
import { block_table, places_of, type BlockContext, type BlockText } from "./block.ts";
import { read_check, type Check } from "./check.ts";

export interface MeasureRow {
  expected: number;
  tolerance: number;
  unit: string;
  check?: Check;
  place: Place;
  places: Record<string, Place>;
  /** Name of the row in messages. */
  label: string;
}

export interface MeasureBlock {
  stage: string;
  rows: MeasureRow[];
}

/** As the program shows the measured number: enough digits to tell it from others beyond the tolerance. */
function shown(value: number, tolerance: number): string {
  if (value === 0 || tolerance === 0) return number_html(value);
  const digits = Math.ceil(Math.log10(Math.abs(value) / tolerance)) + 2;
  return number_html(Number(value.toPrecision(Math.min(Math.max(digits, 4), 15))));
}

/** `index`: from 0 in the lesson. The program puts measured values in place of the comments. */
export function read_measure(block: BlockText, context: BlockContext, index: number): { measure: MeasureBlock; html: string } | null {
  const table = block_table(block);
  if (!table) return null;
  const stage = context.use_stage(table);
  table.require("row", "[[row]] with label, expected, tolerance and check");
  const tables = table.tables("row") ?? [];
  const caption = table.has("caption") ? `<caption>${context.markdown(table, "caption", true)}</caption>` : "";
  table.text("caption");
  table.finish();
  let body = "";
  const with_formula = tables.some((row) => row.has("formula"));
  const rows = tables.map((row, i): MeasureRow => {
    row.require("label", "Markdown");
    row.require("expected", "a number");
    row.require("tolerance", "the largest deviation, in the unit of the number");
    row.require("check", "the number of the run");
    const result: MeasureRow = {
      expected: row.number("expected") ?? 0,
      tolerance: row.number("tolerance", 0) ?? 0,
      unit: row.text("unit") ?? "",
      check: read_check(row, "check"),
      place: row.start,
      places: places_of(row, ["expected", "check"]),
      label: row.text("label") ?? "",
    };
    const label = row.has("label") ? context.markdown(row, "label", true) : "";
    const formula = row.has("formula") ? context.markdown(row, "formula", true) : "";
    row.text("formula");
    row.finish();
    const unit = result.unit ? `&nbsp;${escape_html(result.unit)}` : "";
    body += `<tr><th scope="row">${label}</th>${with_formula ? `<td>${formula}</td>` : ""}` +
      `<td class="number">${shown(result.expected, result.tolerance)}${unit}</td>` +
      `<td class="number"><!--measured:${index}:${i}-->${unit}</td><td class="number"><!--deviation:${index}:${i}--></td></tr>\n`;
    return result;
  });
  const html = `<div class="measure" tabindex="0" role="group" aria-label="Expected and measured numbers"><table>${caption}
<thead><tr><th scope="col">Quantity</th>${with_formula ? '<th scope="col">Formula</th>' : ""}<th scope="col">Expected</th><th scope="col">Measured</th><th scope="col">Deviation</th></tr></thead>
<tbody>
${body}</tbody></table></div>
`;
  return { measure: { stage, rows }, html };
}
