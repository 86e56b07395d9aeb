// What all blocks have in common.
import type { Place } from "../problems.ts";
import type { Source } from "../source.ts";
import { parse_table, type Table } from "../table.ts";

/** A fenced block as it stands in the file. */
export interface BlockText {
  source: Source;
  text: string;
  /** Of the fence's line. */
  place: Place;
  /** Line of the first line of the text. */
  first: number;
}

/** What a block may use of the lesson. */
export interface BlockContext {
  /** Markdown of a key's value, as paragraphs, or without them. */
  markdown(table: Table, key: string, inline: boolean): string;
  /** TeX of a key's value as displayed MathML. */
  math(table: Table, key: string): string;
  /** Checked after the whole lesson is read: the stage may come later. */
  use_stage(table: Table): string;
}

export function block_table(block: BlockText): Table | null {
  return parse_table(block.source, block.text, block.first, block.place);
}

/** Places of keys for messages of the program, which checks what only a run can tell. */
export function places_of(table: Table, keys: readonly string[]): Record<string, Place> {
  return Object.fromEntries(keys.filter((key) => table.has(key)).map((key) => [key, table.place(key)]));
}
