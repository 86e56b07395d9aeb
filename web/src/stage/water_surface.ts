// The surface of water: rings around the foot of the eye, closer to each other near it, which the waves lift.
import * as THREE from "three";
import type { Vec3, Water } from "../data/clip.ts";
import type { Materials } from "./materials.ts";

const sectors = 160;
const rings = 200;
/** Of the farthest ring's radius. */
const first_ring = 1e-4;

export class WaterSurface {
  readonly mesh: THREE.Mesh;
  private readonly material: THREE.ShaderMaterial;
  private readonly geometry: THREE.BufferGeometry;

  /** `reach`: of the drawn part, m. */
  constructor(
    private readonly water: Water,
    private readonly materials: Materials,
    reach: number,
  ) {
    this.material = materials.water_surface();
    this.geometry = rings_to(reach, water.waves.length > 0 ? rings : 1);
    this.mesh = new THREE.Mesh(this.geometry, this.material);
    this.mesh.frustumCulled = false;
    // After the sky and all that is seen through it.
    this.mesh.renderOrder = 3;
  }

  update(time: number, eye: Vec3): void {
    (this.material.uniforms.u_foot.value as THREE.Vector2).set(eye[0], eye[2]);
    this.water.waves.forEach(({ k, amplitude, rate, phase }, i) =>
      this.materials.waves[i].set(...k, amplitude, (phase - rate * time) % (2 * Math.PI)));
  }

  dispose(): void {
    this.geometry.dispose();
    this.material.dispose();
  }
}

function rings_to(reach: number, count: number): THREE.BufferGeometry {
  const places = [0, 0, 0];
  const indices: number[] = [];
  const at = (ring: number, sector: number) => (ring === 0 ? 0 : 1 + (ring - 1) * sectors + (sector % sectors));
  for (let ring = 1; ring <= count; ++ring) {
    const radius = reach * first_ring ** (1 - ring / count);
    for (let sector = 0; sector < sectors; ++sector) {
      const angle = (2 * Math.PI * sector) / sectors;
      places.push(radius * Math.cos(angle), 0, radius * Math.sin(angle));
      const [a, b, c, d] = [at(ring - 1, sector), at(ring - 1, sector + 1), at(ring, sector), at(ring, sector + 1)];
      indices.push(a, d, c);
      if (ring > 1) indices.push(a, b, d);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(places, 3));
  geometry.setIndex(indices);
  return geometry;
}
