// The texts that the clip was made from.
import type { Clip } from "../data/clip.ts";
import { h } from "../ui/dom.ts";
import { text_of } from "../texts/texts.ts";

/** Comments, tables, keys and strings of a line of TOML. */
const tokens = /(#.*$)|("(?:\\.|[^"\\])*"|'[^']*')|(^\s*\[\[?[^\]]*\]\]?)|(^\s*[A-Za-z_][\w.-]*(?=\s*=))/gm;
const kinds = ["comment", "string", "table", "key"];

function colored(text: string): (Node | string)[] {
  const parts: (Node | string)[] = [];
  let end = 0;
  for (const match of text.matchAll(tokens)) {
    parts.push(text.slice(end, match.index));
    const kind = kinds[match.slice(1).findIndex((group) => group !== undefined)];
    parts.push(h("span", { class: `tp-code-${kind}` }, match[0]));
    end = match.index + match[0].length;
  }
  parts.push(text.slice(end));
  return parts;
}

export function build_source(clip: Clip): HTMLElement {
  return h("div", { class: "tp-source" }, ...clip.sources.map((source) => h("figure", {},
    h("figcaption", {}, source.name, " ",
      h("a", { class: "tp-link", download: source.name.replace(/^.*\//, ""), href: `data:text/plain;charset=utf-8,${encodeURIComponent(source.text)}` }, text_of("save"))),
    h("pre", { tabindex: 0, role: "group", "aria-label": text_of("source_of", { name: source.name }) }, h("code", {}, ...colored(source.text))))));
}
