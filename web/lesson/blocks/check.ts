// Which number of a run a quiz or a row of measures is compared with.
import type { Table } from "../table.ts";

export interface Check {
  /** Quantity of `tumble plot --of`, with what of its values. */
  of?: string;
  take?: string;
  at?: number;
  from?: number;
  to?: number;
  /** A column of the impact of this number, from 1. */
  impact?: number;
  column?: string;
  /** The number of impacts. */
  impacts?: boolean;
  run: number;
}

const takes = ["max", "min", "first", "last", "mean", "range", "at"];
const columns = [
  "time", "frame", "px", "py", "pz", "nx", "ny", "nz", "v_before", "v_after", "restitution", "impulse", "fx", "fy", "fz", "pass",
];

export function read_check(owner: Table, key: string): Check | undefined {
  const table = owner.table(key);
  if (!table) return undefined;
  const check: Check = { run: table.whole("run", 0) ?? 0 };
  if (table.has("of")) {
    check.of = table.text("of");
    check.take = table.choice("take", takes);
    table.require("take", `one of ${takes.join(", ")}`);
    if (check.take === "at") {
      table.require("at", "the time in s");
      check.at = table.number("at", 0);
    }
    check.from = table.number("from", 0);
    check.to = table.number("to", 0);
  } else if (table.has("impacts")) {
    check.impacts = table.boolean("impacts");
  } else if (table.has("impact")) {
    check.impact = table.whole("impact", 1);
    check.column = table.choice("column", columns);
    table.require("column", `one of ${columns.join(", ")}`);
  } else {
    owner.problem(key, `${key}: needs 'of' with 'take', or 'impact' with 'column', or impacts = true`);
  }
  table.finish();
  return check;
}
