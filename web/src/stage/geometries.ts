// The meshes that instances of bodies share: a box and a ball of size 1, and the clip's own meshes.
import * as THREE from "three";
import type { Mesh, MeshPaint } from "../data/clip.ts";

/** Segments around and from pole to pole: many balls are small, and each triangle costs in software. */
const ball_segments = [
  { up_to: 8, around: 48, down: 32 },
  { up_to: 40, around: 32, down: 20 },
  { up_to: 200, around: 20, down: 13 },
  { up_to: Infinity, around: 14, down: 9 },
];

function ball(balls: number): THREE.BufferGeometry {
  const { around, down } = ball_segments.find(({ up_to }) => balls <= up_to)!;
  return new THREE.SphereGeometry(1, around, down);
}

function own_mesh(mesh: Mesh): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(mesh.positions, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(mesh.normals, 3));
  geometry.setIndex(new THREE.BufferAttribute(mesh.indices, 1));
  if (mesh.paint) {
    geometry.setAttribute("p_uv", new THREE.BufferAttribute(mesh.paint.uv, 2));
    geometry.setAttribute("p_color", new THREE.BufferAttribute(mesh.paint.color, 3));
    geometry.setAttribute("p_emission", new THREE.BufferAttribute(mesh.paint.emission, 3));
    geometry.setAttribute("p_surface", new THREE.BufferAttribute(mesh.paint.surface, 2));
    mesh.paint.groups.forEach(({ first, count }, i) => geometry.addGroup(first, count, i));
  }
  return geometry;
}

/** Key of a geometry: "box", "ball", "rod" along y, or "mesh" with its index. */
export type GeometryKey = "box" | "ball" | "rod" | `mesh${number}`;

export class Geometries {
  private readonly made = new Map<GeometryKey, THREE.BufferGeometry>();
  constructor(
    private readonly meshes: Mesh[],
    private readonly balls: number,
  ) {}

  get(key: GeometryKey): THREE.BufferGeometry {
    let geometry = this.made.get(key);
    if (!geometry) {
      if (key === "box") geometry = new THREE.BoxGeometry(2, 2, 2);
      else if (key === "ball") geometry = ball(this.balls);
      else if (key === "rod") geometry = new THREE.CylinderGeometry(1, 1, 2, 8, 1);
      else geometry = own_mesh(this.meshes[Number(key.slice(4))]);
      this.made.set(key, geometry);
    }
    return geometry;
  }

  /** The colors of the file of a mesh, if it has some. */
  paint_of(key: GeometryKey): MeshPaint | undefined {
    return key.startsWith("mesh") ? this.meshes[Number(key.slice(4))].paint : undefined;
  }

  dispose(): void {
    for (const geometry of this.made.values()) geometry.dispose();
  }
}
