// Expressions of "Put in the numbers", as trees that the compiler of lessons has checked.
import type { Mat3, Vec3 } from "../data/clip.ts";
import type { Tree } from "../../lesson/expression.ts";
import { cross, dot, multiply, norm, transform, transpose } from "../panels/linear.ts";

export type Value = number | Vec3 | Mat3;
/** Values of symbols. */
export type Values = Readonly<Record<string, Value>>;

const is_vector = (value: Value): value is Vec3 => typeof value !== "number" && value.length === 3;
const is_matrix = (value: Value): value is Mat3 => typeof value !== "number" && value.length === 9;

function each(value: Value, change: (x: number) => number): Value {
  return typeof value === "number" ? change(value) : (value.map(change) as Vec3 | Mat3);
}

function pairwise(a: Value, b: Value, join: (x: number, y: number) => number): Value {
  if (typeof a === "number" && typeof b === "number") return join(a, b);
  if (typeof a === "number" || typeof b === "number" || a.length !== b.length) throw new Error("sum of different kinds");
  return a.map((x, i) => join(x, b[i])) as Vec3 | Mat3;
}

function times(a: Value, b: Value): Value {
  if (typeof a === "number") return each(b, (x) => a * x);
  if (typeof b === "number") return each(a, (x) => x * b);
  if (is_matrix(a)) return is_vector(b) ? transform(a, b) : multiply(a, b as Mat3);
  throw new Error("product of two vectors");
}

export function evaluate(tree: Tree, values: Values): Value {
  if (typeof tree === "number") return tree;
  if (typeof tree === "string") {
    const value = values[tree];
    if (value === undefined) throw new Error(`no value of ${tree}`);
    return value;
  }
  const [a, b] = tree.of.map((inner) => evaluate(inner, values));
  switch (tree.op) {
    case "+": return pairwise(a, b, (x, y) => x + y);
    case "-": return pairwise(a, b, (x, y) => x - y);
    case "*": return times(a, b);
    case "/": return each(a, (x) => x / (b as number));
    case "neg": return each(a, (x) => -x);
    case "dot": return dot(a as Vec3, b as Vec3);
    case "cross": return cross(a as Vec3, b as Vec3);
    case "norm": return norm(a as Vec3);
    case "transpose": return transpose(a as Mat3);
  }
}

/** Root of the sum of squares. */
export function magnitude(value: Value): number {
  return typeof value === "number" ? Math.abs(value) : Math.hypot(...value);
}

/** |left - right|. */
export function difference(left: Value, right: Value): number {
  return magnitude(pairwise(left, right, (x, y) => x - y));
}

/** |left - right| over the larger of them; 0 if both are 0. */
export function residual(left: Value, right: Value): number {
  const largest = Math.max(magnitude(left), magnitude(right));
  return largest === 0 ? 0 : difference(left, right) / largest;
}
