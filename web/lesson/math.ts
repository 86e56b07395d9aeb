// TeX to MathML, when the lesson is built: the page carries no TeX and no font of many weights.
import temml from "temml";
import { math_characters } from "../build/math_characters.mjs";
import { suggestion } from "./problems.ts";
import { symbol_macros, symbols } from "./symbols.ts";

export class MathError extends Error {
  constructor(
    message: string,
    /** In the TeX, from 0. */
    readonly offset: number,
  ) {
    super(message);
  }
}

const in_font = new Set(math_characters);

/** A character that the pages' font lacks would be drawn in any other font, or as an empty box. */
function check_characters(markup: string): void {
  const text = markup.replace(/<mtext[^>]*>.*?<\/mtext>/gs, "").replace(/<[^>]*>/g, "").replace(/&(?:lt|gt|amp);/g, "");
  const missing = [...text].find((character) => !in_font.has(character));
  if (!missing) return;
  const code = missing.codePointAt(0)!.toString(16).toUpperCase().padStart(4, "0");
  throw new MathError(`TeX: the font of pages has no '${missing}' (U+${code}); web/build/math_characters.mjs lists its characters`, 0);
}

/** Throws MathError. */
export function math_to_html(tex: string, display: boolean): string {
  const markup = markup_of(tex, display);
  check_characters(markup);
  return markup;
}

function markup_of(tex: string, display: boolean): string {
  try {
    return temml.renderToString(tex, {
      displayMode: display,
      throwOnError: true,
      strict: false,
      trust: true,  // of \data, by which symbols are known
      macros: symbol_macros(),  // a fresh list: temml writes \def and \newcommand into it
    });
  } catch (error) {
    const { message, position } = error as Error & { position?: number };
    const unknown = /Unsupported function name: \\([A-Za-z]+)/.exec(message);
    if (unknown) {
      // temml tells positions after the expansion of macros
      const at = tex.search(new RegExp(`\\\\${unknown[1]}(?![A-Za-z])`));
      throw new MathError(`TeX: unknown command '\\${unknown[1]}'${nearest_macro(unknown[1])}`, Math.max(0, at));
    }
    const first = message.trim().split("\n")[0].replace(/ at (position \d+|end of input):.*$/, "");
    throw new MathError(`TeX: ${first}`, Math.min(position ?? 0, tex.length));
  }
}

function nearest_macro(name: string): string {
  const hint = suggestion(name, symbols.map((s) => s.macro));
  return hint.startsWith(" (nearest") ? hint.replace("'", "'\\") : "";
}
