// The texts of the player in its language.
import * as de from "./de.ts";
import * as en from "./en.ts";
import * as es from "./es.ts";
import * as fr from "./fr.ts";
import { filled, in_force, type Values } from "./language.ts";

export type TextKey = keyof typeof en.player;

// "Pure": the compiler of lessons, which shows no text, leaves the tables out.
const player = /* @__PURE__ */ in_force<Record<TextKey, string>>({ en: en.player, de: de.player, es: es.player, fr: fr.player });
const terms = /* @__PURE__ */ in_force<Record<string, string> | null>({ en: null, de: de.terms, es: es.terms, fr: fr.terms });

export function text_of(key: TextKey, values?: Values): string {
  return filled(player[key], values);
}

/** With elements in the places of the text. */
export function text_around(key: TextKey, elements: Record<string, Node>): (Node | string)[] {
  return player[key].split(/\{(\w+)\}/).map((part, index) => (index % 2 === 1 ? elements[part] : part));
}

/** A term of the program's data; "velocity x" by its "velocity". Unknown ones stay. */
export function term_of(name: string): string {
  if (!terms) return name;
  const [, stem, axis] = /^(.*?)( [xyz])?$/.exec(name)!;
  return terms[name] ?? (terms[stem] ?? stem) + (axis ?? "");
}
