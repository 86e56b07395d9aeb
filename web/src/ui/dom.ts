// Elements in one expression.

type Child = Node | string | null | undefined | false;
type Props = Record<string, unknown>;

function apply(element: Element, props: Props, children: Child[]): void {
  for (const [name, value] of Object.entries(props)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on") && typeof value === "function") {
      element.addEventListener(name.slice(2), value as EventListener);
    } else {
      element.setAttribute(name, value === true ? "" : String(value));
    }
  }
  element.append(...children.filter((child): child is Node | string => !!child || child === ""));
}

/** `on...` functions become listeners, everything else attributes; false and null leave an attribute out. */
export function h<K extends keyof HTMLElementTagNameMap>(tag: K, props: Props = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  apply(element, props, children);
  return element;
}

export function svg(tag: string, props: Props = {}, ...children: Child[]): SVGElement {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  apply(element, props, children);
  return element;
}

export function mathml(tag: string, props: Props = {}, ...children: Child[]): MathMLElement {
  const element = document.createElementNS("http://www.w3.org/1998/Math/MathML", tag) as MathMLElement;
  apply(element, props, children);
  return element;
}

/** Replaces the text only if it differs: no layout, no repeated announcement. */
export function set_text(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

let last_id = 0;
/** Unique on the page. */
export function new_id(prefix: string): string {
  last_id += 1;
  return `${prefix}-${last_id}`;
}
