// What is drawn of a body: compounds fall apart into boxes, balls and meshes, each with a place in the body's frame.
import drawing_style from "../../../src/render/shapes/drawing_style.json";
import type { Body, Mesh, Quat, Scene, Shape, Vec3 } from "../data/clip.ts";
import { from_text, to_linear } from "./color.ts";
import type { GeometryKey } from "./geometries.ts";
import { add, length, multiply, rotate } from "./math.ts";

export interface Part {
  geometry: GeometryKey;
  /** In the body's frame, from the body's origin. */
  position: Vec3;
  rotation: Quat;
  size: Vec3;
  bevel: number;
  /** Linear. */
  color: Vec3;
  roughness: number;
  metallic: number;
  pattern: number;
  pattern_cell: number;
  /** A pattern of two colors, or an image, which need a program or a texture of their own. */
  look?: Look;
  /** Second color of a pattern, linear; of an image how often it goes around and along a ball. */
  second?: Vec3;
}

/** Index of the pattern; or images, null for none, with scale and filter; opacity and own light, linear. */
export interface Look {
  colors?: number;
  images?: { image: number | null; scale: number; nearest: boolean; normal_map?: number; roughness_map?: number };
  opacity?: number;
  emission?: Vec3;
}

// As Pattern of src/scene/description/description.h.
export const patterns = ["panel", "grid", "checker", "plain", "stripes", "dots", "noise", "wood", "marble"];

export function look_of(body: Body): Look | undefined {
  const { texture, normal_map, roughness_map, opacity, emission } = body;
  const look: Look = {};
  if (texture) look.images = { ...texture, normal_map, roughness_map };
  else if (body.pattern_color) look.colors = patterns.indexOf(body.pattern);
  if (opacity !== undefined) look.opacity = opacity;
  if (emission) look.emission = to_linear(from_text(emission));
  return Object.keys(look).length > 0 ? look : undefined;
}

/** As images_on_ball() of src/scene/description/looks.cpp. */
function images_on_ball(radius: number, scale: number): Vec3 {
  const around = 2 * Math.PI * radius;
  return scale > 0 ? [Math.max(1, Math.round(around / scale)), around / 2 / scale, 0] : [1, 1, 0];
}

const { bevel_of_edge, pattern_cell_of_radius } = drawing_style;
const identity: Quat = [1, 0, 0, 0];

export interface Box {
  low: Vec3;
  high: Vec3;
}

export function mesh_box(mesh: Mesh): Box {
  const box: Box = { low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] };
  for (let i = 0; i < mesh.positions.length; ++i) {
    box.low[i % 3] = Math.min(box.low[i % 3], mesh.positions[i]);
    box.high[i % 3] = Math.max(box.high[i % 3], mesh.positions[i]);
  }
  return box;
}

export function parts_of(scene: Scene, body: Body): Part[] {
  const parts: Part[] = [];
  add_shape(scene, body, body.shape, [0, 0, 0], identity, body.color, body.pattern_color, parts);
  return parts;
}

function add_shape(scene: Scene, body: Body, shape: Shape, position: Vec3, rotation: Quat, color: string,
  second: string | undefined, to: Part[]): void {
  const { roughness, metallic } = body;
  const common = {
    position, rotation, color: to_linear(from_text(color)), roughness, metallic, pattern: patterns.indexOf(body.pattern),
    look: look_of(body), second: second === undefined ? undefined : to_linear(from_text(second)),
  };
  const cell = (thinnest: number) => body.pattern_scale ?? pattern_cell_of_radius * thinnest;
  if (shape.type === "compound") {
    for (const part of shape.parts)
      add_shape(scene, body, part.shape, add(position, rotate(rotation, part.position)), multiply(rotation, part.rotation),
        part.color, part.pattern_color, to);
  } else if (shape.type === "box") {
    const half = shape.size.map((edge) => edge / 2) as Vec3;
    const thinnest = Math.min(...half);
    to.push({ ...common, geometry: "box", size: half, bevel: 2 * bevel_of_edge * thinnest, pattern_cell: cell(thinnest) });
  } else if (shape.type === "sphere") {
    const { radius } = shape;
    if (body.texture) common.second = images_on_ball(radius, body.texture.scale);
    to.push({ ...common, geometry: "ball", size: [radius, radius, radius], bevel: 0, pattern_cell: cell(radius) });
  } else if (shape.type === "mesh") {
    const { low, high } = mesh_box(scene.meshes[shape.mesh]);
    const half = Math.min(...high.map((value, i) => (value - low[i]) / 2).filter((value) => value > 0));
    // The images are in the paint of the mesh.
    if (body.texture && common.look)
      common.look = body.opacity || body.emission ? { ...common.look, images: undefined } : undefined;
    to.push({ ...common, geometry: `mesh${shape.mesh}`, size: [1, 1, 1], bevel: 0, pattern_cell: cell(half) });
  }
}

/** Distance of the farthest point of a shape from the body's origin, m; 0 of planes. */
export function radius_of(scene: Scene, shape: Shape): number {
  switch (shape.type) {
    case "plane":
      return 0;
    case "box":
      return length(shape.size) / 2;
    case "sphere":
      return shape.radius;
    case "mesh": {
      const { positions } = scene.meshes[shape.mesh];
      let most = 0;
      for (let i = 0; i + 2 < positions.length; i += 3)
        most = Math.max(most, Math.hypot(positions[i], positions[i + 1], positions[i + 2]));
      return most;
    }
    case "compound":
      return Math.max(0, ...shape.parts.map((part) => length(part.position) + radius_of(scene, part.shape)));
  }
}
