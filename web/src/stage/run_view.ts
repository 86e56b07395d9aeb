// One run as a picture: its bodies, planes, sky, shadows and overlays.
import * as THREE from "three";
import type { Camera, Pose, Run, Vec3 } from "../data/clip.ts";
import { BodySet, type Tint } from "./body_set.ts";
import { fitted_fov } from "./camera_rig.ts";
import { add_cords } from "./cords.ts";
import { Geometries } from "./geometries.ts";
import type { Materials } from "./materials.ts";
import { distance } from "./math.ts";
import { OverlayView } from "./overlay_view.ts";
import { run_colors } from "./overlay_style.ts";
import { OcclusionSet } from "./occlusion_set.ts";
import { PlaneSet } from "./plane_set.ts";
import { measure, type SceneSize } from "./scene_size.ts";
import type { ScreenUniforms } from "./screen_shapes.ts";
import { casts_shadow, ShadowMap } from "./shadow_map.ts";
import { Sky } from "./sky.ts";
import type { Moment } from "./moment.ts";
import { WaterSurface } from "./water_surface.ts";

/** Of other runs in a comparison by ghosts. */
const run_opacity = 0.6;
const run_tint = 0.65;
/** Width of the outline of the chosen body, units of the screen. */
const outline_width = 2.2;
/** Nearest part of the scene that is drawn, in distances to the camera's target. */
const nearest = 0.01;

export class RunView {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera();
  readonly size: SceneSize;
  readonly overlays: OverlayView;
  private readonly geometries: Geometries;
  private readonly solids: BodySet;
  private readonly outline: BodySet;
  private readonly planes: PlaneSet;
  private readonly sky: Sky;
  private readonly occlusion: OcclusionSet[];
  private readonly shadow: ShadowMap | null;
  private readonly water: WaterSurface | null;
  /** Ghosts of other runs, by their index. */
  private readonly others = new Map<number, { run: Run; set: BodySet; geometries: Geometries }>();
  private shadow_time = Number.NaN;

  constructor(
    readonly run: Run,
    private readonly materials: Materials,
    private readonly uniforms: ScreenUniforms,
  ) {
    this.size = measure(run);
    const { scene } = run;
    this.geometries = new Geometries(scene.meshes, scene.bodies.length);
    this.solids = new BodySet(scene, this.geometries, materials.solid, casts_shadow, materials);
    this.outline = new BodySet(scene, this.geometries, materials.outline);
    this.planes = new PlaneSet(scene, materials, this.size.fog_distance, this.size.pattern_cell);
    this.sky = new Sky(materials);
    this.occlusion = this.planes
      .world_planes(run.motion)
      .map((plane) => new OcclusionSet(run, plane, materials, this.size.radii));
    const { shadow_center, shadow_radius, to_light } = this.size;
    this.shadow = scene.light.shadows ? new ShadowMap(shadow_center, shadow_radius, to_light) : null;
    this.overlays = new OverlayView(run, this.size, this.geometries, materials, uniforms);
    this.scene.add(this.solids.group, this.outline.group, this.planes.group, this.sky.mesh, this.overlays.group);
    for (const { mesh } of this.occlusion) this.scene.add(mesh);
    this.water = scene.water ? new WaterSurface(scene.water, materials, this.planes.reach) : null;
    if (this.water) this.scene.add(this.water.mesh);
  }

  /** `others`: runs whose bodies are shown as ghosts, by their index. */
  update(moment: Moment, others: { index: number; run: Run }[]): void {
    const { time, before, shown, symbol, selected } = moment;
    this.overlays.update(time, before, shown, symbol);
    const tints = new Map<number, Tint>([...this.overlays.frame.tints, ...(this.overlays.lit?.tints ?? [])]);
    this.solids.begin();
    this.outline.begin();
    each_pose(this.run, time, (body, { origin, rotation }) => {
      this.solids.add(body, origin, rotation, tints.get(body));
      if (body === selected) this.outline.add(body, origin, rotation);
    });
    add_cords(this.run.scene.cords, this.run.motion, time, this.size.viewing_distance, this.solids);
    this.solids.end();
    this.outline.end();
    for (const occlusion of this.occlusion) occlusion.update(time);
    this.update_others(time, others);
  }

  place_camera(view: Camera, aspect: number, time: number): void {
    const { camera } = this;
    const away = distance(view.eye, view.target);
    camera.position.set(...view.eye);
    camera.up.set(...view.up);
    camera.lookAt(...view.target);
    camera.fov = fitted_fov(view.vertical_fov, aspect);
    camera.aspect = aspect;
    camera.near = nearest * away;
    camera.far = this.planes.far + 4 * away;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    this.planes.update(this.run.motion, time, view.eye);
    this.water?.update(time, view.eye);
    this.sky.update(camera);
  }

  /** Into the viewport that is set. `height`: of it, pixels; `unit`: pixels of a unit of the screen. */
  draw(renderer: THREE.WebGLRenderer, time: number, view: { width: number; height: number; unit: number }): void {
    const { materials, uniforms, camera } = this;
    const { frame } = materials;
    frame.u_to_light.value.set(...this.size.to_light);
    materials.set_lights(this.run.scene.light);
    frame.u_fog.value = 1 / this.size.fog_distance ** 2;
    frame.u_pixel_size.value = (2 * Math.tan((camera.fov * Math.PI) / 360)) / view.height;
    frame.u_outline.value.set((2 * outline_width * view.unit) / view.width, (2 * outline_width * view.unit) / view.height);
    uniforms.u_view.value.set(view.width, view.height);
    uniforms.u_unit.value = view.unit;
    uniforms.u_near.value = 1.01 * camera.near;
    uniforms.u_times.value.set(Math.max(time - this.overlays.trail_time, -1e9), time);
    frame.u_shadow_texel.value = 0;
    this.shadow?.use(materials);
    renderer.render(this.scene, camera);
  }

  /** Before the viewport is set: shadows are drawn into a picture of their own. */
  draw_shadows(renderer: THREE.WebGLRenderer, time: number): void {
    if (!this.shadow || this.shadow_time === time) return;
    this.shadow.draw(renderer, this.scene, this.materials);
    this.shadow_time = time;
  }

  /** What the graphics card has forgotten is drawn again. */
  forget(): void {
    this.shadow_time = Number.NaN;
  }

  dispose(): void {
    for (const part of [this.solids, this.outline, this.planes, this.sky, ...this.occlusion, this.overlays, this.geometries]) part.dispose();
    this.shadow?.dispose();
    this.water?.dispose();
    for (const { set, geometries } of this.others.values()) {
      set.dispose();
      geometries.dispose();
    }
  }

  private update_others(time: number, others: { index: number; run: Run }[]): void {
    for (const { set } of this.others.values()) set.begin();
    for (const { index, run } of others) {
      let other = this.others.get(index);
      if (!other) {
        const geometries = new Geometries(run.scene.meshes, run.scene.bodies.length);
        other = { run, geometries, set: new BodySet(run.scene, geometries, this.materials.ghost, (mesh) => (mesh.renderOrder = 4)) };
        this.others.set(index, other);
        this.scene.add(other.set.group);
      }
      const { set } = other;
      const tint: Tint = { color: run_color(index), share: run_tint };
      each_pose(run, time, (body, { origin, rotation }) => {
        if (run.motion.kind(body) !== "still") set.add(body, origin, rotation, tint, run_opacity);
      });
    }
    for (const { set } of this.others.values()) set.end();
  }
}

export const run_color = (index: number): Vec3 => run_colors[index % run_colors.length];

function each_pose(run: Run, time: number, act: (body: number, pose: Pose) => void): void {
  const pose: Pose = { position: [0, 0, 0], origin: [0, 0, 0], rotation: [1, 0, 0, 0] };
  run.scene.bodies.forEach((body, index) => {
    if (body.visible && run.motion.shows(index, time)) act(index, run.motion.pose(index, time, pose));
  });
}
