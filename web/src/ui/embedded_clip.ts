// The data of a clip: in an element of the page, as base64.
import type { Clip } from "../data/clip.ts";

export async function read_embedded_clip(_id: string): Promise<Clip> {
  throw new Error("not yet");
}
