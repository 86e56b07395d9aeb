// Looks of overlays: those of the program, with its colors as numbers.
import data from "../../../src/overlay/overlay_style.json";
import type { ArrowQuantity, Vec3 } from "../data/clip.ts";
import { bytes, from_text } from "./color.ts";
import type { MarkerForm } from "./screen_glsl.ts";

type Converted<T> = { [Key in keyof T]: Key extends `${string}_color` ? Vec3 : Key extends `${string}_colors` ? Vec3[] : T[Key] };
const converted = (value: unknown) => (typeof value === "string" && value.startsWith("#") ? from_text(value) : value);
export const style = Object.fromEntries(Object.entries(data).map(([key, value]) =>
  [key, Array.isArray(value) ? value.map(converted) : converted(value)])) as Converted<typeof data>;

export const contact_colors: Vec3[] = data.contact_states.map(({ color }) => from_text(color));
export const contact_forms = data.contact_features.map(({ marker }) => marker as MarkerForm);

/** Drawn with two heads. */
export const axial = new Set(data.arrows.filter((arrow) => arrow.axial).map((arrow) => arrow.name as ArrowQuantity));

/** All numbers as constants, and the colors of outlines. */
export const style_glsl = Object.entries(style).map(([key, value]) => (
  typeof value === "number" ? `const float ${key} = ${value.toFixed(4)};\n` :
  /^(halo|center_dark)_color$/.test(key) ? `const vec3 ${key} = vec3(${(value as Vec3).map((part) => part.toFixed(6))});\n` : "")).join("");

/** Of compared runs: the colors of Okabe and Ito, told apart with color blindness. */
export const run_colors: Vec3[] = [
  bytes(230, 159, 0), bytes(86, 180, 233), bytes(0, 158, 115), bytes(204, 121, 167), bytes(213, 94, 0), bytes(0, 114, 178),
  bytes(240, 228, 66),
];
