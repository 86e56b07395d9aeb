// The meshes that instances of bodies share: a box and a ball of size 1, and the clip's own meshes.
import * as THREE from "three";
import type { Mesh } from "../data/clip.ts";

/** From this number of balls on, each has fewer triangles, so that a heap of them is drawn in time. */
const many_balls = 150;

function ball(balls: number): THREE.BufferGeometry {
  return balls < many_balls ? new THREE.SphereGeometry(1, 48, 32) : new THREE.SphereGeometry(1, 20, 14);
}

function own_mesh(mesh: Mesh): THREE.BufferGeometry {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(mesh.positions, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(mesh.normals, 3));
  geometry.setIndex(new THREE.BufferAttribute(mesh.indices, 1));
  return geometry;
}

/** Key of a geometry: "box", "ball", or "mesh" with its index. */
export type GeometryKey = "box" | "ball" | `mesh${number}`;

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
      else geometry = own_mesh(this.meshes[Number(key.slice(4))]);
      this.made.set(key, geometry);
    }
    return geometry;
  }

  dispose(): void {
    for (const geometry of this.made.values()) geometry.dispose();
  }
}
