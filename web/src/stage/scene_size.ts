// Distances that are chosen once for a clip: where fog begins, the cell of the ground's pattern, the reach of shadows.
import drawing_style from "../../../src/render/shapes/drawing_style.json";
import type { Pose, Run, Vec3 } from "../data/clip.ts";
import { radius_of } from "./body_parts.ts";
import { clamp, distance, length, normalized, scaled } from "./math.ts";

/** As in src/render/scene/fog_distance.cpp. */
const { half_fog, about_there, large_part, beyond_large, ground_cells } = drawing_style;
/** Times of the clip that shadows are fitted to. */
const samples = 24;
/** Bodies farther from the target, in viewing distances, get no shadows: the map would be too coarse for all others. */
const shadow_reach = 3;

export interface SceneSize {
  /** From the eye to what is looked at, m. */
  viewing_distance: number;
  /** At which fog is half of the light, m. */
  fog_distance: number;
  /** Of the ground's pattern, m. */
  pattern_cell: number;
  /** A ball around the bodies, at all times of the clip. */
  shadow_center: Vec3;
  shadow_radius: number;
  to_light: Vec3;
  /** Of each body about its origin, m; 0 of planes. */
  radii: number[];
}

export function measure(run: Run): SceneSize {
  const { scene, motion } = run;
  const radii = scene.bodies.map((body) => radius_of(scene, body.shape));
  const pose: Pose = { position: [0, 0, 0], origin: [0, 0, 0], rotation: [1, 0, 0, 0] };
  const drawn = scene.bodies.map((_, i) => i).filter((i) => scene.bodies[i].visible && radii[i] > 0);
  const { eye, target, vertical_fov } = scene.camera(0);
  const away = drawn.map((i) => distance(motion.pose(i, 0, pose).origin, eye));
  let viewing_distance = distance(eye, target) || 1;
  if (away.length > 0) {
    const median = [...away].sort((a, b) => a - b)[(away.length - 1) >> 1];
    viewing_distance = clamp(viewing_distance, median / about_there, median * about_there);
  }
  let fog_distance = half_fog * viewing_distance;
  const least_slope = large_part * 2 * Math.tan((vertical_fov * Math.PI) / 360);
  drawn.forEach((i, k) => {
    if (2 * radii[i] >= least_slope * away[k]) fog_distance = Math.max(fog_distance, beyond_large * (away[k] - radii[i]));
  });
  const low: Vec3 = [Infinity, Infinity, Infinity];
  const high: Vec3 = [-Infinity, -Infinity, -Infinity];
  for (let k = 0; k <= samples; ++k)
    for (const i of drawn) {
      if (k > 0 && motion.kind(i) === "still") continue;
      const { origin } = motion.pose(i, (run.duration * k) / samples, pose);
      if (distance(origin, target) > shadow_reach * viewing_distance) continue;
      const radius = Math.min(radii[i], viewing_distance);
      for (let axis = 0; axis < 3; ++axis) {
        low[axis] = Math.min(low[axis], origin[axis] - radius);
        high[axis] = Math.max(high[axis], origin[axis] + radius);
      }
    }
  const found = low[0] <= high[0];
  return {
    viewing_distance,
    fog_distance,
    pattern_cell: rounded(viewing_distance / ground_cells),
    shadow_center: found ? [0, 1, 2].map((i) => (low[i] + high[i]) / 2) as Vec3 : target,
    shadow_radius: found ? length([0, 1, 2].map((i) => (high[i] - low[i]) / 2) as Vec3) : viewing_distance,
    to_light: normalized(scaled(scene.light.direction, -1)),
    radii,
  };
}

/** 1, 2 or 5 times a power of ten. */
function rounded(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  const digits = value / power;
  return power * (digits < Math.SQRT2 ? 1 : digits < Math.sqrt(10) ? 2 : digits < Math.sqrt(50) ? 5 : 10);
}
