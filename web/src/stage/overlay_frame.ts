// What overlays draw at one moment, without pixels: positions in the world frame, m; widths in units of the screen.
import type { OverlayName, Quat, Vec3 } from "../data/clip.ts";
import type { MarkerForm } from "./screen_glsl.ts";

export interface OverlayArrow {
  /** The overlay that it belongs to; "highlight": of a symbol of a lesson. */
  overlay: OverlayName | "highlight";
  from: Vec3;
  to: Vec3;
  /** sRGB. */
  color: Vec3;
  opacity: number;
  width: number;
  double_head: boolean;
  /** Surfaces nearer by less do not hide it, m; Infinity: none hides it. */
  allowance: number;
}

export interface OverlayLine {
  points: Vec3[];
  color: Vec3;
  opacity: number;
  width: number;
  /** As of an arrow. */
  allowance: number;
}

export interface OverlayMarker {
  overlay: OverlayName | "highlight";
  at: Vec3;
  color: Vec3;
  form: MarkerForm;
  radius: number;
  /** As of an arrow. */
  allowance: number;
}

export interface OverlayLabel {
  at: Vec3;
  text: string;
  /** CSS; null: that of the theme. */
  color: string | null;
}

export interface OverlayGhost {
  body: number;
  origin: Vec3;
  rotation: Quat;
}

export interface OverlayFrame {
  arrows: OverlayArrow[];
  lines: OverlayLine[];
  markers: OverlayMarker[];
  labels: OverlayLabel[];
  ghosts: OverlayGhost[];
  /** By body: a color over the body, and its share. */
  tints: Map<number, { color: Vec3; share: number }>;
}

export const empty_frame = (): OverlayFrame => ({ arrows: [], lines: [], markers: [], labels: [], ghosts: [], tints: new Map() });
