// Bodies of one scene, drawn by as few calls as there are geometries: the solid ones, their outlines, or translucent ghosts.
import * as THREE from "three";
import type { MeshPaint, Quat, Scene, Vec3 } from "../data/clip.ts";
import { BodyBatch, type Instance } from "./body_batch.ts";
import { parts_of, type Part } from "./body_parts.ts";
import type { Geometries, GeometryKey } from "./geometries.ts";
import { add, multiply, rotate } from "./math.ts";
import type { BodyKind } from "./materials.ts";

/** A color laid over a body, sRGB, and its share. */
export interface Tint {
  color: Vec3;
  share: number;
}

const no_tint: Tint = { color: [0, 0, 0], share: 0 };

export class BodySet {
  readonly group = new THREE.Group();
  private readonly batches = new Map<GeometryKey, BodyBatch>();
  private readonly parts: Part[][];

  constructor(
    scene: Scene,
    private readonly geometries: Geometries,
    private readonly materials: Record<BodyKind, THREE.Material>,
    private readonly set_up: (mesh: THREE.Mesh) => void = () => {},
    /** The materials of a mesh in the colors of its file, one for each of its groups; without it, those of the body. */
    private readonly painted?: (paint: MeshPaint) => THREE.Material[],
  ) {
    this.parts = scene.bodies.map((body) => parts_of(scene, body));
  }

  begin(): void {
    for (const batch of this.batches.values()) batch.begin();
  }

  add(body: number, origin: Vec3, rotation: Quat, tint: Tint = no_tint, opacity = 1): void {
    for (const part of this.parts[body]) this.add_part(part, origin, rotation, tint, opacity);
  }

  add_part(part: Part, origin: Vec3, rotation: Quat, tint: Tint = no_tint, opacity = 1): void {
    const instance: Instance = {
      ...part,
      origin: add(origin, rotate(rotation, part.position)),
      rotation: multiply(rotation, part.rotation),
      opacity,
      tint: tint.color,
      tint_share: tint.share,
    };
    this.batch(part.geometry).add(instance);
  }

  end(): void {
    for (const batch of this.batches.values()) batch.end();
  }

  dispose(): void {
    for (const batch of this.batches.values()) batch.dispose();
  }

  private batch(key: GeometryKey): BodyBatch {
    let batch = this.batches.get(key);
    if (!batch) {
      const kind = key === "box" || key === "ball" ? key : "mesh";
      const paint = this.geometries.paint_of(key);
      batch = new BodyBatch(this.geometries.get(key), paint && this.painted ? this.painted(paint) : this.materials[kind]);
      this.batches.set(key, batch);
      this.group.add(batch.mesh);
      this.set_up(batch.mesh);
    }
    return batch;
  }
}
