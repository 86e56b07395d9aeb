// The data of a clip: base64 in an element of the page.
import type { Clip } from "../data/clip.ts";
import { decode_clip } from "../data/decode_clip.ts";

export async function read_embedded_clip(id: string): Promise<Clip> {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no data "${id}".`);
  return decode_clip(element.textContent ?? "");
}
