// Text for HTML.

export function escape_html(text: string): string {
  return text.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]!);
}

/** An attribute with JSON. */
export function json_attribute(value: unknown): string {
  return escape_html(JSON.stringify(value));
}

/** A number in words of a reader: 1e-9 as 10<sup>-9</sup> would be, others as they are. */
export function number_html(value: number): string {
  const [mantissa, exponent] = String(value).split("e");
  const sign = (text: string) => text.replace("-", "\u2212");
  if (exponent === undefined) return sign(mantissa);
  const power = `10<sup>${sign(exponent.replace("+", ""))}</sup>`;
  return mantissa === "1" ? power : `${sign(mantissa)} \u00d7 ${power}`;
}

/** A name for addresses. */
export function slug(text: string): string {
  return text
    .toLowerCase()
    .replace(/\$[^$]*\$/g, (math) => math.replace(/[^A-Za-z0-9]+/g, " "))
    .replace(/[^\p{L}\p{N}]+/gu, "-")
    .replace(/^-+|-+$/g, "") || "section";
}
