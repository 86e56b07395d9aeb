// Rules of markdown-it for $...$, and for $$ ... $$ {#name notes=20}.
import type { MarkdownIt } from "markdown-it";

/** `meta` of the tokens "math_inline" and "math_block". */
export interface MathMeta {
  tex: string;
  /** Of an inline formula: in the content of the inline token. Of a block: line and column from 0 of its text. */
  offset: number;
  line?: number;
  /** Of a block: name for references, number in the course notes. */
  name?: string;
  notes?: string;
  mistake?: string;
  /** What stands in the page, once it is made. */
  html?: string;
}

export function add_math(markdown: MarkdownIt): void {
  markdown.inline.ruler.before("escape", "math_inline", (state, silent) => {
    const { src, pos } = state;
    if (src[pos] !== "$") return false;
    let end = pos + 1;
    while (end < src.length && src[end] !== "$") end += src[end] === "\\" ? 2 : 1;
    let mistake: string | undefined;
    if (src[pos + 1] === "$") mistake = "$$ must stand at the start of a line, with an empty line before it";
    else if (end >= src.length) mistake = "'$' has no end; write \\$ for the sign itself";
    if (!silent) {
      const token = state.push("math_inline", "", 0);
      token.meta = { tex: mistake ? "" : src.slice(pos + 1, end), offset: pos + 1, mistake } satisfies Partial<MathMeta>;
    }
    state.pos = mistake ? src.length : end + 1;
    return true;
  });

  markdown.block.ruler.before("fence", "math_block", (state, start, end_line, silent) => {
    const text = (line: number) => state.src.slice(state.bMarks[line] + state.tShift[line], state.eMarks[line]);
    if (!text(start).startsWith("$$") || state.sCount[start] - state.blkIndent >= 4) return false;
    if (silent) return true;
    const lines = [text(start).slice(2)];
    let line = start;
    while (!lines[lines.length - 1].includes("$$") && line + 1 < end_line && state.sCount[line + 1] >= state.blkIndent)
      lines.push(text(++line));
    const whole = lines.join("\n");
    const close = whole.indexOf("$$");
    const meta: MathMeta = { tex: close < 0 ? whole : whole.slice(0, close), offset: 2, line: start };
    if (close < 0) meta.mistake = "$$ has no end";
    else read_attributes(whole.slice(close + 2).trim(), meta);
    const token = state.push("math_block", "", 0);
    token.meta = { ...meta };
    token.map = [start, line + 1];
    state.line = line + 1;
    return true;
  }, { alt: ["paragraph", "reference", "blockquote", "list"] });
}

function read_attributes(text: string, meta: MathMeta): void {
  if (!text) return;
  const braces = /^\{([^}]*)\}$/.exec(text);
  if (!braces) {
    meta.mistake = `only {#name notes=NUMBER} may follow $$ on its line (given '${text}')`;
    return;
  }
  for (const word of braces[1].split(/\s+/).filter(Boolean)) {
    const name = /^#([A-Za-z][\w-]*)$/.exec(word);
    const notes = /^notes=([\w.,-]+)$/.exec(word);
    if (name) meta.name = name[1];
    else if (notes) meta.notes = notes[1];
    else meta.mistake = `unknown attribute '${word}' (known: #name, notes=NUMBER)`;
  }
}
