// Bodies of one scene, drawn by as few calls as there are geometries: the solid ones, their outlines, or translucent ghosts.
import * as THREE from "three";
import type { MeshPaint, Quat, Scene, Texels, Vec3 } from "../data/clip.ts";
import { BodyBatch, type Instance } from "./body_batch.ts";
import { parts_of, type Look, type Part } from "./body_parts.ts";
import type { Geometries, GeometryKey } from "./geometries.ts";
import { add, multiply, rotate } from "./math.ts";
import type { BodyKind } from "./materials.ts";

/** A color laid over a body, sRGB, and its share. */
export interface Tint {
  color: Vec3;
  share: number;
}

export interface LookMaterials {
  /** One for each group of the mesh. */
  painted(paint: MeshPaint, look: Look | undefined): THREE.Material[];
  of_look(kind: BodyKind, look: Look, textures: Texels[]): THREE.Material;
}

const no_tint: Tint = { color: [0, 0, 0], share: 0 };

export class BodySet {
  readonly group = new THREE.Group();
  private readonly batches = new Map<string, BodyBatch>();
  private readonly parts: Part[][];
  private readonly textures: Texels[];

  constructor(
    scene: Scene,
    private readonly geometries: Geometries,
    private readonly materials: Record<BodyKind, THREE.Material>,
    private readonly set_up: (mesh: THREE.Mesh) => void = () => {},
    /** Materials of looks and of the colors of mesh files; without it, all bodies have the materials of their kind. */
    private readonly looks?: LookMaterials,
  ) {
    this.textures = scene.textures;
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
      opacity: opacity * (part.look?.opacity ?? 1),
      tint: tint.color,
      tint_share: tint.share,
    };
    this.batch(part).add(instance);
  }

  end(): void {
    for (const batch of this.batches.values()) batch.end();
  }

  dispose(): void {
    for (const batch of this.batches.values()) batch.dispose();
  }

  private batch({ geometry, look }: Part): BodyBatch {
    const key = look && this.looks ? `${geometry} ${JSON.stringify(look)}` : geometry;
    let batch = this.batches.get(key);
    if (!batch) {
      batch = new BodyBatch(this.geometries.get(geometry), this.material(geometry, look));
      this.batches.set(key, batch);
      this.group.add(batch.mesh);
      this.set_up(batch.mesh);
    }
    return batch;
  }

  private material(geometry: GeometryKey, look: Look | undefined): THREE.Material | THREE.Material[] {
    const kind = geometry === "box" || geometry === "ball" ? geometry : "mesh";
    const paint = this.geometries.paint_of(geometry);
    if (this.looks && paint) return this.looks.painted(paint, look);
    return this.looks && look ? this.looks.of_look(kind, look, this.textures) : this.materials[kind];
  }
}
