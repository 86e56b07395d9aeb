// Checked reading of TOML tables: types, ranges, unknown keys, each mistake with its place.
import { parse, TomlError } from "smol-toml";
import { suggestion, type Place } from "./problems.ts";
import { forbidden_character, type Source } from "./source.ts";
import { key_places, type KeyPlaces } from "./toml_places.ts";

const most_whole = 1e6;  // more runs, impacts or steps than a page can hold

type Values = Record<string, unknown>;

/** What a value is, for messages. */
function given(value: unknown): string {
  if (typeof value === "string") return `text '${value}'`;
  if (Array.isArray(value)) return "a list";
  if (typeof value === "object" && value !== null) return "a table";
  return String(value);
}

export class Table {
  private read_keys = new Set<string>();

  constructor(
    readonly source: Source,
    readonly values: Values,
    private readonly places: KeyPlaces,
    private readonly path: string,
    /** Of the block or the table, for what has no place of its own. */
    readonly start: Place,
  ) {}

  place(key: string): Place {
    return this.places.get((this.path ? this.path + "." : "") + key) ?? this.start;
  }

  problem(key: string, message: string): void {
    this.source.problem(this.place(key), message);
  }

  has(key: string): boolean {
    return key in this.values;
  }

  private wrong(key: string, wanted: string): undefined {
    this.problem(key, `${key}: must be ${wanted} (given ${given(this.values[key])})`);
    return undefined;
  }

  private take(key: string): unknown {
    this.read_keys.add(key);
    return this.values[key];
  }

  /** Tells what is missing, after which reading goes on to find more. */
  require(key: string, why: string): void {
    if (!this.has(key)) this.source.problem(this.start, `${key} is missing: ${why}`);
  }

  text(key: string): string | undefined {
    const value = this.take(key);
    if (value === undefined) return undefined;
    if (typeof value !== "string") return this.wrong(key, "text");
    return forbidden_character(value) < 0 ? value : this.wrong(key, "text without control characters");
  }

  choice(key: string, known: readonly string[]): string | undefined {
    const value = this.text(key);
    if (value === undefined || known.includes(value)) return value;
    this.problem(key, `${key}: unknown name '${value}'${suggestion(value, known)}`);
    return undefined;
  }

  number(key: string, least = -Infinity, most = Infinity): number | undefined {
    const value = this.take(key);
    if (value === undefined) return undefined;
    if (typeof value !== "number" || !Number.isFinite(value)) return this.wrong(key, "a number");
    if (value < least || value > most)
      return this.wrong(key, most === Infinity ? `at least ${least}` : `in ${least} to ${most}`);
    return value;
  }

  whole(key: string, least: number): number | undefined {
    const value = this.number(key, least, most_whole);
    return value === undefined || Number.isInteger(value) ? value : this.wrong(key, "a whole number");
  }

  boolean(key: string): boolean | undefined {
    const value = this.take(key);
    if (value === undefined || typeof value === "boolean") return value;
    return this.wrong(key, "true or false");
  }

  texts(key: string, known?: readonly string[]): string[] | undefined {
    const value = this.take(key);
    if (value === undefined) return undefined;
    if (!Array.isArray(value) || !value.every((x) => typeof x === "string" && forbidden_character(x) < 0))
      return this.wrong(key, "a list of texts without control characters");
    for (const name of value)
      if (known && !known.includes(name)) this.problem(key, `${key}: unknown name '${name}'${suggestion(name, known)}`);
    return value;
  }

  numbers(key: string, count?: number): number[] | undefined {
    const value = this.take(key);
    if (value === undefined) return undefined;
    const right = Array.isArray(value) && value.every((x) => typeof x === "number" && Number.isFinite(x));
    if (!right || (count !== undefined && value.length !== count))
      return this.wrong(key, count === undefined ? "a list of numbers" : `a list of ${count} numbers`);
    return value;
  }

  table(key: string): Table | undefined {
    const value = this.take(key);
    if (value === undefined) return undefined;
    if (typeof value !== "object" || value === null || Array.isArray(value)) return this.wrong(key, "a table");
    return this.inner(key, value as Values);
  }

  tables(key: string): Table[] | undefined {
    const value = this.take(key);
    if (value === undefined) return undefined;
    if (!Array.isArray(value) || !value.every((x) => typeof x === "object" && x !== null && !Array.isArray(x)))
      return this.wrong(key, "a list of tables");
    return value.map((x, i) => this.inner(`${key}[${i}]`, x as Values));
  }

  private inner(name: string, values: Values): Table {
    return new Table(this.source, values, this.places, (this.path ? this.path + "." : "") + name, this.place(name));
  }

  /** Call last: every key that no one asked for is a mistake. */
  finish(): void {
    for (const key of Object.keys(this.values))
      if (!this.read_keys.has(key))
        this.problem(key, `unknown key '${key}'${suggestion(key, [...this.read_keys])}`);
  }
}

/** Null after a mistake of syntax. `first`: the line of the text's first line. */
export function parse_table(source: Source, text: string, first: number, start: Place): Table | null {
  try {
    return new Table(source, parse(text) as Values, key_places(text, first), "", start);
  } catch (error) {
    if (error instanceof RangeError) source.problem(start, "TOML: lists or tables are nested too deeply");
    if (error instanceof RangeError) return null;
    if (!(error instanceof TomlError)) throw error;
    const message = error.message.split("\n")[0].replace(/^Invalid TOML document: /, "");
    source.problem({ line: first + error.line - 1, column: error.column }, `TOML: ${message}`);
    return null;
  }
}
