// Pages of `tumble page`, and their player as `window.tumble` offers it.
import { join } from "node:path";
import type { Page } from "playwright-core";
import type { Quat, Vec3 } from "../src/data/clip.ts";
import { temporary_folder, tumble } from "./program.ts";

/** Makes a page of a scene file in the temporary folder, and returns its path. */
export function make_page(name: string, scene: string, ...options: (string | number)[]): string {
  const path = join(temporary_folder, `${name}.html`);
  tumble("page", scene, "-o", path, "--quiet", ...options);
  return path;
}

export interface ShownPose {
  position: Vec3;
  rotation: Quat;
}

/** The poses that a page shows at times, by time and then in the order of the names. */
export function shown_poses(page: Page, bodies: string[], times: number[]): Promise<ShownPose[][]> {
  return page.evaluate(([names, moments]) => moments.map((time) => {
    window.tumble.seek(time);
    return names.map((name) => {
      const { position, rotation } = window.tumble.pose(name);
      return { position: [...position], rotation: [...rotation] } as ShownPose;
    });
  }), [bodies, times] as const);
}

/** Radians between two rotations; exact for small ones, as an arc cosine is not. */
export function angle_between(p: Quat, q: Quat): number {
  const difference = (sign: number) => Math.hypot(...p.map((value, i) => value - sign * q[i]));
  return 4 * Math.asin(Math.min(difference(1), difference(-1)) / 2);
}

export function distance(a: Vec3, b: Vec3): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
