// The scene of a block that holds it: the text without what belongs to the page, each line where it stands in the file.
import type { BlockText } from "./block.ts";

/** Cut are the table [stage], other tables named, and lines of other keys before the first table. */
export function read_scene_text(block: BlockText, tables: readonly string[] = [], keys: readonly string[] = []): string {
  const cut_tables = ["stage", ...tables];
  let keeps = true;
  let top = true;
  const lines = block.text.split("\n").map((line) => {
    const header = /^\s*\[\[?\s*([A-Za-z0-9_-]+)/.exec(line);
    if (header) {
      keeps = !cut_tables.includes(header[1]);
      top = false;
    }
    const key = top ? /^\s*([A-Za-z0-9_-]+)\s*=/.exec(line) : null;
    if (top && key) keeps = !keys.includes(key[1]);
    return keeps ? line : "";
  });
  return "\n".repeat(block.first - 1) + lines.join("\n");
}
