// Base64 and raw deflate to bytes, by the browser's own decoders.

function bytes_of_base64(base64: string): Uint8Array<ArrayBuffer> {
  let text: string;
  try {
    text = atob(base64.trim());
  } catch {
    throw new Error("The clip's data is not base64: the page is damaged.");
  }
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

export async function inflate(base64: string): Promise<Uint8Array> {
  return inflate_bytes(bytes_of_base64(base64));
}

export async function inflate_bytes(packed: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  if (typeof DecompressionStream === "undefined") throw new Error("This browser cannot read the clip: it has no DecompressionStream.");
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  try {
    return new Uint8Array(await new Response(stream).arrayBuffer());
  } catch {
    // The browser's own message is "Failed to fetch".
    throw new Error("The clip's data is incomplete or damaged: it cannot be decompressed.");
  }
}
