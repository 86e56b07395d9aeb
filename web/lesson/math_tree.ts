// What TeX may put into a page. temml takes names of attributes, addresses and styles from the TeX, and writes some of them
// into the markup without escaping, so a tree with anything else than this is refused.

/** Nodes of temml, of which the markup is made. */
export interface MathTree {
  /** Name of the element; not in texts, fragments and elements of HTML. */
  type?: string;
  attributes?: Record<string, unknown>;
  classes?: unknown[];
  style?: Record<string, unknown>;
  children?: MathTree[];
  text?: unknown;
}

const words = (text: string) => new Set(text.split(" "));

export const math_elements = words(
  "math menclose mfrac mi mmultiscripts mn mo mover mpadded mphantom mprescripts mroot mrow mspace msqrt mstyle msub msubsup msup " +
  "mtable mtd mtext mtr munder munderover none");

/** "data-symbol" is ours. */
export const math_attributes = words(
  "accent accentunder columnalign data-symbol depth display displaystyle fence form height largeop linebreak linethickness lspace " +
  "mathbackground mathcolor mathsize mathvariant maxsize minsize movablelimits notation rowspacing rspace scriptlevel separator " +
  "stretchy style symmetric voffset width xmlns");

const members_of_fragments = words("children classes height depth maxFontSize style");
const style_name = /^[A-Za-z-]+$/;
/** Without functions, which could name an address. */
const style_value = /^(?:[-\w\s.,#%'+]*|scaleX\(-1\))$/;
const style_attribute = /^[a-z-]+: ?[a-z]+;?$/;
const class_name = /^[-\w]*$/;
const control = /[\u0000-\u0008\u000b-\u001f\u007f]/;

/** Empty, or the thing in the tree that may not stand in a page. */
export function forbidden_in(tree: MathTree): string {
  if (typeof tree.text === "string") return control.test(tree.text) ? "a control character" : "";
  const number_of_row = tree.type === undefined && String(tree.classes) === "tml-eqn" && tree.children?.length === 0;
  const fragment = tree.type === undefined && Object.keys(tree).every((name) => members_of_fragments.has(name));
  if (!number_of_row && !fragment && !math_elements.has(tree.type ?? "")) return tree.type ? `the element ${tree.type}` : "a link or picture";
  for (const [name, value] of Object.entries(tree.attributes ?? {})) {
    if (name === "id") return "\\label";
    if (!math_attributes.has(name) || (name === "style" && !style_attribute.test(String(value)))) return `the attribute ${name}`;
  }
  for (const [name, value] of Object.entries(tree.style ?? {}))
    if (!style_name.test(name) || !style_value.test(String(value))) return `the style ${name}`;
  if (!(tree.classes ?? []).every((name) => class_name.test(String(name ?? "")))) return "such a class";
  for (const child of tree.children ?? []) {
    const found = forbidden_in(child);
    if (found) return found;
  }
  return "";
}
