// Looks of overlays, as in src/overlay/overlay_builder.cpp: widths in units of a picture 720 pixels high.
import { contact_states, features } from "../data/clip.ts";
import type { Vec3 } from "../data/clip.ts";
import { bytes } from "./color.ts";
import type { MarkerForm } from "./screen_glsl.ts";

export const arrow_width = 3.2;
export const friction_width = 2;
export const normal_width = 1.8;
export const axis_width = 2.4;
export const trail_width = 2.2;
export const box_width = 1.4;
export const contact_radius = 4.2;
export const center_radius = 6.5;
/** Radii of the body. */
export const normal_length = 0.35;
export const axis_length = 1.2;
/** Of the normal force: a smaller friction force is not drawn apart. */
export const least_friction = 0.02;

export const ghost_opacity = 0.34;
export const tint_opacity = 0.5;
export const sleep_opacity = 0.32;

export const friction_color = bytes(255, 122, 60);
export const normal_color = bytes(236, 240, 246);
export const load_color = bytes(70, 120, 255);
/** Of anchors and axes of joints, of limits, and of limits that are met. */
export const joint_color = bytes(255, 226, 120);
export const limit_color = bytes(120, 200, 190);
export const at_limit_color = bytes(255, 84, 84);
export const joint_width = 2;
export const limit_width = 2.4;
export const anchor_radius = 5;
export const asleep_color = bytes(120, 140, 255);
export const box_color = bytes(255, 222, 90);
export const center_color = bytes(250, 250, 250);
export const axis_colors: Vec3[] = [bytes(255, 84, 84), bytes(72, 214, 96), bytes(84, 140, 255)];
/** Neighbors in this order differ for people with color blindness as well. */
export const island_colors: Vec3[] = [
  bytes(0, 158, 255), bytes(255, 150, 0), bytes(0, 190, 120), bytes(240, 110, 190), bytes(120, 220, 255), bytes(250, 220, 70),
  bytes(235, 80, 60), bytes(160, 130, 255),
];
/** Of compared runs: the colors of Okabe and Ito, told apart with color blindness. */
export const run_colors: Vec3[] = [
  bytes(230, 159, 0), bytes(86, 180, 233), bytes(0, 158, 115), bytes(204, 121, 167), bytes(213, 94, 0), bytes(0, 114, 178),
  bytes(240, 228, 66),
];

export function contact_color(state: number): Vec3 {
  switch (contact_states[state]) {
    case "stick":
      return bytes(72, 214, 96);
    case "slip":
      return bytes(255, 122, 60);
    case "asleep":
      return asleep_color;
    default:
      return bytes(236, 240, 246);
  }
}

export function contact_form(feature: number): MarkerForm {
  switch (features[feature]) {
    case "edge-edge":
      return "diamond";
    case "face-face":
      return "square";
    case "sphere":
      return "ring";
    case "mesh":
      return "cross";
    default:
      return "disc";
  }
}
