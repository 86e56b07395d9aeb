// Backgrounds of light and of dark pages. Bodies look the same on both.
import overlay_style from "../../../src/overlay/overlay_style.json";
import type { Vec3 } from "../data/clip.ts";

export type Theme = "light" | "dark";

const { center_color: label_color, label_background_color: dark_gray } = overlay_style;

interface Backdrop {
  /** Factors on the light of the sky, linear, and of planes. */
  sky: Vec3;
  ground: number;
  /** CSS, of labels. */
  label_color: string;
  label_background: string;
}

const light: Backdrop = { sky: [1, 1, 1], ground: 1, label_color, label_background: `${dark_gray}a8` };
const dark: Backdrop = { ...light, sky: [0.0375, 0.041, 0.047], ground: 0.16, label_background: `${dark_gray}b8` };

export const theme_of = (theme: Theme): Backdrop => (theme === "dark" ? dark : light);
