// Markdown to HTML: markdown-it with our rules, and a pass over its tokens that knows where they stand in the file.
import MarkdownIt from "markdown-it";
import type { Token } from "markdown-it";
import { extname } from "node:path";
import { decode_address, link_mistake } from "./addresses.ts";
import { aside_html, add_asides, type AsideMeta } from "./markdown_aside.ts";
import { add_math, type MathMeta } from "./markdown_math.ts";
import { escape_html } from "./html.ts";
import { math_to_html, MathError } from "./math.ts";
import type { Place } from "./problems.ts";
import type { Link } from "./references.ts";
import type { Source } from "./source.ts";

/** What the pass does with parts that belong to a lesson as a whole. */
export interface Handlers {
  heading(token: Token, inline: Token, place: Place): void;
  /** Where a reference of the lessons leads; null: the address is none. */
  link(place: Place, address: string, has_text: boolean): Link | null;
  /** Throws an Error whose message says why the file cannot be read. */
  picture(address: string): Uint8Array;
  /** HTML of a fenced block. */
  fence(token: Token, place: Place): string;
  equation(meta: MathMeta, html: string, place: Place): string;
}

/** Our rules put it there. */
function meta_of<Meta extends MathMeta | AsideMeta>(token: Token): Meta {
  return token.meta as unknown as Meta;
}

const markdown = new MarkdownIt({ html: false, typographer: true });
// Addresses are checked with their places, where the parser would show the source of the link.
markdown.validateLink = () => true;
add_math(markdown);
add_asides(markdown);
markdown.renderer.rules.math_inline = (tokens, i) => meta_of<MathMeta>(tokens[i]).html ?? "";
markdown.renderer.rules.math_block = (tokens, i) => meta_of<MathMeta>(tokens[i]).html ?? "";
markdown.renderer.rules.aside_open = (tokens, i) => meta_of<AsideMeta>(tokens[i]).html ?? "";
markdown.renderer.rules.aside_close = (tokens, i) => aside_html(meta_of<AsideMeta>(tokens[i]), false, String);
markdown.renderer.rules.table_open = () => '<div class="table" role="group" aria-label="Table" tabindex="0"><table>\n';
markdown.renderer.rules.table_close = () => "</table></div>\n";
markdown.renderer.rules.lesson_html = (tokens, i) => tokens[i].content;

const image_types: Record<string, string> = {
  ".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg", ".svg": "image/svg+xml", ".webp": "image/webp", ".gif": "image/gif",
};

export class MarkdownPass {
  constructor(
    private readonly source: Source,
    private readonly handlers: Handlers,
  ) {}

  /** `first`: line of the text's first line in the file. */
  render(text: string, first: number): string {
    const tokens = markdown.parse(text, {});
    this.walk(tokens, first);
    return markdown.renderer.render(tokens, markdown.options, {});
  }

  render_inline(text: string, first: number): string {
    const tokens = markdown.parseInline(text, {});
    for (const token of tokens) this.inline(token, first);
    return markdown.renderer.render(tokens, markdown.options, {});
  }

  /** HTML of a heading for other places, which may stand in a link of their own. */
  heading_html(inline: Token, line: number): string {
    this.inline(inline, line);
    inline.meta = { ...inline.meta, done: true };
    const children = (inline.children ?? []).filter((child) => child.type !== "link_open" && child.type !== "link_close");
    return markdown.renderer.renderInline(children, markdown.options, {});
  }

  private walk(tokens: Token[], first: number): void {
    let line = first;
    tokens.forEach((token, i) => {
      if (token.map) line = first + token.map[0];
      const place = { line, column: 1 };
      if (token.type === "inline") {
        if (!token.meta?.done) this.inline(token, line);
      } else if (token.type === "heading_open") this.handlers.heading(token, tokens[i + 1], place);
      else if (token.type === "th_open" && tokens[i + 1].content === "") token.tag = tokens[i + 2].tag = "td";
      else if (token.type === "math_block") this.block_math(token, first);
      else if (token.type === "aside_open") this.aside(token, place);
      else if (token.type === "fence") {
        token.content = this.handlers.fence(token, { line, column: this.column_of(line, token.markup) });
        token.type = "lesson_html";
      }
    });
  }

  private column_of(line: number, text: string): number {
    return Math.max(0, (this.source.lines[line - 1] ?? "").indexOf(text)) + 1;
  }

  private inline(token: Token, first: number): void {
    const children = token.children ?? [];
    // The parser gives no places: the marks are found in the text in the order of reading.
    let after_link = 0, after_image = 0;
    const place = (offset: number) => this.source.place_in(token.content, Math.max(0, offset), first);
    for (let i = 0; i < children.length; ++i) {
      const child = children[i];
      if (child.type === "math_inline") {
        const meta = meta_of<MathMeta>(child);
        if (meta.mistake) this.source.problem(place(meta.offset - 1), meta.mistake);
        else meta.html = this.math(meta.tex, false, (offset) => place(meta.offset + offset));
      } else if (child.type === "link_open") {
        const address = decode_address(String(child.attrGet("href") ?? "")) ?? "";
        // <address> has no brackets.
        const mark = [`](${address}`, "](", "<"].find((text) => token.content.includes(text, after_link)) ?? "";
        after_link = token.content.indexOf(mark, after_link) + (mark.startsWith("](") ? 2 : mark.length);
        this.link(children, i, place(after_link));
      } else if (child.type === "image") {
        const offset = token.content.indexOf("![", after_image);
        after_image = offset + 1;
        this.image(child, place(offset));
      }
    }
    for (let i = children.length - 1; i > 0; --i) {
      const text = children[i].type === "link_close" ? (children[i].meta?.text as string | undefined) : undefined;
      if (text === undefined) continue;
      const inserted = Object.assign(Object.create(Object.getPrototypeOf(children[i])), children[i], { type: "lesson_html", content: text, meta: null });
      children.splice(i, 0, inserted);
    }
  }

  private math(tex: string, display: boolean, place: (offset: number) => Place): string {
    try {
      return math_to_html(tex, display);
    } catch (error) {
      if (!(error instanceof MathError)) throw error;
      this.source.problem(place(error.offset), error.message);
      return "";
    }
  }

  private block_math(token: Token, first: number): void {
    const meta = meta_of<MathMeta>(token);
    const line = first + (meta.line ?? 0);
    const start = { line, column: this.column_of(line, "$$") };
    if (meta.mistake) {
      this.source.problem(start, meta.mistake);
      return;
    }
    const html = this.math(meta.tex, true, (offset) => {
      const before = meta.tex.slice(0, offset).split("\n");
      const text = meta.tex.split("\n")[before.length - 1];
      const at = (this.source.lines[line - 1 + before.length - 1] ?? "").indexOf(text);
      return { line: line + before.length - 1, column: Math.max(0, at) + before[before.length - 1].length + 1 };
    });
    meta.html = this.handlers.equation(meta, html, start);
  }

  private aside(token: Token, place: Place): void {
    const meta = meta_of<AsideMeta>(token);
    if (meta.mistake) this.source.problem({ line: place.line, column: this.column_of(place.line, ":::") }, meta.mistake);
    meta.html = aside_html(meta, true, (title) => this.render_inline(title, place.line));
  }

  /** `children[i]` opens it. */
  private link(children: Token[], i: number, place: Place): void {
    const open = children[i];
    const address = String(open.attrGet("href") ?? "");
    open.attrSet("href", "#");
    const mistake = link_mistake(address);
    if (mistake) {
      this.source.problem(place, mistake);
      return;
    }
    const empty = children[i + 1]?.type === "link_close";
    const link = this.handlers.link(place, address, !empty);
    open.attrSet("href", link?.href ?? address);
    if (empty && link) children[i + 1].meta = { text: link.text };
  }

  /** Pages are one file: pictures go into it. */
  private image(token: Token, place: Place): void {
    const written = String(token.attrGet("src") ?? "");
    token.attrSet("src", "");
    // The parser's own text for readers who do not see it leaves equations out.
    for (const child of token.children ?? [])
      if (child.type === "math_inline") Object.assign(child, { type: "text", content: meta_of<MathMeta>(child).tex });
    if (!token.content) this.source.problem(place, "the picture needs a text for readers who do not see it: ![text](file)");
    const address = decode_address(written);
    if (address === null) {
      this.source.problem(place, link_mistake(written));
      return;
    }
    const type = image_types[extname(address).toLowerCase()];
    if (/^[a-z][a-z0-9+.-]*:/i.test(address) || !type) {
      this.source.problem(place, `a picture must be a file of ${Object.keys(image_types).join(", ")} (given '${address}')`);
      return;
    }
    try {
      token.attrSet("src", `data:${type};base64,${Buffer.from(this.handlers.picture(address)).toString("base64")}`);
    } catch (error) {
      this.source.problem(place, `cannot read the picture '${address}': ${(error as Error).message}`);
    }
  }
}

/** Code that is only shown. */
export function code_html(text: string, language: string): string {
  const name = language ? ` class="language-${escape_html(language)}"` : "";
  return `<pre tabindex="0"><code${name}>${escape_html(text)}</code></pre>\n`;
}
