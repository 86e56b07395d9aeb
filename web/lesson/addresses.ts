// Addresses of links and pictures.

const open_schemes = ["http:", "https:", "mailto:"];

/** The text of an address without percent escapes; null: one of them is malformed. */
export function decode_address(address: string): string | null {
  try {
    return decodeURIComponent(address);
  } catch {
    return null;
  }
}

/** What is wrong with the address of a link; empty: nothing. */
export function link_mistake(address: string): string {
  if (decode_address(address) === null)
    return `the address '${address}' has a malformed percent escape: the sign itself is written %25`;
  const scheme = /^[a-z][a-z0-9+.-]*:/i.exec(address)?.[0].toLowerCase();
  if (scheme === undefined ? !address.startsWith("//") : open_schemes.includes(scheme)) return "";
  return `a link leads to ${open_schemes.join(", ")} or to a file or section of the lessons (given '${address}')`;
}
