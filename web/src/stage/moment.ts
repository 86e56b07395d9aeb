// What a stage shows.
import type { OverlayName } from "../data/clip.ts";
import type { SymbolRequest } from "./symbols.ts";

export interface Moment {
  /** s. */
  time: number;
  /** At an impact: velocities just before it. */
  before: boolean;
  shown: Set<OverlayName>;
  symbol: SymbolRequest | null;
  /** Index of the chosen body, which has an outline. */
  selected: number | null;
}
