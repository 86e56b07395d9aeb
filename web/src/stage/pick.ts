// Which body lies under a ray. Planes do not count: the ground is not what one points at.
import type { Mesh, Pose, Quat, Run, Shape, Vec3 } from "../data/clip.ts";
import { add, cross, dot, multiply, rotate, rotate_back, subtract } from "./math.ts";

export interface Ray {
  from: Vec3;
  /** Unit. */
  way: Vec3;
}

/** Null: none. */
export function pick(run: Run, time: number, ray: Ray): number | null {
  const pose: Pose = { position: [0, 0, 0], origin: [0, 0, 0], rotation: [1, 0, 0, 0] };
  let nearest = Infinity;
  let found: number | null = null;
  run.scene.bodies.forEach((body, index) => {
    if (!body.visible || body.shape.type === "plane" || !run.motion.shows(index, time)) return;
    const { origin, rotation } = run.motion.pose(index, time, pose);
    const away = hit(body.shape, run.scene.meshes, origin, rotation, ray);
    if (away < nearest) [nearest, found] = [away, index];
  });
  return found;
}

// Distance along the ray; Infinity: it misses.
function hit(shape: Shape, meshes: Mesh[], origin: Vec3, rotation: Quat, ray: Ray): number {
  if (shape.type === "plane") return Infinity;
  if (shape.type === "compound")
    return Math.min(
      ...shape.parts.map((part) =>
        hit(part.shape, meshes, add(origin, rotate(rotation, part.position)), multiply(rotation, part.rotation), ray),
      ),
    );
  const local: Ray = { from: rotate_back(rotation, subtract(ray.from, origin)), way: rotate_back(rotation, ray.way) };
  if (shape.type === "sphere") return hit_ball(shape.radius, local);
  if (shape.type === "box") return hit_box(shape.size, local);
  return hit_mesh(meshes[shape.mesh], local);
}

function hit_ball(radius: number, { from, way }: Ray): number {
  const half = dot(from, way);
  const root = half * half - dot(from, from) + radius * radius;
  if (root < 0) return Infinity;
  const away = -half - Math.sqrt(root);
  return away > 0 ? away : Infinity;
}

function hit_box(size: Vec3, { from, way }: Ray): number {
  let enter = 0;
  let leave = Infinity;
  for (let i = 0; i < 3; ++i) {
    const one = (-size[i] / 2 - from[i]) / way[i];
    const other = (size[i] / 2 - from[i]) / way[i];
    enter = Math.max(enter, Math.min(one, other));
    leave = Math.min(leave, Math.max(one, other));
  }
  return enter > 0 && enter <= leave ? enter : Infinity;
}

// Moeller and Trumbore 1997.
function hit_mesh({ positions, indices }: Mesh, { from, way }: Ray): number {
  const vertex = (i: number): Vec3 => [positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]];
  let nearest = Infinity;
  for (let i = 0; i + 2 < indices.length; i += 3) {
    const corner = vertex(indices[i]);
    const one = subtract(vertex(indices[i + 1]), corner);
    const other = subtract(vertex(indices[i + 2]), corner);
    const across = cross(way, other);
    const volume = dot(one, across);
    if (Math.abs(volume) < 1e-15) continue;
    const start = subtract(from, corner);
    const u = dot(start, across) / volume;
    const turned = cross(start, one);
    const v = dot(way, turned) / volume;
    const away = dot(other, turned) / volume;
    if (u >= 0 && v >= 0 && u + v <= 1 && away > 0) nearest = Math.min(nearest, away);
  }
  return nearest;
}
