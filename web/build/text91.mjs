// Bytes as text of 91 printable characters, 13 or 14 bits in two of them (basE91): a twelfth shorter than base64. The
// characters are those that neither HTML nor the template of pages reads as something else. web/src/live/text91.ts reads it.
export const characters = Array.from({ length: 94 }, (_, i) => String.fromCharCode(33 + i)).filter((each) => !"<[{".includes(each)).join("");

export function encode91(bytes) {
  const parts = [];
  let bits = 0, count = 0;
  const put = (value) => { parts.push(characters[value % 91], characters[Math.floor(value / 91)]); };
  for (const byte of bytes) {
    bits |= byte << count;
    count += 8;
    if (count <= 13) continue;
    const thirteen = bits & 8191, wide = thirteen <= 88;   // 91 * 91 = 8192 + 89 values
    put(wide ? bits & 16383 : thirteen);
    bits >>= wide ? 14 : 13;
    count -= wide ? 14 : 13;
  }
  if (count > 0) {
    parts.push(characters[bits % 91]);
    if (count > 7 || bits > 90) parts.push(characters[Math.floor(bits / 91)]);
  }
  return parts.join("");
}
