// Pictures of pages as arrays of pixels, and their statistics.
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { inflateSync } from "node:zlib";
import type { Locator, Page } from "playwright-core";

export interface Picture {
  width: number;
  height: number;
  /** Four bytes a pixel, rows from the top. */
  data: Uint8Array;
}

/** A picture of the viewport, or of one element. */
export async function take_picture(of: Page | Locator): Promise<Picture> {
  return decode_png(await of.screenshot());
}

/** Writes a picture of the whole page for people to look at, if the environment names a folder in TUMBLE_PICTURES. */
export async function save_picture(page: Page, name: string): Promise<void> {
  const folder = process.env.TUMBLE_PICTURES;
  if (!folder) return;
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, `${name}.png`), await page.screenshot({ fullPage: true }));
}

/** Mean square deviation of gray values from their mean: 0 if the picture has one color. */
export function variance(picture: Picture): number {
  let sum = 0, squares = 0;
  const pixels = picture.width * picture.height;
  for (let i = 0; i < 4 * pixels; i += 4) {
    const gray = (picture.data[i] + picture.data[i + 1] + picture.data[i + 2]) / 3;
    sum += gray;
    squares += gray * gray;
  }
  return squares / pixels - (sum / pixels) ** 2;
}

/** The number of colors, alpha left aside. */
export function colors(picture: Picture): number {
  const found = new Set<number>();
  for (let i = 0; i < picture.data.length; i += 4) {
    found.add(picture.data[i] | (picture.data[i + 1] << 8) | (picture.data[i + 2] << 16));
  }
  return found.size;
}

/** The number of pixels with a channel that differs by more than a tolerance, 0 to 255. */
export function different_pixels(a: Picture, b: Picture, tolerance = 0): number {
  if (a.width !== b.width || a.height !== b.height) throw new Error("pictures of different sizes");
  let different = 0;
  for (let i = 0; i < a.data.length; i += 4) {
    const difference = Math.max(...[0, 1, 2].map((k) => Math.abs(a.data[i + k] - b.data[i + k])));
    if (difference > tolerance) ++different;
  }
  return different;
}

/** Only the kinds of PNG that Chromium makes: 8 bits a channel, RGB or RGBA, not interlaced. */
export function decode_png(file: Buffer): Picture {
  const width = file.readUInt32BE(16), height = file.readUInt32BE(20);
  const channels = file[25] === 6 ? 4 : 3;
  if (file[24] !== 8 || (file[25] !== 2 && file[25] !== 6) || file[28] !== 0) throw new Error("an unexpected kind of PNG");
  const parts: Buffer[] = [];
  for (let at = 8; at < file.length; at += 12 + file.readUInt32BE(at)) {
    if (file.toString("latin1", at + 4, at + 8) === "IDAT") parts.push(file.subarray(at + 8, at + 8 + file.readUInt32BE(at)));
  }
  const rows = inflateSync(Buffer.concat(parts));
  const stride = width * channels;
  for (let y = 0; y < height; ++y) unfilter_row(rows, y * (stride + 1), stride, channels, y > 0);
  const data = new Uint8Array(4 * width * height).fill(255);
  for (let y = 0, to = 0; y < height; ++y) {
    for (let x = 0, from = y * (stride + 1) + 1; x < width; ++x, to += 4, from += channels) {
      for (let k = 0; k < channels; ++k) data[to + k] = rows[from + k];
    }
  }
  return { width, height, data };
}

// A row is its filter's number and the filtered bytes.
function unfilter_row(rows: Buffer, start: number, stride: number, channels: number, has_above: boolean): void {
  const filter = rows[start];
  for (let i = 1; i <= stride; ++i) {
    const at = start + i;
    const left = i > channels ? rows[at - channels] : 0;
    const above = has_above ? rows[at - stride - 1] : 0;
    const corner = has_above && i > channels ? rows[at - stride - 1 - channels] : 0;
    rows[at] += filter === 1 ? left : filter === 2 ? above : filter === 3 ? (left + above) >> 1 : filter === 4 ? paeth(left, above, corner) : 0;
  }
}

function paeth(left: number, above: number, corner: number): number {
  const p = left + above - corner;
  const a = Math.abs(p - left), b = Math.abs(p - above), c = Math.abs(p - corner);
  return a <= b && a <= c ? left : b <= c ? above : corner;
}
