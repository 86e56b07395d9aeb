// Values as MathML, and equations with values in place of their symbols.
import { mathml } from "../ui/dom.ts";
import { number_text, trimmed_text, type Digits } from "../ui/format.ts";
import type { Value, Values } from "./evaluate.ts";

/** Of the largest component: smaller ones are rounding, and shown as 0. */
const rounding = 1e-9;

const mo = (text: string): MathMLElement => mathml("mo", {}, text);

function component_text(value: number, largest: number, digits: Digits): string {
  if (digits === 17) return number_text(value, 17);
  return Math.abs(value) <= rounding * largest ? "0" : trimmed_text(value, digits);
}

/** A column of numbers, or rows of them, in brackets. */
function table(value: readonly number[], columns: number, digits: Digits): MathMLElement {
  const largest = Math.max(...value.map(Math.abs));
  const rows = [0, 1, 2].map((i) => mathml("mtr", {}, ...Array.from({ length: columns }, (_, j) =>
    mathml("mtd", {}, mathml("mn", {}, component_text(value[columns * i + j], largest, digits))))));
  return mathml("mrow", {}, mo("("), mathml("mtable", { class: "value-table" }, ...rows), mo(")"));
}

/** `infinite`: the mass or the inertia of a body that no impulse moves. */
export function value_math(value: Value, digits: Digits = 4, infinite = false): MathMLElement {
  if (infinite) return mathml("mi", {}, "\u221e");
  if (typeof value === "number") {
    const text = trimmed_text(value, digits);
    return value < 0 ? mathml("mrow", {}, mo("("), mathml("mn", {}, text), mo(")")) : mathml("mn", {}, text);
  }
  return table(value, value.length === 9 ? 3 : 1, digits);
}

/** One line of text. */
export function value_text(value: Value, digits: Digits = 4): string {
  if (typeof value === "number") return trimmed_text(value, digits);
  const largest = Math.max(...value.map(Math.abs));
  const row = (from: number): string => value.slice(from, from + 3).map((x) => component_text(x, largest, digits)).join(", ");
  return value.length === 3 ? `(${row(0)})` : `(${row(0)}; ${row(3)}; ${row(6)})`;
}

export function is_infinite(name: string, value: Value): boolean {
  return /^(m|I)[ab]?$/.test(name) && (typeof value === "number" ? value === 0 : value.every((x) => x === 0));
}

/** A copy of the equation. A symbol without a value stays. */
export function with_values(equation: Element, values: Values): Element {
  const copy = equation.cloneNode(true) as Element;
  for (const symbol of copy.querySelectorAll<MathMLElement>("[data-symbol]")) {
    const name = symbol.dataset.symbol!;
    const value = values[name];
    if (value === undefined) continue;
    const number = value_math(value, 4, is_infinite(name, value));
    number.dataset.symbol = name;
    symbol.replaceWith(number);
  }
  return copy;
}
