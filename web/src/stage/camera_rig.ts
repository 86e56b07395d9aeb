// From where the stage is seen: the scene's camera, moving with the clip, until the reader turns, moves or zooms the view.
import type { Camera, Motion, Scene, Vec3 } from "../data/clip.ts";
import { add, clamp, cross, dot, length, normalized, scaled, subtract } from "./math.ts";

/** Between the view direction and the vertical: the view never turns over, rad. */
const steepest = 0.02;
/** Width over height of a picture: in narrower ones the view widens, so that as much of the scene is seen. Scenes are composed for
 * 16:9, with some room at the sides. */
const composed_aspect = 1.5;

export interface MovingScene {
  scene: Scene;
  motion: Motion;
}

interface FreeView {
  target: Vec3;
  /** From the target to the eye. */
  offset: Vec3;
  up: Vec3;
  vertical_fov: number;
}

export class CameraRig {
  private free: FreeView | null = null;
  private followed: number | null = null;

  /** What the reader sees of a run. The followed body is that of the run. */
  view(run: MovingScene, time: number): Camera {
    const camera = run.scene.camera(time);
    if (!this.free && this.followed === null) return camera;
    const free = this.free ?? free_of(camera);
    const target = this.followed === null ? free.target : add(free.target, run.motion.state(this.followed, time).position);
    return { eye: add(target, free.offset), target, up: free.up, vertical_fov: free.vertical_fov };
  }

  reset(): void {
    this.free = null;
    this.followed = null;
  }

  /** The body comes to the middle of the picture and stays there; seen from where the view is. */
  follow(body: number | null, run: MovingScene, time: number): void {
    if (body === this.followed) return;
    const now = free_of(this.view(run, time));
    this.followed = body;
    this.free = body === null ? now : { ...now, target: [0, 0, 0] };
  }

  get follows(): number | null {
    return this.followed;
  }

  /** Radians about the target; positive turns the scene to the right, and down. */
  orbit(dx: number, dy: number, run: MovingScene, time: number): void {
    const free = this.take(run, time);
    const distance = length(free.offset);
    const up = normalized(free.up);
    const height = clamp(dot(free.offset, up) / distance, -1, 1);
    const polar = clamp(Math.acos(height) - dy, steepest, Math.PI - steepest);
    const level = subtract(free.offset, scaled(up, dot(free.offset, up)));
    const forth = length(level) > 1e-9 * distance ? normalized(level) : normalized(cross(up, [up[1], up[2], up[0]]));
    const side = cross(up, forth);
    const angle = -dx;
    const turned = add(scaled(forth, Math.cos(angle)), scaled(side, Math.sin(angle)));
    free.offset = scaled(add(scaled(turned, Math.sin(polar)), scaled(up, Math.cos(polar))), distance);
  }

  /** Factor of the distance; below 1: nearer. */
  zoom(factor: number, run: MovingScene, time: number): void {
    const free = this.take(run, time);
    free.offset = scaled(free.offset, clamp(factor, 0.01, 100));
  }

  /** Fractions of the height of the picture; positive moves the scene to the right, and down. */
  pan(dx: number, dy: number, run: MovingScene, time: number): void {
    const free = this.take(run, time);
    const forward = normalized(scaled(free.offset, -1));
    const right = normalized(cross(forward, free.up));
    const up = cross(right, forward);
    const height = 2 * length(free.offset) * Math.tan((free.vertical_fov * Math.PI) / 360);
    free.target = add(free.target, add(scaled(right, -dx * height), scaled(up, dy * height)));
  }

  private take(run: MovingScene, time: number): FreeView {
    if (this.free) return this.free;
    this.free = free_of(run.scene.camera(time));
    return this.free;
  }
}

function free_of({ eye, target, up, vertical_fov }: Camera): FreeView {
  return { target, offset: subtract(eye, target), up, vertical_fov };
}

/** Degrees. */
export function fitted_fov(vertical_fov: number, aspect: number): number {
  if (aspect >= composed_aspect) return vertical_fov;
  const half = Math.tan((vertical_fov * Math.PI) / 360) * (composed_aspect / aspect);
  return (Math.atan(half) * 360) / Math.PI;
}
