// Rule of markdown-it for asides: "::: note Title" ... ":::". They may hold each other with longer fences.
import type { MarkdownIt } from "markdown-it";
import { suggestion } from "./problems.ts";

export const aside_kinds = ["note", "warning", "derivation", "margin"] as const;

/** `meta` of the tokens "aside_open". */
export interface AsideMeta {
  kind: string;
  title: string;
  mistake?: string;
  /** What opens it in the page, once it is made. */
  html?: string;
}

export function add_asides(markdown: MarkdownIt): void {
  markdown.block.ruler.before("fence", "aside", (state, start, end_line, silent) => {
    const text = (line: number) => state.src.slice(state.bMarks[line] + state.tShift[line], state.eMarks[line]);
    const opening = /^(:{3,})\s*(\S*)\s*(.*?)\s*$/.exec(text(start));
    if (!opening || state.sCount[start] - state.blkIndent >= 4) return false;
    if (silent) return true;
    const [, fence, kind, title] = opening;
    let line = start + 1;
    while (line < end_line && text(line).trim() !== fence) ++line;
    const meta: AsideMeta = { kind, title };
    if (!kind) meta.mistake = "':::' closes nothing here";
    else if (!(aside_kinds as readonly string[]).includes(kind))
      meta.mistake = `unknown kind of aside '${kind}'${suggestion(kind, aside_kinds)}`;
    else if (line >= end_line) meta.mistake = `the aside has no end: a line '${fence}' must close it`;

    const open = state.push("aside_open", "aside", 1);
    open.meta = { ...meta };
    open.map = [start, Math.min(line + 1, end_line)];
    if (kind) {
      const parent = state.parentType;
      const last = state.lineMax;
      state.lineMax = line;
      state.md.block.tokenize(state, start + 1, line);
      state.parentType = parent;
      state.lineMax = last;
    }
    const close = state.push("aside_close", "aside", -1);
    close.meta = { ...meta };
    state.line = kind ? Math.min(line + 1, end_line) : start + 1;
    return true;
  }, { alt: ["paragraph", "reference", "blockquote", "list"] });
}

export function aside_html(meta: AsideMeta, opening: boolean, render_title: (text: string) => string): string {
  const derivation = meta.kind === "derivation";
  if (!opening) return derivation ? "</div></details>\n" : "</aside>\n";
  const title = meta.title ? render_title(meta.title) : derivation ? "Derivation" : meta.kind === "warning" ? "Warning" : "";
  if (derivation) return `<details class="aside derivation" open><summary>${title}</summary><div>\n`;
  const heading = title ? `<p class="aside-title">${title}</p>\n` : "";
  return `<aside class="aside ${meta.kind}">${heading}`;
}
