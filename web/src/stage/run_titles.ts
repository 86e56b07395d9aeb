// The names of compared runs, over the picture.
import type { Clip, Vec3 } from "../data/clip.ts";
import type { Labels, ViewRectangle } from "./labels.ts";
import { run_color } from "./run_view.ts";
import { theme_of, type Theme } from "./theme.ts";

export type StageMode = "single" | "ghost" | "side-by-side";

export interface RunRectangle extends ViewRectangle {
  /** Index of the run that it shows. */
  run: number;
}

/** Between two lines, CSS pixels. */
const line = 26;
const css = (color: Vec3) => `rgb(${color.map((channel) => Math.round(255 * channel)).join(" ")})`;

export function add_run_titles(labels: Labels, clip: Clip, runs: number[], views: RunRectangle[], mode: StageMode, theme: Theme): void {
  if (mode === "side-by-side") for (const view of views) labels.add_title(clip.runs[view.run].label, view, null);
  if (mode !== "ghost" || runs.length < 2) return;
  runs.forEach((run, i) => {
    const row = { ...views[0], top: views[0].top + line * i };
    labels.add_title(clip.runs[run].label, row, i === 0 ? theme_of(theme).label_color : css(run_color(run)));
  });
}
