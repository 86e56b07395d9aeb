// The darker ground below the bodies that stand on a plane or hang closely above it.
import * as THREE from "three";
import type { Pose, Quat, Run, Vec3 } from "../data/clip.ts";
import { mesh_box, parts_of, type Part } from "./body_parts.ts";
import type { Materials } from "./materials.ts";
import { add, clamp, dot, multiply, normalized, rotate, scaled, subtract } from "./math.ts";
import type { WorldPlane } from "./plane_set.ts";

/** Share of the sky: where less is hidden, nothing is drawn. */
const least_hidden = 0.03;
/** Heights of bodies above a plane from which on they hide too little, in their own sizes. */
const highest = 1.5;
/** Boxes, balls and meshes of a scene: with more, drawing takes a third longer in software, and their shadows cover the ground. */
const most = 40;
const stride = 11;

interface Piece extends Part {
  body: number;
  /** Half of the size of the box around it, m. */
  half: Vec3;
  /** Middle of that box in the part's frame, m. */
  middle: Vec3;
}

export class OcclusionSet {
  readonly mesh: THREE.Mesh;
  private readonly material: THREE.ShaderMaterial;
  private readonly geometry = new THREE.InstancedBufferGeometry();
  private readonly buffer = new THREE.InstancedInterleavedBuffer(new Float32Array(stride * most), stride);
  private readonly pieces: Piece[];

  constructor(
    private readonly run: Run,
    private readonly plane: WorldPlane,
    materials: Materials,
    radii: number[],
  ) {
    const { scene } = run;
    const pieces = scene.bodies.flatMap((body, index) =>
      body.visible && radii[index] > 0 ? parts_of(scene, body).map((part) => ({ ...part, body: index, ...box_of(part, run) })) : [],
    );
    this.pieces = pieces.length > most ? [] : pieces;
    this.material = materials.occlusion();
    this.geometry.setAttribute("position", new THREE.PlaneGeometry(2, 2).getAttribute("position"));
    this.geometry.setIndex([0, 2, 1, 2, 3, 1]);
    this.buffer.setUsage(THREE.DynamicDrawUsage);
    this.geometry.setAttribute("i_foot", new THREE.InterleavedBufferAttribute(this.buffer, 4, 0));
    this.geometry.setAttribute("i_half", new THREE.InterleavedBufferAttribute(this.buffer, 4, 4));
    this.geometry.setAttribute("i_along", new THREE.InterleavedBufferAttribute(this.buffer, 3, 8));
    this.mesh = new THREE.Mesh(this.geometry, this.material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 1.5;
  }

  update(time: number): void {
    const { normal, offset } = this.plane.at(time);
    (this.material.uniforms.u_normal.value as THREE.Vector3).set(...normal);
    const pose: Pose = { position: [0, 0, 0], origin: [0, 0, 0], rotation: [1, 0, 0, 0] };
    let body = -1;
    let count = 0;
    for (const piece of this.pieces) {
      if (!this.run.motion.shows(piece.body, time)) continue;
      if (piece.body !== body) this.run.motion.pose((body = piece.body), time, pose);
      const rotation = multiply(pose.rotation, piece.rotation);
      const center = add(add(pose.origin, rotate(pose.rotation, piece.position)), rotate(rotation, piece.middle));
      if (this.write(piece, center, rotation, normal, dot(normal, center) - offset, count)) ++count;
    }
    this.geometry.instanceCount = count;
    this.mesh.visible = count > 0;
    this.buffer.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }

  // False: nothing to see.
  private write(piece: Piece, center: Vec3, rotation: Quat, normal: Vec3, height: number, at: number): boolean {
    const to = this.buffer.array as Float32Array;
    const foot = subtract(center, scaled(normal, height));
    const { half } = piece;
    const axes = ([[1, 0, 0], [0, 1, 0], [0, 0, 1]] as Vec3[]).map((axis) => rotate(rotation, axis));
    // The axis nearest to the normal points up; the others span the covered rectangle.
    const rises = axes.map((axis) => Math.abs(dot(axis, normal)));
    const up = rises.indexOf(Math.max(...rises));
    const [first, second] = [(up + 1) % 3, (up + 2) % 3];
    const box = piece.geometry === "box";
    const size = box ? Math.max(half[first], half[second]) : Math.sqrt(half[first] * half[second]);
    const underside = height - (piece.geometry === "ball" ? size : dot(half, rises as Vec3));
    if (height <= 0 || underside > highest * size) return false;
    // A tilted box is higher on one side. The form of a mesh is unknown: a ball has no corners where the mesh has none.
    const tilted = 0.35 * (rises[first] * half[first] + rises[second] * half[second]);
    const above = box ? Math.max(underside, 0.02 * size) + tilted : Math.max(height, size);
    const covered = box ? (4 / Math.PI) * half[first] * half[second] : size * size;
    const reach = clamp(Math.cbrt((covered * (above + 0.3 * size)) / least_hidden), 0, 4 * size);
    to.set(foot, stride * at);
    to[stride * at + 3] = above;
    to.set(box ? [half[first], half[second], half[first] + reach, half[second] + reach] : [size, 0, reach, reach], stride * at + 4);
    to.set(normalized(subtract(axes[first], scaled(normal, dot(axes[first], normal)))), stride * at + 8);
    return true;
  }
}

function box_of(part: Part, run: Run): { half: Vec3; middle: Vec3 } {
  if (!part.geometry.startsWith("mesh")) return { half: part.size, middle: [0, 0, 0] };
  const { low, high } = mesh_box(run.scene.meshes[Number(part.geometry.slice(4))]);
  const both = (of: (i: number) => number) => [of(0), of(1), of(2)] as Vec3;
  return { half: both((i) => (high[i] - low[i]) / 2), middle: both((i) => (high[i] + low[i]) / 2) };
}
