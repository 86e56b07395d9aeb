// Axis-aligned boxes around bodies, in the world.
import type { Quat, Scene, Shape, Vec3 } from "../data/clip.ts";
import type { Box } from "./body_parts.ts";
import { add, multiply, rotate, rotation_matrix } from "./math.ts";

/** Null of planes, which have no end. */
export function world_box(scene: Scene, shape: Shape, origin: Vec3, rotation: Quat): Box | null {
  const box: Box = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
  add_shape(scene, shape, origin, rotation, box);
  return box.low[0] <= box.high[0] ? box : null;
}

function include(box: Box, center: Vec3, reach: Vec3): void {
  for (let i = 0; i < 3; ++i) {
    box.low[i] = Math.min(box.low[i], center[i] - reach[i]);
    box.high[i] = Math.max(box.high[i], center[i] + reach[i]);
  }
}

function add_shape(scene: Scene, shape: Shape, origin: Vec3, rotation: Quat, box: Box): void {
  const m = rotation_matrix(rotation);
  switch (shape.type) {
    case "plane":
      return;
    case "sphere":
      return include(box, origin, [shape.radius, shape.radius, shape.radius]);
    case "box": {
      const row = (i: number) =>
        (Math.abs(m[3 * i]) * shape.size[0] + Math.abs(m[3 * i + 1]) * shape.size[1] + Math.abs(m[3 * i + 2]) * shape.size[2]) / 2;
      return include(box, origin, [row(0), row(1), row(2)]);
    }
    case "mesh": {
      const { positions } = scene.meshes[shape.mesh];
      for (let i = 0; i + 2 < positions.length; i += 3) {
        const [x, y, z] = [positions[i], positions[i + 1], positions[i + 2]];
        const at = (k: number) => origin[k] + m[3 * k] * x + m[3 * k + 1] * y + m[3 * k + 2] * z;
        include(box, [at(0), at(1), at(2)], [0, 0, 0]);
      }
      return;
    }
    case "compound":
      for (const part of shape.parts)
        add_shape(scene, part.shape, add(origin, rotate(rotation, part.position)), multiply(rotation, part.rotation), box);
  }
}
