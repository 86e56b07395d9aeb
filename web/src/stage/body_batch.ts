// Many bodies of one geometry in one draw call. The instances are set anew for each frame, so that any number of bodies and
// ghosts may come and go.
import * as THREE from "three";
import type { Quat, Vec3 } from "../data/clip.ts";

export interface Instance {
  origin: Vec3;
  rotation: Quat;
  /** Factors on the mesh; of boxes half of the size, m. */
  size: Vec3;
  /** Of edges, m; 0: sharp. */
  bevel: number;
  /** Linear. */
  color: Vec3;
  roughness: number;
  metallic: number;
  /** Index into patterns of body_parts.ts. */
  pattern: number;
  /** m. */
  pattern_cell: number;
  opacity: number;
  /** sRGB, and its share in what is seen. */
  tint: Vec3;
  tint_share: number;
  /** See Part of body_parts.ts. */
  second?: Vec3;
}

const stride = 28;
const layout = { i_place: 0, i_rotation: 4, i_size: 8, i_color: 12, i_material: 16, i_tint: 20, i_second: 24 };

export class BodyBatch {
  readonly mesh: THREE.Mesh;
  private readonly geometry = new THREE.InstancedBufferGeometry();
  private buffer = new THREE.InstancedInterleavedBuffer(new Float32Array(0), stride);
  private count = 0;

  /** Several materials: one for each group of the geometry. */
  constructor(base: THREE.BufferGeometry, material: THREE.Material | THREE.Material[]) {
    for (const name of Object.keys(base.attributes)) this.geometry.setAttribute(name, base.getAttribute(name));
    this.geometry.setIndex(base.getIndex());
    if (Array.isArray(material)) for (const { start, count, materialIndex } of base.groups) this.geometry.addGroup(start, count, materialIndex);
    this.grow(16);
    this.mesh = new THREE.Mesh(this.geometry, material);
    // The bounds of a changing set of instances are not known.
    this.mesh.frustumCulled = false;
  }

  begin(): void {
    this.count = 0;
  }

  add(instance: Instance): void {
    if (this.count === this.buffer.count) this.grow(2 * this.count);
    const { origin, rotation, size, color, tint } = instance;
    const to = this.buffer.array as Float32Array;
    const at = stride * this.count++;
    to[at] = origin[0];
    to[at + 1] = origin[1];
    to[at + 2] = origin[2];
    to[at + 3] = instance.pattern_cell;
    to[at + 4] = rotation[1];
    to[at + 5] = rotation[2];
    to[at + 6] = rotation[3];
    to[at + 7] = rotation[0];
    to[at + 8] = size[0];
    to[at + 9] = size[1];
    to[at + 10] = size[2];
    to[at + 11] = instance.bevel;
    to[at + 12] = color[0];
    to[at + 13] = color[1];
    to[at + 14] = color[2];
    to[at + 15] = instance.roughness;
    to[at + 16] = instance.metallic;
    to[at + 17] = instance.pattern;
    to[at + 18] = instance.opacity;
    to[at + 19] = 0;
    to[at + 20] = tint[0];
    to[at + 21] = tint[1];
    to[at + 22] = tint[2];
    to[at + 23] = instance.tint_share;
    const { second } = instance;
    if (second) to.set(second, at + 24);
  }

  end(): void {
    this.geometry.instanceCount = this.count;
    this.mesh.visible = this.count > 0;
    if (this.count === 0) return;
    this.buffer.clearUpdateRanges();
    this.buffer.addUpdateRange(0, stride * this.count);
    this.buffer.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
  }

  private grow(capacity: number): void {
    const array = new Float32Array(stride * capacity);
    array.set(this.buffer.array as Float32Array);
    // A buffer on the graphics card keeps its size: a larger one is another buffer.
    this.geometry.dispose();
    this.buffer = new THREE.InstancedInterleavedBuffer(array, stride);
    this.buffer.setUsage(THREE.DynamicDrawUsage);
    for (const [name, offset] of Object.entries(layout))
      this.geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(this.buffer, 4, offset));
  }
}
