// Lessons from strangers: their HTML stays within the list of allowed elements and attributes, and whatever is wrong in their
// text is a mistake with its place.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { files_on_disk } from "../lesson/files.ts";
import { compile_course } from "../lesson/course.ts";
import { forbidden_html } from "./allowed_html.ts";
import { faults_of_course } from "./lesson_contract.ts";
import { compile_texts } from "./lesson_texts.ts";
import { repository } from "./paths.mjs";

const head = (title = "Title", summary = "Summary") => `+++\ntitle = ${JSON.stringify(title)}\nsummary = ${JSON.stringify(summary)}\n+++\n`;
const stage = (rest = "") => `\`\`\`tumble\nformat = 1\n[stage]\nid = "drop"\nalt = "A ball."\n${rest}\n\`\`\`\n`;
const lines_above = head().split("\n").length - 1;

/** The lesson has no mistake, and its HTML is allowed. Returns the HTML. */
function body_of(lesson: string, name = "lesson.md"): string {
  const course = compile_texts({ [name]: lesson });
  assert.deepEqual(course.errors, []);
  assert.deepEqual(faults_of_course(course, new Map()), []);
  return course.lessons[0].body;
}

/** Mistakes as "LINE:COLUMN: message", lines from 1 below the head. */
function mistakes(text: string): string[] {
  return compile_texts({ "lesson.md": head() + text }).errors.map(({ line, column, message }) => `${line - lines_above}:${column}: ${message}`);
}

test("the list of allowed HTML refuses what leaves a page", () => {
  for (const html of [
    "<script>1</script>", "<p onclick=\"a\">x</p>", "<meta http-equiv=\"refresh\" content=\"0\">", "<iframe></iframe>", "<style>p{}</style>", "<base href=\"/\">",
    "<a href=\"javascript:alert(1)\">x</a>", "<a href=\"//host/\">x</a>", "<a href=\"data:text/html,x\">x</a>", "<img src=\"http://host/a.png\" alt=\"\">",
    "<p style=\"background:url(//host)\">x</p>", "<math><mi href=\"javascript:1\">x</mi></math>", "<math><maction actiontype=\"statusline#x\"></maction></math>",
    "<p id=\"a\"></p><p id=\"a\"></p>", "<!--anything-->", "<a href=\"#x\"><a href=\"#y\">z</a></a>", "<p><div></div></p>", "<p>a", "<p>\u0001</p>", "<p class=\"a\" class=\"b\">x</p>",
    "<svg><a xlink:href=\"javascript:1\"></a></svg>", "<form action=\"http://host\"></form>", "<object data=\"x\"></object>", "<p title='a'>x</p>",
  ]) assert.notDeepEqual(forbidden_html(html), [], html);
  assert.deepEqual(forbidden_html("<p>a <a href=\"b.html#c:d\">b</a><br>\n<math><mi>x</mi></math></p><!--stage:a-1-->"), []);
});

test("the lessons of the course have allowed HTML only", () => {
  const folder = join(repository, "course");
  const names = readdirSync(folder).filter((name) => /^\d.*\.md$/.test(name)).map((name) => join(folder, name));
  const course = compile_course(names, files_on_disk);
  assert.deepEqual(course.errors, []);
  assert.deepEqual(faults_of_course(course, new Map()), []);
});

const meta = "'\"><meta http-equiv=refresh content='0;url=http://host'><script>alert(1)</script><!--stage:drop-->{{body}}%%text:0%%%%href:0%%";

test("hostile texts stay texts wherever a lesson has one", () => {
  const quoted = JSON.stringify(meta);
  const places: Record<string, string> = {
    "title and summary": head(meta, meta),
    "text": head() + meta,
    "a heading": `${head()}## ${meta}\n\n## Two\n\nText`,
    "a link": `${head()}[${meta}](other.html "${meta.replaceAll('"', "'")}") <http://host/'onclick=>`,
    "a picture": `${head()}![${meta} $'>$](picture.png "${meta.replaceAll('"', "'")}")`,
    "code": `${head()}\`${meta}\`\n\n\`\`\`toml\n${meta}\n\`\`\`\n\n    ${meta}\n`,
    "a table": `${head()}| ${meta} | b |\n|:--|--:|\n| ${meta} | ${meta} |\n`,
    "an aside": `${head()}::: note ${meta}\n${meta}\n:::\n\n::: derivation ${meta}\n${meta}\n:::\n`,
    "an equation": `${head()}$\\text{${meta.replace(/[%{}]/g, "")}}$`,
    "a stage": head() + stage(`caption = ${quoted}\nplot = ${quoted}\nfollow = ${quoted}\nbody = ${quoted}`),
    "a question": `${head()}\`\`\`quiz\nquestion = ${quoted}\nanswer = 1\ntolerance = 1\nunit = ${quoted}\nhint = ${quoted}\nexplanation = ${quoted}\n\`\`\``,
    "choices": `${head()}\`\`\`quiz\nquestion = "?"\nchoices = [{ text = ${quoted}, right = true, because = ${quoted} }, { text = ${quoted} }]\n\`\`\``,
    "a table of measures": `${head()}${stage()}\`\`\`measure\nstage = "drop"\ncaption = ${quoted}\n[[row]]\nlabel = ${quoted}\nformula = ${quoted}\nexpected = 1\ntolerance = 1\nunit = ${quoted}\ncheck = { of = ${quoted}, take = "max" }\n\`\`\``,
    "an equation with numbers": `${head()}${stage()}\`\`\`numbers\nstage = "drop"\nequation = '\\jn'\nvalue = "j"\nexpression = "j"\ncaption = ${quoted}\n\`\`\``,
    "a convergence block": `${head()}\`\`\`convergence\nof = ${quoted}\nat = 1\nintegrators = ["rk4"]\nsteps_per_frame = [1, 2]\nexact = 1\nformat = 1\n[stage]\nalt = ${quoted}\ncaption = ${quoted}\n\`\`\``,
  };
  for (const [name, lesson] of Object.entries(places)) {
    const body = body_of(lesson);
    assert.ok(!body.includes("<meta") && !body.includes("<script"), name);
  }
});

test("names of files stay addresses", () => {
  for (const name of ["a'b\"c<d>&amp;#x?y.md", "100%25.md", "\u00e4 b.md"]) {
    const { index, lessons, errors } = compile_texts({ [name]: head() + "## One\n\n[](#one)", "z.md": `${head()}[text](<${name.replaceAll("%", "%25").replaceAll("#", "%23").replace(/[<>]/g, "\\$&").replaceAll("&", "&amp;")}#one>)` });
    assert.deepEqual(errors, []);
    const other = lessons.find((lesson) => lesson.name === "z")!.body;
    const address = `${encodeURIComponent(name.slice(0, -3))}.html`.replaceAll("'", "(?:'|&#39;)");
    assert.match(index, new RegExp(`href="${address}"`));
    assert.match(other, new RegExp(`href="${address}#one"`));
    assert.deepEqual([...forbidden_html(index), ...forbidden_html(other)], []);
  }
});

test("mathematics writes no HTML of its own", () => {
  const wrong: Record<string, RegExp> = {
    "\\includegraphics{x.y'><meta http-equiv=refresh content=0>}": /\\includegraphics cannot stand in a page/,
    "\\includegraphics[alt='><script>]{x.png}": /\\includegraphics cannot stand/,
    "\\data{x onclick=alert(1)}{y}": /\\data cannot stand/,
    "\\data{symbol=va,a onclick=1}{y}": /\\data cannot stand/,
    "\\data{symbol=nothing}{y}": /\\data cannot stand/,
    "\\class{a}{y}": /\\class cannot stand/,
    "\\id{content}{y}": /\\id cannot stand/,
    "\\style{background:url(http://host)}{y}": /\\style cannot stand/,
    "\\begin{align} a \\tag{1} \\label{content} \\end{align}": /\\label cannot stand in a page|only in display mode/,
    "a \\ref{content}": /a link or picture cannot stand/,
    "\\textcolor{red\"onclick=x}{y}": /Invalid color/,
    "\\href{javascript:alert(1)}{y}": /unknown command '\\href'/,
    "\\url{javascript:alert(1)}": /unknown command '\\url'/,
    "\\def\\a{\\a\\a}\\a": /Too many expansions/,
    "\\htmlClass{a}{b}": /unknown command/,
  };
  for (const [tex, expected] of Object.entries(wrong)) {
    assert.match(mistakes(`$${tex}$`).join("\n"), expected, tex);
    assert.match(mistakes(`$$\n${tex}\n$$`).join("\n"), expected, tex);
  }
  body_of(`${head()}$\\data{symbol=va}{y} \\textcolor{red}{a} \\fcolorbox{red}{blue}{b} \\boxed{c} \\cancel{d} \\phase{e} \\text{a<b>'"}$\n\n$$\n\\begin{align} a &= b \\\\ c &= d \\end{align}\n$$`);
});

const wrong: [string, string, RegExp][] = [
  ["a link with a malformed escape", "Text [a](%E0%A4%A) b", /^1:10: the address '%E0%A4%25?A' has a malformed percent escape/],
  ["a reference with a malformed escape", "[a](#%E0%A4)", /^1:5: .*malformed percent escape/],
  ["a reference to a lesson with a malformed escape", "[a](%ff.md)", /^1:5: .*malformed percent escape/],
  ["a picture with a malformed escape", "![a](%ff.png)", /^1:1: .*malformed percent escape/],
  ["a link that runs a script", "Text [a](JavaScript:alert(1))", /^1:10: a link leads to http:, https:, mailto: or/],
  ["a link of data", "<data:text/html,x>", /^1:2: a link leads to/],
  ["a link to another host without scheme", "[a](//host/x)", /^1:5: a link leads to/],
  ["a file of the reader", "[a](file:///etc/passwd)", /^1:5: a link leads to/],
  ["a section with a name of the page", "## Content", /^1:1: the name 'content' is taken by a part of the page/],
  ["a section with the name of a clip", "## Clip drop", /^1:1: the name 'clip-drop' is taken/],
  ["an equation with the name of the player", "$$a$$ {#tumble-player}", /^1:1: the name 'tumble-player' is taken/],
  ["a heading in a value", `\`\`\`quiz\nquestion = "## One"\nanswer = 1\ntolerance = 1\n\`\`\``, /^2:1: a heading cannot stand in the value of a key/],
  ["a block in a value", "```quiz\nquestion = \"```tumble\\n```\"\nanswer = 1\ntolerance = 1\n```", /^2:13: a block cannot stand in the value/],
  ["a named equation in a value", "```quiz\nquestion = '$$a$$ {#eq-a}'\nanswer = 1\ntolerance = 1\n```", /^2:\d+: an equation with a name cannot stand/],
  ["a control character of TOML", "```quiz\nquestion = \"a\\u0000b\"\nanswer = 1\ntolerance = 1\n```", /^2:1: question: must be text without control characters/],
  ["a number without end", "```quiz\nquestion = \"a\"\nanswer = inf\ntolerance = 1\n```", /^3:1: answer: must be a number/],
  ["a huge index", `${stage("run = 9e18")}`, /^6:1: run: must be in 0 to 1000000/],
  ["deep TOML", `\`\`\`quiz\na = ${"[".repeat(5000)}\n\`\`\``, /TOML: /],
  ["an expression of a name of JavaScript", `${stage()}\`\`\`numbers\nstage = "drop"\nequation = 'a'\nvalue = "j"\nexpression = "constructor(j)"\n\`\`\``, /12:15: expression: unknown function 'constructor'/],
  ["a name with a dollar sign", `${stage()}\`\`\`numbers\nstage = "drop"\nequation = 'a'\nvalue = "j"\nexpression = "j + $a"\n\`\`\``, /12:19: expression: unknown symbol '\$a'/],
  ["a number beyond all", `${stage()}\`\`\`numbers\nstage = "drop"\nequation = 'a'\nvalue = "j"\nexpression = "1e999"\n\`\`\``, /12:15: expression: the number 1e999 is too large/],
  ["a deep expression", `${stage()}\`\`\`numbers\nstage = "drop"\nequation = 'a'\nvalue = "j"\nexpression = "${"1+".repeat(5000)}1"\n\`\`\``, /12:\d+: expression: more than 200 levels/],
  ["deep parentheses", `${stage()}\`\`\`numbers\nstage = "drop"\nequation = 'a'\nvalue = "j"\nexpression = "${"(".repeat(50000)}1"\n\`\`\``, /12:\d+: expression: parentheses are nested/],
  ["deep braces of TeX", `$${"{".repeat(50000)}$`, /^1:\d+: TeX: braces or macros are nested too deeply/],
  ["a command of any length", `a $\\foo${"bar".repeat(20000)}$`, /^1:4: TeX: unknown command '\\foobarbar/],
  ["a command before a digit", "a $b \\foo2$", /^1:6: TeX: unknown command '\\foo'/],
  ["a name of any length", `${stage()}\`\`\`numbers\nstage = "drop"\nequation = 'a'\nvalue = "j"\nexpression = "j+${"b".repeat(60000)}"\n\`\`\``, /12:17: expression: unknown symbol 'bbb/],
  ["a reference without text in a heading", "## See [](#see)", /^1:1: a reference in a heading needs a text/],
];
for (const [name, text, expected] of wrong)
  test(`a mistake has its place: ${name}`, () => assert.match(mistakes(text)[0] ?? "none", expected));

test("bytes that are no text have their place", () => {
  const place = (bytes: Uint8Array) => compile_texts({ "a.md": bytes }).errors.map(({ line, column, message }) => `${line}:${column}: ${message}`);
  const text = (end: number[]) => Buffer.concat([Buffer.from(`${head()}One\u00e4 `), Buffer.from(end)]);
  assert.match(place(text([0xff, 0x41]))[0], /^5:6: the file is not UTF-8/);
  assert.match(place(text([0xe2, 0x82]))[0], /^5:6: the file is not UTF-8/);
  assert.match(place(text([0xed, 0xa0, 0x80]))[0], /^5:6: the file is not UTF-8/);
  assert.match(place(text([0x0d, 0x0a, 0x00]))[0], /^6:1: the control character U\+0000/);
  assert.match(place(text([0x1b]))[0], /^5:6: the control character U\+001B/);
  assert.deepEqual(place(Buffer.from(`\uFEFF${head()}Text`)), []);
});

test("marks of the compiler mean nothing in a text", () => {
  const body = body_of(`${head()}## One\n\n[](#one) %%text:0%% %%text:99%% %%href:99%%`);
  assert.match(body, /%%text:0%% %%text:99%% %%href:99%%/);
  assert.match(body, /<a href="#one">One<\/a>/);
});

test("a heading with a link is no link within a link", () => {
  const body = body_of(`${head()}## One [two](#three)\n\n## Three\n\n[](#one-two-three)`);
  assert.match(body, /<h2 id="one-two-three">One <a href="#three">two<\/a><\/h2>/);
  assert.match(body, /<a href="#one-two-three">One two<\/a>/);
});
