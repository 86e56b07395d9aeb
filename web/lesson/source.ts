// The text of a lesson's file, and places in it.
import { Problems, type Place } from "./problems.ts";

/** Characters that HTML forbids. Tabs and line ends are none of them. */
const forbidden = /[\u0000-\u0008\u000b-\u001f\u007f]/;

/** Index of the first character that a page cannot hold; -1: there is none. */
export function forbidden_character(text: string): number {
  return text.search(forbidden);
}

function code_of(character: string): string {
  return `U+${character.codePointAt(0)!.toString(16).toUpperCase().padStart(4, "0")}`;
}

function place_after(text: string): Place {
  const lines = text.split("\n");
  return { line: lines.length, column: lines[lines.length - 1].length + 1 };
}

/** Place of the first byte that no character of UTF-8 has. */
function place_of_bad_byte(bytes: Uint8Array): Place {
  for (let line = 1, from = 0; ; ++line) {
    const end = bytes.indexOf(10, from);
    const part = bytes.subarray(from, end < 0 ? bytes.length : end);
    try {
      new TextDecoder("utf-8", { fatal: true }).decode(part);
    } catch {
      return { line, column: Math.max(0, new TextDecoder().decode(part).indexOf("\uFFFD")) + 1 };
    }
    from = end + 1;
  }
}

/** The text of a lesson's file with line ends "\n"; null after a mistake. */
export function decode_lesson(file: string, bytes: Uint8Array, problems: Problems): string | null {
  let text: string;
  try {
    text = new TextDecoder("utf-8", { fatal: true }).decode(bytes).replace(/\r\n?/g, "\n");
  } catch {
    problems.add(file, place_of_bad_byte(bytes), "the file is not UTF-8 from here on: save it in this encoding");
    return null;
  }
  const at = forbidden_character(text);
  if (at < 0) return text;
  problems.add(file, place_after(text.slice(0, at)), `the control character ${code_of(text[at])} cannot stand in a lesson: remove it`);
  return null;
}

export class Source {
  readonly lines: string[];

  constructor(
    /** Name in messages. */
    readonly file: string,
    readonly text: string,
    readonly problems: Problems,
  ) {
    this.lines = text.split("\n");
  }

  problem(place: Place, message: string): void {
    this.problems.add(this.file, place, message);
  }

  /** Place of a character of `content`, text that stands in the file from line `first` on, each of its lines perhaps
   * with a prefix such as "> " or the cells before it. */
  place_in(content: string, offset: number, first: number): Place {
    const before = content.slice(0, offset).split("\n");
    const line = first + before.length - 1;
    const in_line = before[before.length - 1].length;
    const text = content.split("\n")[before.length - 1];
    const start = (this.lines[line - 1] ?? "").indexOf(text);
    return { line, column: Math.max(0, start) + in_line + 1 };
  }
}
