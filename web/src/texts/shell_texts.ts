// Texts that the program and the compiler of lessons write into the page, in English: replaced by those of the language.
import * as de from "./de.ts";
import * as en from "./en.ts";
import * as es from "./es.ts";
import * as fr from "./fr.ts";
import { filled, in_force, in_language, language, type Values } from "./language.ts";

type ShellKey = keyof typeof en.shell;

const shell = in_force<Record<ShellKey, string>>({ en: en.shell, de: de.shell, es: es.shell, fr: fr.shell });

/** Elements whose whole text it is. */
const texts: [string, ShellKey][] = [
  ["a.skip", "skip"], [".colophon p", "colophon"],
  [".prev > .label", "previous_page"], [".up > .label", "contents"], [".next > .label", "next_page"],
  [".contents > h2", "contents"], [".lesson-place", "lesson_place"], [".print-answers > h2", "answers"],
  [".quiz-title", "question"], [".quiz-label", "your_answer"], [".quiz-check", "check"],
  [".quiz-hint > summary", "hint"], [".quiz-answer > summary", "answer"],
];
const labels: [string, ShellKey][] = [
  ["nav.pages.top", "pages_top"], ["nav.pages.bottom", "pages_bottom"], ["nav.contents", "contents"],
  ["[data-numbers]", "equation_with_numbers"],
];

/** Values that stand in the English text. */
function values_in(key: ShellKey, text: string): Values {
  const names = [...en.shell[key].matchAll(/\{(\w+)\}/g)].map((match) => match[1]);
  if (key === "colophon") return { generator: document.querySelector<HTMLMetaElement>('meta[name="generator"]')?.content ?? "" };
  const numbers = text.match(/\d+/g) ?? [];
  return Object.fromEntries(names.map((name, index) => [name, numbers[index] ?? ""]));
}

export function translate_shell(): void {
  if (language === "en") return;
  for (const [selector, key] of texts)
    for (const element of document.querySelectorAll<HTMLElement>(selector))
      in_language(element).textContent = filled(shell[key], values_in(key, element.textContent!));
  for (const [selector, key] of labels)
    for (const element of document.querySelectorAll(selector)) element.setAttribute("aria-label", shell[key]);
}
