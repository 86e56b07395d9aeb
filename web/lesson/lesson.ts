// One lesson: its blocks, anchors and HTML.
import type { Token } from "markdown-it";
import { basename } from "node:path";
import type { BlockContext, BlockText } from "./blocks/block.ts";
import { read_convergence, type ConvergenceBlock } from "./blocks/convergence.ts";
import { read_measure, type MeasureBlock } from "./blocks/measure.ts";
import { read_numbers, type NumbersBlock } from "./blocks/numbers.ts";
import { read_quiz, type QuizBlock } from "./blocks/quiz.ts";
import { read_stage, type StageBlock } from "./blocks/stage.ts";
import { read_front_matter, type FrontMatter } from "./front_matter.ts";
import { escape_html, slug } from "./html.ts";
import { code_html, MarkdownPass } from "./markdown.ts";
import type { MathMeta } from "./markdown_math.ts";
import { math_to_html, MathError } from "./math.ts";
import { suggestion, type Place } from "./problems.ts";
import type { LessonFiles } from "./files.ts";
import type { References, Targets } from "./references.ts";
import type { Source } from "./source.ts";
import type { Table } from "./table.ts";

const block_names = ["tumble", "numbers", "quiz", "measure", "convergence"] as const;
const shown_languages = ["", "text", "toml", "sh", "console", "c", "cpp", "c++", "python", "javascript", "typescript", "json", "csv", "markdown", "pseudocode"];

/** What the lessons of a course share. */
export interface CourseContext {
  /** Filled while the lessons are read. */
  targets: Targets;
  references: References;
  files: LessonFiles;
}

export class Lesson {
  readonly name: string;
  readonly front: FrontMatter;
  readonly stages: StageBlock[] = [];
  readonly quizzes: QuizBlock[] = [];
  readonly measures: MeasureBlock[] = [];
  readonly numbers: NumbersBlock[] = [];
  readonly convergences: ConvergenceBlock[] = [];
  readonly sections: { level: number; id: string; html: string }[] = [];
  readonly answers: string[] = [];
  html = "";
  private equations = 0;
  private readonly used_stages: { id: string; table: Table }[] = [];
  private readonly pass: MarkdownPass;
  private readonly value_pass: MarkdownPass;

  constructor(readonly source: Source, private readonly course: CourseContext) {
    this.name = basename(source.file).replace(/\.md$/, "");
    this.front = read_front_matter(source);
    course.targets.add_lesson(this.name, this.front.title);
    const reads = {
      link: (place: Place, address: string, has_text: boolean) => course.references.resolve(source, place, address, this.name, has_text),
      picture: (address: string) => course.files.read_picture(source.file, address),
    };
    this.pass = new MarkdownPass(source, {
      ...reads,
      heading: (token, inline, place) => this.heading(token, inline, place),
      fence: (token, place) => this.fence(token, place),
      equation: (meta, html, place) => this.equation(meta, html, place),
    });
    // A value may stand in the page twice, as answers do, so nothing in it has a name.
    const refuse = (place: Place, what: string) => source.problem(place, `${what} cannot stand in the value of a key: write it in the text of the lesson`);
    this.value_pass = new MarkdownPass(source, {
      ...reads,
      heading: (_token, _inline, place) => refuse(place, "a heading"),
      fence: (token, place) => {
        if ((block_names as readonly string[]).includes(token.info.trim())) refuse(place, "a block");
        return this.fence_of_code(token, place);
      },
      equation: (meta, html, place) => {
        if (meta.name) refuse(place, "an equation with a name");
        return this.equation({ ...meta, name: undefined }, html, place);
      },
    });
  }

  read(): void {
    const { lines } = this.front;
    this.html = this.pass.render(this.source.lines.slice(lines).join("\n"), lines + 1);
    for (const { id, table } of this.used_stages) {
      const known = this.stages.map((stage) => stage.id);
      if (!known.includes(id)) table.problem("stage", `stage: no stage '${id}' in this lesson${suggestion(id, known)}`);
    }
  }

  private anchor(name: string, html: string, place: Place): void {
    const mistake = this.course.targets.add_anchor(this.name, name, html);
    if (mistake) this.source.problem(place, mistake);
  }

  private heading(token: Token, inline: Token, place: Place): void {
    if (token.tag === "h1")
      this.source.problem(place, "the lesson's title is in the front matter: sections begin with ##");
    const given = /\s*\{#([A-Za-z][\w-]*)\}\s*$/.exec(inline.content);
    if (given) {
      inline.content = inline.content.slice(0, given.index);
      const last = inline.children?.[inline.children.length - 1];
      if (last) last.content = last.content.replace(/\s*\{#[^}]*\}\s*$/, "");
    }
    const id = given?.[1] ?? slug(inline.content);
    token.attrSet("id", id);
    const empty = inline.children?.some((child, i, all) => child.type === "link_open" && all[i + 1].type === "link_close");
    if (empty) this.source.problem(place, "a reference in a heading needs a text: [text](#name)");
    const html = this.pass.heading_html(inline, place.line);
    this.anchor(id, html, place);
    this.sections.push({ level: Number(token.tag.slice(1)), id, html });
  }

  private equation(meta: MathMeta, html: string, place: Place): string {
    const notes = meta.notes ? `<span class="equation-notes">notes&nbsp;${escape_html(meta.notes)}</span>` : "";
    if (!meta.name && !notes) return `<div class="equation"><div class="equation-body" tabindex="0">${html}</div></div>\n`;
    let number = "";
    if (meta.name) {
      const text = `(${++this.equations})`;
      this.anchor(meta.name, text, place);
      number = `<a href="#${meta.name}">${text}</a>`;
    }
    const id = meta.name ? ` id="${meta.name}"` : "";
    return `<div class="equation"${id}><div class="equation-body" tabindex="0">${html}</div><div class="equation-number">${number}${notes}</div></div>\n`;
  }

  private fence(token: Token, place: Place): string {
    const name = token.info.trim();
    if (!(block_names as readonly string[]).includes(name)) return this.fence_of_code(token, place);
    const block: BlockText = { source: this.source, text: token.content, place, first: place.line + 1 };
    switch (name as (typeof block_names)[number]) {
      case "tumble": {
        const stage = read_stage(block, this.context);
        if (!stage) return "";
        if (stage.id) this.anchor(stage.id, "", stage.place);
        this.stages.push(stage);
        return `<!--stage:${stage.id}-->\n`;
      }
      case "numbers": {
        const numbers = read_numbers(block, this.context);
        if (!numbers) return "";
        this.numbers.push(numbers.numbers);
        return numbers.html;
      }
      case "quiz": {
        const quiz = read_quiz(block, this.context, this.quizzes.length + 1);
        if (!quiz) return "";
        this.quizzes.push(quiz.quiz);
        this.answers.push(quiz.answer);
        return quiz.html;
      }
      case "measure": {
        const measure = read_measure(block, this.context, this.measures.length);
        if (!measure) return "";
        this.measures.push(measure.measure);
        return measure.html;
      }
      case "convergence": {
        const convergence = read_convergence(block, this.context);
        if (!convergence) return "";
        this.convergences.push(convergence);
        return `<!--convergence:${this.convergences.length - 1}-->\n`;
      }
    }
  }

  private fence_of_code(token: Token, place: Place): string {
    const name = token.info.trim();
    if (shown_languages.includes(name)) return code_html(token.content, name);
    if (!(block_names as readonly string[]).includes(name))
      this.source.problem(place, `unknown block '${name}'${suggestion(name, [...block_names, ...shown_languages])}`);
    return code_html(token.content, "");
  }

  private readonly context: BlockContext = {
    markdown: (table, key, inline) => {
      const text = value_text(table, key);
      const line = this.value_line(table.place(key).line, text);
      return inline ? this.value_pass.render_inline(text, line) : this.value_pass.render(text, line);
    },
    math: (table, key) => {
      const text = value_text(table, key);
      const line = this.value_line(table.place(key).line, text);
      try {
        return math_to_html(text, true);
      } catch (error) {
        if (!(error instanceof MathError)) throw error;
        this.source.problem(this.source.place_in(text, error.offset, line), `${key}: ${error.message}`);
        return "";
      }
    },
    use_stage: (table) => {
      table.require("stage", "the id of a tumble block of this lesson");
      const id = table.text("stage") ?? "";
      if (id) this.used_stages.push({ id, table });
      return id;
    },
  };

  /** A text in three quotes may begin on the line after its key. */
  private value_line(line: number, text: string): number {
    const first = text.split("\n")[0];
    return this.source.lines[line - 1]?.includes(first) || !this.source.lines[line]?.includes(first) ? line : line + 1;
  }
}

function value_text(table: Table, key: string): string {
  const value = table.values[key];
  return typeof value === "string" ? value : "";
}
