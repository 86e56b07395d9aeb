// Bytes from text of 91 characters, as web/build/text91.mjs writes it.

/** By the code of the character; 255: no such character. */
const values = new Uint8Array(128).fill(255);
for (let code = 33, next = 0; code < 127; ++code) if (!"<[{".includes(String.fromCharCode(code))) values[code] = next++;

/** Null where a character is none of the 91. */
export function decode91(text: string): Uint8Array<ArrayBuffer> | null {
  const bytes = new Uint8Array(Math.ceil(text.length * 7 / 8));
  let size = 0, first = -1, bits = 0, count = 0;
  for (let i = 0; i < text.length; ++i) {
    const value = values[text.charCodeAt(i)] ?? 255;
    if (value === 255) return null;
    if (first < 0) {
      first = value;
      continue;
    }
    const pair = first + 91 * value;
    first = -1;
    bits |= pair << count;
    count += (pair & 8191) > 88 ? 13 : 14;
    for (; count > 7; count -= 8, bits >>= 8) bytes[size++] = bits & 255;
  }
  if (first >= 0) bytes[size++] = (bits | first << count) & 255;
  return bytes.slice(0, size);
}
