// The HTML that lessons may have, whatever is written in them. Everything else is refused.
import { parseFragment, type DefaultTreeAdapterMap } from "parse5";
import { math_attributes, math_elements } from "../lesson/math_tree.ts";

type Node = DefaultTreeAdapterMap["childNode"];
type Element = DefaultTreeAdapterMap["element"];
type Check = RegExp;

const name = /^[\p{L}\p{N}_-]+$/u;
const any_text = /^[^\u0000-\u0008\u000b-\u001f\u007f]*$/;
const number = /^-?\d+$/;

/** Attributes of every element. */
const common: Record<string, Check> = {
  id: name,
  class: /^[-\w+]+( [-\w+]+)*$/,
  role: /^(group|status)$/,
  tabindex: /^0$/,
  "aria-label": any_text,
  "aria-labelledby": name,
  "aria-describedby": name,
  "aria-hidden": /^true$/,
  "aria-live": /^polite$/,
};
const nothing: Record<string, Check> = {};
const cell = { style: /^text-align:(left|right|center)$/, scope: /^(row|col)$/ };

/** Attributes of their own by element. An address of a link has an open scheme, or none: then no colon stands before its first slash. */
const elements: Record<string, Record<string, Check>> = {
  a: { href: /^(https?:|mailto:|(?!\/\/)[^:/?#]*([/?#]|$))/i, title: any_text },
  img: { src: /^(data:image\/(png|jpeg|svg\+xml|webp|gif);base64,[A-Za-z0-9+/=]*)$/, alt: any_text, title: any_text },
  ol: { start: number },
  li: { value: number },
  th: cell,
  td: cell,
  div: { "data-numbers": any_text },
  section: { "data-quiz": any_text },
  form: { novalidate: /^$/ },
  label: { for: name },
  input: { inputmode: /^decimal$/, autocomplete: /^off$/, type: /^radio$/, name: /^quiz-\d+$/, value: number },
  p: { hidden: /^$/ },
  button: { type: /^submit$/ },
  output: { for: name },
  details: { open: /^$/ },
};
for (const plain of ("article aside blockquote br caption code em fieldset figure figcaption h1 h2 h3 h4 h5 h6 header hr nav pre s span strong sub sup summary " +
  "table tbody thead tr ul").split(" ")) elements[plain] = nothing;

/** Places that the program fills in. */
const place = /^(stage:[a-z][a-z0-9-]*|convergence:\d+|measured:\d+:\d+|deviation:\d+:\d+|picture:\d+)$/;
const style = /^([a-z-]+: ?[-\w .,#%'+]+;?|[a-z-]+:scaleX\(-1\);)*$/;
const voids = new Set(["br", "hr", "img", "input"]);

function check_element(element: Element, faults: string[]): void {
  const math = element.namespaceURI === "http://www.w3.org/1998/Math/MathML";
  const own = math ? nothing : elements[element.tagName];
  if (math ? !math_elements.has(element.tagName) : own === undefined) {
    faults.push(`<${element.tagName}>`);
    return;
  }
  for (const { name: attribute, value } of element.attrs) {
    const known = own[attribute] ?? (math ? undefined : common[attribute]);
    const right = attribute === "style" && (math || element.tagName === "span") ? style.test(value)
      : math && (math_attributes.has(attribute) || attribute === "class") ? any_text.test(value)
      : known?.test(value) ?? false;
    if (!right) faults.push(`<${element.tagName} ${attribute}="${value.slice(0, 80)}">`);
  }
}

/** Elements in their order with their depths: as the parser understands the HTML. */
function understood(nodes: Node[], depth: number, list: string[], faults: string[], ids: Set<string>): void {
  for (const node of nodes) {
    if (node.nodeName === "#comment" && "data" in node && !place.test(node.data)) faults.push(`<!--${node.data}-->`);
    if (node.nodeName === "#documentType") faults.push("a doctype");
    if (!("tagName" in node)) continue;
    check_element(node, faults);
    const id = node.attrs.find((attribute) => attribute.name === "id")?.value;
    if (id !== undefined && ids.has(id)) faults.push(`the id ${id} twice`);
    if (id !== undefined) ids.add(id);
    list.push(`${node.tagName}@${depth}`);
    understood(node.childNodes, depth + 1, list, faults, ids);
  }
}

/** The same as written: every "<" is a tag, and every tag is closed in its turn. */
function written(html: string, faults: string[]): string[] {
  const list: string[] = [];
  const open: string[] = [];
  for (const [, close, tag] of html.replace(/<!--[^>]*-->/g, "").matchAll(/<(\/?)([^\s>]*)[^>]*>/g)) {
    if (close) {
      if (open.pop() !== tag) faults.push(`</${tag}> out of turn`);
      continue;
    }
    list.push(`${tag}@${open.length}`);
    if (!voids.has(tag)) open.push(tag);
  }
  if (open.length > 0) faults.push(`<${open[open.length - 1]}> without end`);
  return list;
}

/** What is wrong with HTML that the compiler of lessons made; empty: nothing. */
export function forbidden_html(html: string): string[] {
  const faults: string[] = [];
  const errors: string[] = [];
  const tree = parseFragment(html, { onParseError: (error) => errors.push(`${error.code} in line ${error.startLine}: ${html.split("\n")[error.startLine - 1]?.slice(Math.max(0, error.startCol - 40), error.startCol + 40)}`) });
  const list: string[] = [];
  understood(tree.childNodes, 0, list, faults, new Set());
  const plan = written(html, faults);
  const at = list.findIndex((entry, i) => entry !== plan[i]);
  if (at >= 0 || list.length !== plan.length) faults.push(`<${plan[at] ?? "..."}> is understood as <${list[at] ?? "nothing"}>`);
  return [...faults, ...errors];
}
