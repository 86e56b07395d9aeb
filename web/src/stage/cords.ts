// Cords from bodies to fixed points or to other bodies, as thin rods.
import type { Cord, Motion, Pose, Quat, Vec3 } from "../data/clip.ts";
import type { Part } from "./body_parts.ts";
import type { BodySet } from "./body_set.ts";
import { from_text, to_linear } from "./color.ts";
import { add, length, rotate, scaled, subtract } from "./math.ts";

/** Of the viewing distance: a cord thinner than a pixel breaks up into dots. */
const thinnest = 0.0009;
const roughness = 0.7;

export function add_cords(cords: Cord[], motion: Motion, time: number, viewing_distance: number, to: BodySet): void {
  const pose: Pose = { position: [0, 0, 0], origin: [0, 0, 0], rotation: [1, 0, 0, 0] };
  const place = (body: number, point: Vec3): Vec3 => {
    motion.pose(body, time, pose);
    return add(pose.origin, rotate(pose.rotation, point));
  };
  for (const { body, point, anchor, anchor_body, radius, color } of cords) {
    const end = place(body, point);
    const start = anchor_body === undefined ? anchor : place(anchor_body, anchor);
    const way = subtract(end, start);
    const thick = Math.max(radius, thinnest * viewing_distance);
    const rod: Part = {
      geometry: "rod", position: [0, 0, 0], rotation: [1, 0, 0, 0], size: [thick, Math.max(length(way) / 2, 1e-6), thick],
      bevel: 0, color: to_linear(from_text(color)), roughness, metallic: 0, pattern: 0, pattern_cell: radius,
    };
    to.add_part(rod, scaled(add(start, end), 0.5), turn_of_y(way));
  }
}

// The shortest turn that takes the y axis to a direction.
function turn_of_y(way: Vec3): Quat {
  const size = length(way);
  if (!(size > 0)) return [1, 0, 0, 0];
  const [x, y, z] = scaled(way, 1 / size);
  if (y < -1 + 1e-12) return [0, 1, 0, 0];
  const w = Math.sqrt((1 + y) / 2);
  return [w, z / (2 * w), 0, -x / (2 * w)];
}
