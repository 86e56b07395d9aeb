// Marks of the moments of impact along an axis of time: taller for larger impulses.
import type { Run } from "../data/clip.ts";
import { moments_of } from "./moments.ts";

/** Of the smallest impulse. */
const least = 0.2;

/** Height, 0 to 1, by column of pixels: of impacts in one column the largest. `body`: only its impacts; null: all. */
export function impact_marks(run: Run, body: number | null, column_of: (time: number) => number): Map<number, number> {
  const largest = run.impacts.reduce((most, impact) => Math.max(most, impact.impulse), 0);
  const heights = new Map<number, number>();
  if (largest === 0) return heights;
  for (const moment of moments_of(run)) {
    let impulse = -1;
    for (const impact of run.impacts.slice(moment.first, moment.last + 1)) {
      if (body === null || impact.body_a === body || impact.body_b === body) impulse = Math.max(impulse, impact.impulse);
    }
    if (impulse < 0) continue;
    const column = Math.round(column_of(moment.time));
    heights.set(column, Math.max(heights.get(column) ?? 0, least + (1 - least) * Math.sqrt(impulse / largest)));
  }
  return heights;
}
