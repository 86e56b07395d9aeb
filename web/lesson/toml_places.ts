// Places of keys in TOML text. The parser gives places of mistakes of syntax only; messages about values need more.
import type { Place } from "./problems.ts";

/** By path: "stage.id", "row[1].check", "row[1].check.of". */
export type KeyPlaces = Map<string, Place>;

const header = /^(\s*)(\[\[?)\s*([^\]]+?)\s*\]\]?/;
const key_of_line = /^(\s*)((?:"[^"]*"|'[^']*'|[A-Za-z0-9_-]+)(?:\s*\.\s*(?:"[^"]*"|'[^']*'|[A-Za-z0-9_-]+))*)\s*=/;

function plain(name: string): string {
  return name
    .split(".")
    .map((part) => part.trim().replace(/^(["'])(.*)\1$/, "$2"))
    .join(".");
}

/** The text of a line without its comment, and whether a multi-line string or a bracket stays open after it. */
class Continuation {
  private quote = "";
  private depth = 0;

  get open(): boolean {
    return this.quote !== "" || this.depth > 0;
  }

  read(line: string): void {
    for (let i = 0; i < line.length; ++i) {
      if (this.quote) {
        if (line[i] === "\\" && this.quote[0] === '"') ++i;
        else if (line.startsWith(this.quote, i)) {
          i += this.quote.length - 1;
          this.quote = "";
        }
      } else if (line[i] === "#") break;
      else if (line[i] === '"' || line[i] === "'") {
        const three = line[i].repeat(3);
        this.quote = line.startsWith(three, i) ? three : line[i];
        i += this.quote.length - 1;
      } else if ("[{".includes(line[i])) ++this.depth;
      else if ("]}".includes(line[i])) --this.depth;
    }
    if (this.quote.length === 1) this.quote = "";  // a mistake of syntax, which the parser tells
  }
}

/** `first`: line of the text's first line in the file. */
export function key_places(text: string, first: number): KeyPlaces {
  const places: KeyPlaces = new Map();
  const rows = new Map<string, number>();
  let table = "";
  const rest = new Continuation();
  text.split("\n").forEach((line, index) => {
    const continued = rest.open;
    const found = continued ? null : header.exec(line);
    if (found) {
      const name = plain(found[3]);
      table = name;
      if (found[2] === "[[") {
        const count = rows.get(name) ?? 0;
        rows.set(name, count + 1);
        table = `${name}[${count}]`;
      }
      places.set(table, { line: first + index, column: found[1].length + 1 });
      if (!places.has(name)) places.set(name, { line: first + index, column: found[1].length + 1 });
      return;
    }
    const key = continued ? null : key_of_line.exec(line);
    if (key) {
      const path = (table ? table + "." : "") + plain(key[2]);
      places.set(path, { line: first + index, column: key[1].length + 1 });
      const value = line.slice(key[0].length);
      if (value.trimStart().startsWith("{"))
        for (const inner of value.matchAll(/(?<=[{,]\s*)([A-Za-z0-9_-]+)\s*=/g))
          places.set(`${path}.${inner[1]}`, { line: first + index, column: key[0].length + inner.index + 1 });
    }
    rest.read(key ? line.slice(key[0].length) : line);
  });
  return places;
}
