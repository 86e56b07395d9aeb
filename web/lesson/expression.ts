// Expressions of "Put in the numbers": parsed and checked for their types when the lesson is built, so that the page needs
// no parser.
import jsep from "jsep";
import { index_of_word, suggestion, type Place } from "./problems.ts";
import { symbol_types, type Moment, type ValueType } from "./symbols.ts";

/** What the page evaluates. */
export type Tree = number | string | { op: "+" | "-" | "*" | "/" | "neg" | "dot" | "cross" | "norm" | "transpose"; of: Tree[] };

export class ExpressionError extends Error {
  constructor(
    message: string,
    /** In the text, from 0. */
    readonly offset: number,
  ) {
    super(message);
  }
}

/** Types of the arguments, and of the value. */
const functions: Record<string, [ValueType[], ValueType]> = {
  dot: [["vector", "vector"], "number"],
  cross: [["vector", "vector"], "vector"],
  norm: [["vector"], "number"],
  transpose: [["matrix"], "matrix"],
};

const most_depth = 200;  // the page reads the tree by recursion

interface Typed {
  tree: Tree;
  type: ValueType;
}

class Reader {
  private from = 0;
  private depth = 0;

  constructor(private readonly text: string, private readonly moment: Moment) {}

  /** jsep gives no places: names are found in the text in the order of reading. */
  private place_of(name: string): number {
    const found = index_of_word(this.text, name, this.from);
    if (found < 0) return this.from;
    this.from = found + name.length;
    return found;
  }

  read(node: jsep.Expression): Typed {
    if (++this.depth > most_depth) throw new ExpressionError(`more than ${most_depth} levels of parentheses or terms`, this.from);
    const read = this.read_node(node);
    --this.depth;
    return read;
  }

  private read_node(node: jsep.Expression): Typed {
    switch (node.type) {
      case "Literal":
        if (typeof node.value !== "number") break;
        if (!Number.isFinite(node.value)) throw new ExpressionError(`the number ${String(node.raw)} is too large`, this.from);
        return { tree: node.value, type: "number" };
      case "Identifier":
        return this.symbol(node.name as string);
      case "UnaryExpression": {
        const inner = this.read(node.argument as jsep.Expression);
        if (node.operator === "-") return { tree: { op: "neg", of: [inner.tree] }, type: inner.type };
        if (node.operator === "+") return inner;
        break;
      }
      case "BinaryExpression":
        return this.binary(node as jsep.BinaryExpression);
      case "CallExpression":
        return this.call(node as jsep.CallExpression);
    }
    throw new ExpressionError("only numbers, symbols, + - * / and functions are allowed", this.from);
  }

  private symbol(name: string): Typed {
    const offset = this.place_of(name);
    const types = symbol_types[this.moment];
    const type = types.get(name);
    if (type) return { tree: name, type };
    const other: Moment = this.moment === "impact" ? "now" : "impact";
    const hint = symbol_types[other].has(name)
      ? ` (it is a symbol of moment = "${other}")` : suggestion(name, [...types.keys(), ...Object.keys(functions)]);
    throw new ExpressionError(`unknown symbol '${name}'${hint}`, offset);
  }

  private binary(node: jsep.BinaryExpression): Typed {
    const left = this.read(node.left);
    const right = this.read(node.right);
    const op = node.operator;
    if (op === "+" || op === "-") {
      if (left.type === right.type) return { tree: { op, of: [left.tree, right.tree] }, type: left.type };
    } else if (op === "*") {
      const type = product(left.type, right.type);
      if (type) return { tree: { op, of: [left.tree, right.tree] }, type };
    } else if (op === "/") {
      if (right.type === "number") return { tree: { op, of: [left.tree, right.tree] }, type: left.type };
    } else {
      throw new ExpressionError(`unknown operator '${op}' (known: + - * /)`, Math.max(0, this.text.indexOf(op)));
    }
    const hint = op === "*" && left.type === "vector" && right.type === "vector" ? ": use dot() or cross()" : "";
    throw new ExpressionError(`'${op}' cannot join a ${left.type} and a ${right.type}${hint}`, this.from);
  }

  private call(node: jsep.CallExpression): Typed {
    const name = (node.callee as jsep.Identifier).name ?? "";
    const offset = this.place_of(name);
    const types = Object.hasOwn(functions, name) ? functions[name] : undefined;
    if (!types) throw new ExpressionError(`unknown function '${name}'${suggestion(name, Object.keys(functions))}`, offset);
    const values = node.arguments.map((argument) => this.read(argument));
    const [wanted, type] = types;
    if (values.length !== wanted.length || values.some((value, i) => value.type !== wanted[i]))
      throw new ExpressionError(`${name}() takes ${wanted.map((w) => `a ${w}`).join(" and ")} (given ${
        values.map((value) => `a ${value.type}`).join(", ") || "nothing"})`, offset);
    return { tree: { op: name as "dot", of: values.map((value) => value.tree) }, type };
  }
}

function product(left: ValueType, right: ValueType): ValueType | null {
  if (left === "number") return right;
  if (right === "number") return left;
  if (left === "matrix") return right;
  return null;
}

/** Throws ExpressionError. */
export function parse_expression(text: string, moment: Moment): Typed {
  let node: jsep.Expression;
  try {
    node = jsep(text);
  } catch (error) {
    const { message, index, description } = error as Error & { index?: number; description?: string };
    throw new ExpressionError(error instanceof RangeError ? "parentheses are nested too deeply" : description ?? message, index ?? 0);
  }
  if (node.type === "Compound") throw new ExpressionError("an operator is missing, or the text is empty", 0);
  return new Reader(text, moment).read(node);
}

/** Place of an error in a value of one line: `place` is that of its key. */
export function place_in_value(line: string, place: Place, text: string, offset: number): Place {
  const start = line.indexOf(text, place.column - 1);
  return start < 0 ? place : { line: place.line, column: start + offset + 1 };
}
