// `data-options` of a player's figure.
import type { OverlayName, Vec3 } from "../data/clip.ts";
import type { CompareMode } from "./player_state.ts";

export const panel_names = ["plots", "state", "impacts", "source", "about"] as const;
export type PanelName = (typeof panel_names)[number];

export interface PlayerOptions {
  /** s. */
  time?: number;
  run?: number;
  compare?: CompareMode;
  /** Name of the body that the camera follows. */
  follow?: string;
  /** Name of the body chosen at first. */
  body?: string;
  overlay?: OverlayName[];
  /** As `--plot`, separated by commas: "energy,body.ball.y". */
  plot?: string;
  view?: { eye: Vec3; target: Vec3 };
  panels?: PanelName[];
  /** "lesson": compact, panels to open. "page": everything. */
  layout?: "page" | "lesson";
  /** For readers that do not see the stage. */
  alt?: string;
}

export function read_options(figure: HTMLElement): PlayerOptions {
  const text = figure.dataset.options;
  return text ? (JSON.parse(text) as PlayerOptions) : {};
}
