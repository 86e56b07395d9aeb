// Colors as three numbers from 0 to 1.
import type { ColorText, Vec3 } from "../data/clip.ts";

/** sRGB values. */
export function from_text(text: ColorText): Vec3 {
  const value = parseInt(text.slice(1, 7), 16);
  return [(value >> 16) / 255, ((value >> 8) & 255) / 255, (value & 255) / 255];
}

export const bytes = (red: number, green: number, blue: number): Vec3 => [red / 255, green / 255, blue / 255];

const channel_to_linear = (c: number) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);

export const to_linear = ([red, green, blue]: Vec3): Vec3 => [
  channel_to_linear(red),
  channel_to_linear(green),
  channel_to_linear(blue),
];

export const mixed = (a: Vec3, b: Vec3, share: number): Vec3 => [
  a[0] + share * (b[0] - a[0]),
  a[1] + share * (b[1] - a[1]),
  a[2] + share * (b[2] - a[2]),
];
