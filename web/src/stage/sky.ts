// The background where no body and no plane is.
import * as THREE from "three";
import type { Materials } from "./materials.ts";

export class Sky {
  readonly mesh: THREE.Mesh;
  private readonly triangle = new THREE.BufferGeometry();

  constructor(private readonly materials: Materials) {
    // One triangle covers the picture.
    this.triangle.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    this.mesh = new THREE.Mesh(this.triangle, materials.sky);
    this.mesh.frustumCulled = false;
    // After bodies and planes, which hide most of it.
    this.mesh.renderOrder = 2;
  }

  update(camera: THREE.PerspectiveCamera): void {
    const half = Math.tan((camera.fov * Math.PI) / 360);
    const { u_ray_center, u_ray_right, u_ray_up } = this.materials.frame;
    const axis = (x: number, y: number, z: number) => new THREE.Vector3(x, y, z).applyQuaternion(camera.quaternion);
    u_ray_center.value.copy(axis(0, 0, -1));
    u_ray_right.value.copy(axis(half * camera.aspect, 0, 0));
    u_ray_up.value.copy(axis(0, half, 0));
  }

  dispose(): void {
    this.triangle.dispose();
  }
}
