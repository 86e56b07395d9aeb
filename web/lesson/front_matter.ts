// The head of a lesson: TOML between two lines "+++".
import { parse_table } from "./table.ts";
import type { Source } from "./source.ts";

export interface FrontMatter {
  title: string;
  summary: string;
  order: number;
  /** Minutes of reading, if told. */
  duration?: number;
  /** Lines of the file that it takes. */
  lines: number;
}

export function read_front_matter(source: Source): FrontMatter {
  const front: FrontMatter = { title: "", summary: "", order: 0, lines: 0 };
  const start = { line: 1, column: 1 };
  const end = source.lines.findIndex((line, i) => i > 0 && line.trimEnd() === "+++");
  if (source.lines[0].trimEnd() !== "+++" || end < 0) {
    source.problem(start, source.lines[0].trimEnd() === "+++"
      ? "the front matter has no end: a line '+++' must close it"
      : "the file must begin with front matter: a line '+++', title = \"...\", summary = \"...\", a line '+++'");
    return front;
  }
  front.lines = end + 1;
  const table = parse_table(source, source.lines.slice(1, end).join("\n"), 2, start);
  if (!table) return front;
  table.require("title", "the lesson's name");
  table.require("summary", "a sentence for the index");
  front.title = table.text("title") ?? "";
  front.summary = table.text("summary") ?? "";
  front.order = table.number("order") ?? 0;
  front.duration = table.number("duration", 0);
  table.finish();
  return front;
}
