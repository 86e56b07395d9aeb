// Vectors and rotations as the plain arrays of a clip.
import type { Mat3, Quat, Vec3 } from "../data/clip.ts";

export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scaled = (a: Vec3, s: number): Vec3 => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a: Vec3): number => Math.hypot(a[0], a[1], a[2]);
export const distance = (a: Vec3, b: Vec3): number => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** The zero vector stays what it is. */
export function normalized(a: Vec3): Vec3 {
  const size = length(a);
  return size > 0 ? scaled(a, 1 / size) : [0, 0, 0];
}

export function rotate([w, x, y, z]: Quat, v: Vec3): Vec3 {
  const t = scaled(cross([x, y, z], v), 2);
  return add(add(v, scaled(t, w)), cross([x, y, z], t));
}

export const conjugate = ([w, x, y, z]: Quat): Quat => [w, -x, -y, -z];
export const rotate_back = (q: Quat, v: Vec3): Vec3 => rotate(conjugate(q), v);

export function multiply([aw, ax, ay, az]: Quat, [bw, bx, by, bz]: Quat): Quat {
  return [
    aw * bw - ax * bx - ay * by - az * bz,
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
  ];
}

/** rad, 0 to pi. */
export function angle_between(a: Quat, b: Quat): number {
  const [w, x, y, z] = multiply(conjugate(a), b);
  return 2 * Math.atan2(Math.hypot(x, y, z), Math.abs(w));
}

/** Its columns are the axes of the rotated frame. */
export function rotation_matrix(q: Quat): Mat3 {
  const x = rotate(q, [1, 0, 0]);
  const y = rotate(q, [0, 1, 0]);
  const z = rotate(q, [0, 0, 1]);
  return [x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]];
}

export const clamp = (value: number, low: number, high: number): number => Math.min(Math.max(value, low), high);
