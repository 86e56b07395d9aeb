// Earlier poses of bodies, at every so many frames.
import type { BodyState, Run } from "../data/clip.ts";
import { angle_between, distance } from "./math.ts";
import type { OverlayGhost } from "./overlay_frame.ts";
import { style } from "./overlay_style.ts";

type Place = Pick<BodyState, "origin" | "rotation">;

export interface GhostRow extends OverlayGhost {
  /** s. */
  time: number;
  near(state: Place): boolean;
}

export function ghosts_until(run: Run, radii: number[], shown: Set<number>): GhostRow[] {
  const rows: GhostRow[] = [];
  const last = new Map<number, GhostRow>();
  for (let frame = 0; frame < run.frames; frame += run.overlays.ghost_every)
    for (const body of shown) {
      if (rows.length >= style.most_ghosts) return rows;
      const radius = radii[body];
      const time = frame / run.fps;
      if (!run.motion.shows(body, time)) continue;
      const { origin, rotation } = run.motion.state(body, time);
      if (radius === 0 || last.get(body)?.near({ origin, rotation })) continue;
      const near = (other: Place) =>
        distance(other.origin, origin) < style.rested * radius && angle_between(other.rotation, rotation) < style.rested;
      const row: GhostRow = { body, origin: [...origin], rotation: [...rotation], time, near };
      rows.push(row);
      last.set(body, row);
    }
  return rows;
}
