// The compiler of lessons: mistakes with line and column, references, macros, expressions.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import type { CourseOutput } from "../lesson/course.ts";
import { ExpressionError, parse_expression } from "../lesson/expression.ts";
import { math_to_html } from "../lesson/math.ts";
import { suggestion } from "../lesson/problems.ts";
import { symbol_types, symbols } from "../lesson/symbols.ts";
import { evaluate, residual } from "../src/lesson/evaluate.ts";
import { is_right, read_answer } from "../src/lesson/quiz.ts";
import { impact_values, moment_values } from "../src/lesson/symbol_values.ts";
import { compile_texts } from "./lesson_texts.ts";
import { repository } from "./paths.mjs";
import { ball_mass, gravity, make_synthetic_run } from "./synthetic_clip.ts";

const head = `+++
title = "Bounce"
summary = "How high?"
+++
`;
const stage = `\`\`\`tumble
format = 1
title = "Drop"

[stage]
id = "drop"
alt = "A ball falls."

[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.1 }
\`\`\`
`;

function compile(...texts: string[]): CourseOutput {
  return compile_texts(Object.fromEntries(texts.map((text, i) => [`lesson${i + 1}.md`, text])));
}

/** "LINE:COLUMN: message", of a lesson that has this text after its head. */
function mistakes(text: string, with_head = true): string[] {
  return compile((with_head ? head : "") + text).errors.map(({ line, column, message }) => `${line}:${column}: ${message}`);
}

test("a lesson without mistakes has none", () => {
  const course = compile(`${head}## One\n\nSee [](#one).\n\n${stage}`);
  assert.deepEqual(course.errors, []);
  assert.equal(course.lessons[0].title, "Bounce");
  assert.match(course.lessons[0].body, /<a href="#one">One<\/a>/);
});

const wrong: [string, string, RegExp][] = [
  ["unknown TeX command", "Text, *and* $a + \\vrl$.", /^5:18: TeX: unknown command '\\vrl' \(nearest: '\\vrel'\)$/],
  ["TeX in a block", "$$\na +\n\\foo{b}\n$$", /^7:1: TeX: unknown command '\\foo'$/],
  ["TeX in a list", "- one\n- two $\\foo$", /^6:8: TeX: unknown command/],
  ["a character that the font lacks", "A $\\text{\u2a3f} + \\amalg$.", /^5:4: TeX: the font of pages has no '\u2a3f' \(U\+2A3F\)/],
  ["a dollar without end", "It costs 5 $ here.", /^5:12: '\$' has no end/],
  ["display mathematics without end", "$$\na", /^5:1: \$\$ has no end$/],
  ["attributes of an equation", "$$ a $$ {#eq-a note=20}", /^5:1: unknown attribute 'note=20' \(known: #name, notes=NUMBER\)$/],
  ["a name used twice", "$$ a $$ {#eq-a}\n\n$$ b $$ {#eq-a}", /^7:1: the name 'eq-a' is used twice/],
  ["a reference without target", "One\ntwo [](#eq-b) three\n\n$$ a $$ {#eq-a}", /^6:8: no target '#eq-b' in lesson1.md \(nearest: 'eq-a'\)$/],
  ["a lesson that is not there", "See [it](lesson3.md).", /^5:10: no lesson 'lesson3.md'/],
  ["a reference to a stage without text", `See [](#drop).\n\n${stage}`, /^5:8: the reference needs a text/],
  ["an unknown block", "```quizz\n```", /^5:1: unknown block 'quizz' \(nearest: 'quiz'\)$/],
  ["an unknown aside", "::: notes\nText\n:::", /^5:1: unknown kind of aside 'notes' \(nearest: 'note'\)$/],
  ["an aside without end", "::: note\nText", /^5:1: the aside has no end/],
  ["a title in the text", "# Title", /^5:1: the lesson's title is in the front matter/],
  ["a syntax mistake of TOML", "```quiz\nquestion = \"?\"\nanswer = 1,5\n```", /^7:\d+: TOML: /],
  ["an unknown key", stage.replace('alt = "A', 'overlai = []\nalt = "A'), /^11:1: unknown key 'overlai' \(nearest: 'overlay'\)$/],
  ["a missing key", stage.replace(/alt = .*\n/, ""), /^9:1: alt is missing: a text for readers/],
  ["an unknown overlay", stage.replace("alt =", 'overlay = ["velocty"]\nalt ='), /^11:1: overlay: unknown name 'velocty' \(nearest: 'velocity'\)$/],
  ["a scene twice", stage.replace("alt =", 'scene = "a.toml"\nalt ='), /^6:1: 'format' stands beside scene/],
  ["an unknown stage", `${stage}\n\`\`\`measure\nstage = "drip"\nrow = []\n\`\`\``, /^19:1: stage: no stage 'drip' in this lesson \(nearest: 'drop'\)$/],
  ["choices of which none is right", "```quiz\nquestion = \"?\"\nchoices = [{ text = \"a\" }, { text = \"b\" }]\n```", /^7:1: choices: one of them must have right = true \(given 0\)$/],
  ["a single choice", "```quiz\nquestion = \"?\"\nchoices = [{ text = \"a\", right = true }]\n```", /^7:1: choices: must be 2 to 8 tables \(given 1\)$/],
  ["a number beside choices", "```quiz\nquestion = \"?\"\nchoices = [{ text = \"a\", right = true }, { text = \"b\" }]\nanswer = 1\n```", /^8:1: answer: is of questions with a number, not of choices$/],
  ["a check without quantity", `${stage}\n\`\`\`quiz\nquestion = "?"\nstage = "drop"\nanswer = 1\ntolerance = 1\ncheck = { off = 1 }\n\`\`\``, /^23:1: check: needs 'of' with 'take'/],
];
for (const [name, text, expected] of wrong) {
  test(`a mistake has its place: ${name}`, () => {
    const [first, ...others] = mistakes(text);
    assert.match(first ?? "", expected, others.join("\n"));
  });
}

test("front matter is required", () => {
  assert.match(mistakes("Text", false)[0], /^1:1: the file must begin with front matter/);
  assert.match(mistakes('+++\ntitel = "A"\n+++\n', false).join("\n"), /2:1: unknown key 'titel' \(nearest: 'title'\)/);
});

function numbers_block(expression: string, moment = "impact", value = "j"): string {
  return `${stage}\n\`\`\`numbers\nstage = "drop"\nmoment = "${moment}"\nequation = '''\\jn'''\nvalue = "${value}"\nexpression = "${expression}"\n\`\`\``;
}

test("mistakes of expressions have their column", () => {
  assert.deepEqual(mistakes(numbers_block("ima + imc")), ["23:21: expression: unknown symbol 'imc' (nearest: 'ima')"]);
  assert.match(mistakes(numbers_block("n * n"))[0], /^23:\d+: expression: '\*' cannot join a vector and a vector: use dot\(\) or cross\(\)$/);
  assert.match(mistakes(numbers_block("norm(m)"))[0], /unknown symbol 'm' \(it is a symbol of moment = "now"\)/);
  assert.match(mistakes(numbers_block("n"))[0], /^22:1: value: a number cannot equal the expression, a vector$/);
  assert.match(mistakes(numbers_block("dot(n)"))[0], /dot\(\) takes a vector and a vector \(given a vector\)/);
  assert.match(mistakes(numbers_block("vrel +"))[0], /^23:\d+: expression: /);
  for (const text of ["process.exit()", "a ? b : c", "'x'", "n[0]", "this", "!e", "e ** 2"])
    assert.throws(() => parse_expression(text, "impact"), ExpressionError, text);
});

test("equations are numbered in their order and found from other lessons", () => {
  const course = compile(
    `${head}$$ a $$ {#eq-a}\n\n$$ b $$\n\n$$ c $$ {#eq-c notes=20}\n\nSee [](#eq-c).`,
    `${head}See [](lesson1.md#eq-c), [](lesson1.md), [text](lesson1.md#eq-a).`);
  assert.deepEqual(course.errors, []);
  assert.match(course.lessons[0].body, /<a href="#eq-c">\(2\)<\/a><span class="equation-notes">notes&nbsp;20<\/span>/);
  assert.match(course.lessons[0].body, /See <a href="#eq-c">\(2\)<\/a>/);
  const second = course.lessons[1].body;
  assert.match(second, /<a href="lesson1.html#eq-c">\(2\) of \u201cBounce\u201d<\/a>/);
  assert.match(second, /<a href="lesson1.html">Bounce<\/a>/);
  assert.match(second, /<a href="lesson1.html#eq-a">text<\/a>/);
});

test("lessons come in their order, then by name", () => {
  const ordered = (order: number) => head.replace('title = "Bounce"', `title = "Order ${order}"\norder = ${order}`);
  const course = compile(ordered(3), ordered(-1), ordered(2));
  assert.deepEqual(course.lessons.map((lesson) => lesson.title), ["Order -1", "Order 2", "Order 3"]);
});

test("every macro is marked with a symbol, in inline mathematics and in blocks", () => {
  for (const { macro, name } of symbols)
    for (const display of [false, true])
      assert.match(math_to_html(`x = \\${macro}`, display), new RegExp(`data-symbol="${name}"`), macro);
  assert.match(math_to_html("\\va^2 \\vrelm^2", false), /data-symbol="va".*data-symbol="vrel"/s);
});

test("an empty corner of a table is no heading", () => {
  const { body } = compile(`${head}| | one |\n|---|---|\n| two | 3 |`).lessons[0];
  assert.match(body, /<td><\/td>\s*<th>one<\/th>/);
});

test("HTML of a lesson is text", () => {
  const { body } = compile(`${head}<script>alert(1)</script> & [x](javascript:alert(1))`).lessons[0];
  assert.doesNotMatch(body, /<script|href="javascript/);
});

test("the text of an inline scene stays on its lines", () => {
  const { stages } = compile(`${head}\n${stage}`).lessons[0];
  const lines = stages[0].text!.split("\n");
  const source = `${head}\n${stage}`.split("\n");
  assert.equal(lines.indexOf('name = "ball"'), source.indexOf('name = "ball"'));
  assert.ok(!stages[0].text!.includes("alt ="));
});

test("names nearby are suggested, others are not", () => {
  assert.equal(suggestion("velocty", ["velocity", "forces"]), " (nearest: 'velocity')");
  assert.equal(suggestion("zzzzzz", Array.from({ length: 20 }, (_, i) => `name${i}`)), "");
});

const eq_20 = "-(1+e)*vrel/(ima+imb+dot(n,cross(iIa*cross(ra,n),ra))+dot(n,cross(iIb*cross(rb,n),rb)))";
const run = make_synthetic_run(0.5);

test("the numbers of an impact satisfy the equations of the impulse", () => {
  for (const [index, impact] of run.impacts.entries()) {
    if (impact.b !== "ball" || impact.v_after === 0) continue;   // the last bounce ends in rest, against its restitution
    const values = impact_values(run, index);
    const agree = (left: string, right: string) => {
      const difference = residual(evaluate(parse_expression(left, "impact").tree, values), evaluate(parse_expression(right, "impact").tree, values));
      assert.ok(difference < 1e-12, `impact ${index}: ${left} = ${right}: residual ${difference}`);
    };
    agree("j", eq_20);
    agree("vrelp", "-e*vrel");
    agree("vbp", "vb + j*ima*n + j*imb*n");
    agree("dot(n, ub - ua)", "vrel");
    agree("dot(n, ubp - uap)", "vrelp");
  }
});

test("the numbers of a moment satisfy the definitions", () => {
  const values = moment_values(run, 0.2, 1, false);
  const agree = (left: string, right: string) => assert.ok(
    residual(evaluate(parse_expression(left, "now").tree, values), evaluate(parse_expression(right, "now").tree, values)) < 1e-12, left);
  agree("P", "m*v");
  agree("L", "I*w");
  agree("R*transpose(R)*x", "x");
  assert.equal(values.m, ball_mass);
  assert.ok(Math.abs((values.Ekin as number) - (ball_mass * (gravity * 0.2) ** 2) / 2) < 1e-12);
  const spinning = moment_values(run, 0.1, 2, false);
  assert.ok(residual(evaluate(parse_expression("iI*L", "now").tree, spinning), spinning.w) < 1e-12);
});

test("answers are read as people write them", () => {
  assert.equal(read_answer("0,64"), 0.64);
  assert.equal(read_answer(" \u22123.5 "), -3.5);
  assert.equal(read_answer("3e-4"), 3e-4);
  assert.equal(read_answer("1.2\u00b710^-3"), 1.2e-3);
  for (const text of ["", "x", "1.2.3", "1 m", "NaN", "Infinity"]) assert.equal(read_answer(text), null, text);
  assert.ok(is_right(0.65, 0.64, 0.01) && !is_right(0.6511, 0.64, 0.01));
});

test("the reference names every symbol, and every name in expressions", () => {
  const reference = readFileSync(join(repository, "docs/reference/lessons.md"), "utf8");
  for (const { macro, name, meaning } of symbols)
    assert.ok(reference.includes(`| \`\\${macro}\` | \`${name}\` | ${meaning} |`), macro);
  for (const types of Object.values(symbol_types))
    for (const name of types.keys()) assert.ok(reference.includes(`\`${name}\``), name);
});
