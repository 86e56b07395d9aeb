// Planes without end: a square around the foot of the eye, so large that fog covers its edge.
import * as THREE from "three";
import type { Motion, Pose, Scene, Vec3 } from "../data/clip.ts";
import { look_of, patterns } from "./body_parts.ts";
import { from_text, to_linear } from "./color.ts";
import { uniforms_of_look, type Materials } from "./materials.ts";
import { add, cross, dot, normalized, rotate, scaled, subtract } from "./math.ts";

/** Half of the square, in distances at which fog is half of the light: fog is 0.9998 of it there. */
const reach = 8;

/** A plane at a moment: points with normal . x = offset. */
export interface WorldPlane {
  at(time: number): { normal: Vec3; offset: number };
}

interface Plane {
  body: number;
  normal: Vec3;
  offset: number;
  mesh: THREE.Mesh;
  material: THREE.ShaderMaterial;
}

function axes(normal: Vec3): { u: Vec3; v: Vec3 } {
  const across: Vec3 = Math.abs(normal[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
  const u = normalized(subtract(across, scaled(normal, dot(normal, across))));
  return { u, v: cross(normal, u) };
}

export class PlaneSet {
  readonly group = new THREE.Group();
  private readonly planes: Plane[] = [];
  private readonly square = new THREE.PlaneGeometry(2, 2);

  /** `cell`: of patterns, m. */
  constructor(
    scene: Scene,
    materials: Materials,
    private readonly fog_distance: number,
    cell: number,
  ) {
    scene.bodies.forEach((body, index) => {
      if (body.shape.type !== "plane" || !body.visible) return;
      const { texture, pattern_color, pattern_scale } = body;
      const look = look_of(body);
      if (look) delete look.opacity;
      const size = texture ? texture.scale || 1 : pattern_scale ?? cell;
      const material = materials.plane({
        u_center: { value: new THREE.Vector3() },
        u_axis_u: { value: new THREE.Vector3() },
        u_axis_v: { value: new THREE.Vector3() },
        u_normal: { value: new THREE.Vector3() },
        u_origin: { value: new THREE.Vector3() },
        u_reach: { value: reach * fog_distance },
        u_color: { value: new THREE.Vector3(...to_linear(from_text(body.color))) },
        u_material: { value: new THREE.Vector4(body.roughness, body.metallic, patterns.indexOf(body.pattern), size) },
        u_second: { value: new THREE.Vector3(...to_linear(from_text(pattern_color ?? body.color))) },
        ...uniforms_of_look(look, "plane", scene.textures),
      }, look);
      const mesh = new THREE.Mesh(this.square, material);
      mesh.frustumCulled = false;
      mesh.renderOrder = 1;
      this.group.add(mesh);
      this.planes.push({ body: index, normal: body.shape.normal, offset: body.shape.offset, mesh, material });
    });
  }

  update(motion: Motion, time: number, eye: Vec3): void {
    const pose: Pose = { position: [0, 0, 0], origin: [0, 0, 0], rotation: [1, 0, 0, 0] };
    for (const { body, normal, offset, material } of this.planes) {
      motion.pose(body, time, pose);
      const up = rotate(pose.rotation, normal);
      const { u, v } = axes(normal);
      const foot = subtract(eye, scaled(up, dot(up, subtract(eye, pose.origin)) - offset));
      const set = (name: string, value: Vec3) => (material.uniforms[name].value as THREE.Vector3).set(...value);
      set("u_center", foot);
      set("u_axis_u", rotate(pose.rotation, u));
      set("u_axis_v", rotate(pose.rotation, v));
      set("u_normal", up);
      set("u_origin", add(pose.origin, scaled(up, offset)));
    }
  }

  /** In the order of the bodies. */
  world_planes(motion: Motion): WorldPlane[] {
    const pose: Pose = { position: [0, 0, 0], origin: [0, 0, 0], rotation: [1, 0, 0, 0] };
    return this.planes.map(({ body, normal, offset }) => ({
      at: (time) => {
        motion.pose(body, time, pose);
        const up = rotate(pose.rotation, normal);
        return { normal: up, offset: offset + dot(up, pose.origin) };
      },
    }));
  }

  dispose(): void {
    this.square.dispose();
    for (const { material } of this.planes) {
      material.uniforms.u_image?.value.dispose();
      material.dispose();
    }
  }

  /** Half of the square, m. */
  get reach(): number {
    return reach * this.fog_distance;
  }

  /** Far enough for the whole square, m. */
  get far(): number {
    return 1.5 * this.reach;
  }
}
