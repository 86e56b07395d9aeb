// The text of a lesson's file, and places in it.
import { Problems, type Place } from "./problems.ts";

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
