// Backgrounds of light and of dark pages. Bodies look the same on both.
import type { Vec3 } from "../data/clip.ts";

export type Theme = "light" | "dark";

interface Backdrop {
  /** Linear. */
  horizon: Vec3;
  zenith: Vec3;
  nadir: Vec3;
  /** Factor on the glow around the sun. */
  glow: number;
  /** Factor on the light of planes. */
  ground: number;
  /** CSS, of labels. */
  label_color: string;
  label_background: string;
}

const light: Backdrop = {
  horizon: [0.8, 0.86, 0.92],
  zenith: [0.2, 0.38, 0.66],
  nadir: [0.33, 0.39, 0.48],
  glow: 1,
  ground: 1,
  label_color: "#fafafa",
  label_background: "rgba(18, 22, 30, 0.66)",
};

const dark: Backdrop = {
  horizon: [0.03, 0.037, 0.05],
  zenith: [0.009, 0.012, 0.018],
  nadir: [0.012, 0.014, 0.018],
  glow: 0.03,
  ground: 0.16,
  label_color: "#fafafa",
  label_background: "rgba(18, 22, 30, 0.72)",
};

export const theme_of = (theme: Theme): Backdrop => (theme === "dark" ? dark : light);
