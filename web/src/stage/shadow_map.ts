// Shadows of the sun: the depths of all bodies as seen from it. The map covers the bodies of the whole clip, so that shadows do
// not crawl, and is drawn again only when bodies have moved.
import * as THREE from "three";
import type { Vec3 } from "../data/clip.ts";
import type { Materials } from "./materials.ts";

/** Texels across: at 1280 x 720 in software a larger map costs more than the picture. */
const size = 1024;
const caster_layer = 1;

export const casts_shadow = (object: THREE.Object3D): void => object.layers.enable(caster_layer);

export class ShadowMap {
  private readonly camera = new THREE.OrthographicCamera();
  private readonly target: THREE.WebGLRenderTarget;
  private readonly matrix = new THREE.Matrix4();
  private readonly texel: number;

  constructor(center: Vec3, radius: number, to_light: Vec3) {
    const depth = new THREE.DepthTexture(size, size, THREE.UnsignedShortType);
    depth.compareFunction = THREE.LessEqualCompare;
    depth.minFilter = depth.magFilter = THREE.LinearFilter;
    this.target = new THREE.WebGLRenderTarget(size, size, { depthTexture: depth, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter });
    const { camera } = this;
    camera.left = camera.bottom = -radius;
    camera.right = camera.top = radius;
    camera.near = 0;
    camera.far = 4 * radius;
    const to = new THREE.Vector3(...to_light);
    if (Math.abs(to.y) > 0.999) camera.up.set(0, 0, 1);
    camera.position.set(...center).addScaledVector(to, 2 * radius);
    camera.lookAt(...center);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    camera.layers.set(caster_layer);
    this.texel = (2 * radius) / size;
    this.matrix
      .set(0.5, 0, 0, 0.5, 0, 0.5, 0, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0, 1)
      .multiply(camera.projectionMatrix)
      .multiply(camera.matrixWorldInverse);
  }

  draw(renderer: THREE.WebGLRenderer, scene: THREE.Scene, materials: Materials): void {
    materials.frame.u_shadow_map.value = null;
    scene.overrideMaterial = materials.depth;
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.render(scene, this.camera);
    renderer.setRenderTarget(null);
    scene.overrideMaterial = null;
  }

  use(materials: Materials): void {
    const { frame } = materials;
    frame.u_shadow_map.value = this.target.depthTexture;
    frame.u_shadow_matrix.value.copy(this.matrix);
    frame.u_shadow_size.value = size;
    frame.u_shadow_texel.value = this.texel;
  }

  dispose(): void {
    this.target.depthTexture?.dispose();
    this.target.dispose();
  }
}
