// The language of the player: the page's, where its author has named one that the player knows, otherwise the reader's.
export const languages = ["en", "de", "es", "fr"] as const;
export type Language = (typeof languages)[number];

/** The first code that names a known language: "de-AT" is "de". */
export function first_known(codes: readonly string[]): Language {
  for (const code of codes) {
    const known = languages.find((each) => each === code.toLowerCase().split("-")[0]);
    if (known) return known;
  }
  return "en";
}

// Tests without a browser have no document.
const root = typeof document === "undefined" ? null : document.documentElement;
export const language: Language = root ? first_known([root.dataset.language ?? "", ...navigator.languages]) : "en";

/** Of tables by language the page's. */
export function in_force<T>(tables: Record<Language, T>): T {
  return tables[language];
}

/** Tells screen readers the language of an element, if it is another one than the page's. */
export function in_language<T extends HTMLElement>(element: T): T {
  if (root && root.lang.split("-")[0] !== language) element.lang = language;
  return element;
}

export type Values = Record<string, string | number>;

/** The text with values in its places. Of forms for one and for several, "one|several", the one for `count`. */
export function filled(text: string, values: Values = {}): string {
  const [one, several = one] = text.split("|");
  const form = values.count === 1 || (values.count === 0 && language === "fr") ? one : several;
  return form.replace(/\{(\w+)\}/g, (_, name: string) => String(values[name]));
}
