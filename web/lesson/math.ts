// TeX to MathML, when the lesson is built: the page carries no TeX and no font of many weights.
import temml from "temml";
import { math_characters } from "../build/math_characters.mjs";
import { forbidden_in } from "./math_tree.ts";
import { index_of_word, suggestion } from "./problems.ts";
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

const largest_size = 100;  // em: a length of TeX beyond any page
const symbol_names = new Set(symbols.map((s) => s.name));

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

/** Of temml's commands for HTML only the mark of our symbols. */
function is_symbol({ command, attributes }: { command: string; attributes?: Record<string, string> }): boolean {
  return command === "\\data" && Object.entries(attributes ?? {}).every(([name, value]) => name === "data-symbol" && symbol_names.has(value));
}

function markup_of(tex: string, display: boolean): string {
  try {
    const tree = temml.__renderToMathMLTree(tex, {
      displayMode: display,
      throwOnError: true,
      strict: false,
      trust: is_symbol,
      maxSize: [largest_size, largest_size],
      macros: symbol_macros(),
    });
    const forbidden = forbidden_in(tree);
    if (!forbidden) return tree.toMarkup();
    throw new MathError(`TeX: ${forbidden} cannot stand in a page`, 0);
  } catch (error) {
    throw error instanceof MathError ? error : mistake_of(error as Error & { position?: number }, tex);
  }
}

function mistake_of(error: Error & { position?: number }, tex: string): MathError {
  if (error instanceof RangeError) return new MathError("TeX: braces or macros are nested too deeply", 0);
  // Faults of temml itself have no position, and messages for its authors.
  if (!(error instanceof temml.ParseError)) return new MathError("TeX: this cannot be typeset", 0);
  const { message, position } = error;
  const unknown = /Unsupported function name: \\([A-Za-z]+)/.exec(message);
  if (unknown) {
    // temml tells positions after the expansion of macros
    return new MathError(`TeX: unknown command '\\${unknown[1]}'${nearest_macro(unknown[1])}`, Math.max(0, index_of_word(tex, `\\${unknown[1]}`, 0, /[A-Za-z]/)));
  }
  const untrusted = /Function "\\+([A-Za-z]+)" is not trusted/.exec(message);
  if (untrusted) return new MathError(`TeX: \\${untrusted[1]} cannot stand in a page`, Math.max(0, tex.indexOf(`\\${untrusted[1]}`)));
  const first = message.trim().split("\n")[0].replace(/ at (position \d+|end of input):.*$/, "");
  const words = /undefined|\[object/.test(first) ? "a command lacks what must follow it" : first;  // temml shows what it found instead
  return new MathError(`TeX: ${words}`, Math.min(position ?? 0, tex.length));
}

function nearest_macro(name: string): string {
  const hint = suggestion(name, symbols.map((s) => s.macro));
  return hint.startsWith(" (nearest") ? hint.replace("'", "'\\") : "";
}
