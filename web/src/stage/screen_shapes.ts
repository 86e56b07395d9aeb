// Arrows, lines or markers of a frame, in one buffer: as many as the frame has. Parts behind bodies are drawn faintly.
import * as THREE from "three";
import type { Vec3 } from "../data/clip.ts";
import { translucent } from "./materials.ts";
import {
  arrow_fragment_glsl, arrow_vertex_glsl, line_fragment_glsl, line_vertex_glsl, marker_fragment_glsl, marker_vertex_glsl,
} from "./screen_glsl.ts";

export type ShapeKind = "arrow" | "line" | "trail" | "marker";

/** The four vectors of an instance; see screen_glsl.ts. */
export interface ScreenShape {
  from: Vec3;
  /** Width of an arrow or a line and radius of a marker, in units; of a trail the time at the start, s. */
  from_w: number;
  to: Vec3;
  /** Heads of an arrow; of a trail the time at the end, s. */
  to_w: number;
  /** sRGB. */
  color: Vec3;
  opacity: number;
  /** m; Infinity: no surface hides it. */
  allowance: number;
  /** Form of a marker; width of a trail, in units. */
  form: number;
}

/** Values that all overlays share, set before each view is drawn. */
export class ScreenUniforms {
  readonly u_view = { value: new THREE.Vector2(1, 1) };
  readonly u_unit = { value: 1 };
  readonly u_near = { value: 0.01 };
  readonly u_times = { value: new THREE.Vector2(0, 0) };
}

const programs = {
  arrow: [arrow_vertex_glsl, arrow_fragment_glsl],
  line: [line_vertex_glsl, line_fragment_glsl],
  trail: [line_vertex_glsl, line_fragment_glsl],
  marker: [marker_vertex_glsl, marker_fragment_glsl],
};
const stride = 16;
const faint = 0.5;
const first_order = 10;

export class ScreenShapes {
  readonly group = new THREE.Group();
  private readonly geometry = new THREE.InstancedBufferGeometry();
  private readonly materials: { material: THREE.ShaderMaterial; share: number }[] = [];
  private buffer = new THREE.InstancedInterleavedBuffer(new Float32Array(0), stride);
  private count = 0;

  /** Sets with a higher order are drawn over others. */
  constructor(kind: ShapeKind, uniforms: ScreenUniforms, order: number) {
    const corners = new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]);
    this.geometry.setAttribute("position", new THREE.BufferAttribute(corners, 3));
    this.geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.grow(16);
    for (const hidden of [true, false]) {
      const material = new THREE.ShaderMaterial({
        glslVersion: THREE.GLSL3,
        uniforms: { ...uniforms, u_opacity: { value: 1 } },
        defines: kind === "trail" ? { TRAIL: "" } : {},
        vertexShader: programs[kind][0],
        fragmentShader: programs[kind][1],
        depthFunc: hidden ? THREE.GreaterDepth : THREE.LessEqualDepth,
        side: THREE.DoubleSide,
        ...translucent,
      });
      this.materials.push({ material, share: hidden ? faint : 1 });
      const mesh = new THREE.Mesh(this.geometry, material);
      mesh.frustumCulled = false;
      mesh.renderOrder = first_order + 2 * order + (hidden ? 0 : 1);
      this.group.add(mesh);
    }
  }

  begin(): void {
    this.count = 0;
  }

  add(shape: ScreenShape): void {
    if (this.count === this.buffer.count) this.grow(2 * this.count);
    const to = this.buffer.array as Float32Array;
    const at = stride * this.count++;
    to.set(shape.from, at);
    to[at + 3] = shape.from_w;
    to.set(shape.to, at + 4);
    to[at + 7] = shape.to_w;
    to.set(shape.color, at + 8);
    to[at + 11] = shape.opacity;
    const always = shape.allowance === Infinity;
    to[at + 12] = always ? 0 : shape.allowance;
    to[at + 13] = always ? 1 : 0;
    to[at + 14] = shape.form;
  }

  end(): void {
    this.geometry.instanceCount = this.count;
    this.group.visible = this.count > 0;
    if (this.count === 0) return;
    this.buffer.clearUpdateRanges();
    this.buffer.addUpdateRange(0, stride * this.count);
    this.buffer.needsUpdate = true;
  }

  /** Draws only the first ones. */
  limit(count: number): void {
    this.geometry.instanceCount = Math.min(count, this.count);
    this.group.visible = this.geometry.instanceCount > 0;
  }

  /** Factor on the opacity of all. */
  set_opacity(opacity: number): void {
    for (const { material, share } of this.materials) material.uniforms.u_opacity.value = share * opacity;
  }

  dispose(): void {
    this.geometry.dispose();
    for (const { material } of this.materials) material.dispose();
  }

  private grow(capacity: number): void {
    const array = new Float32Array(stride * capacity);
    array.set(this.buffer.array as Float32Array);
    this.geometry.dispose();
    this.buffer = new THREE.InstancedInterleavedBuffer(array, stride);
    this.buffer.setUsage(THREE.DynamicDrawUsage);
    ["a_from", "a_to", "a_color", "a_more"].forEach((name, i) =>
      this.geometry.setAttribute(name, new THREE.InterleavedBufferAttribute(this.buffer, 4, 4 * i)),
    );
  }
}
