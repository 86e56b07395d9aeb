// Vectors and matrices of three, for the numbers that panels show.
import type { Body, Mat3, Quat, Vec3 } from "../data/clip.ts";

export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec3, b: Vec3): Vec3 =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const add = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scaled = (a: Vec3, factor: number): Vec3 => [a[0] * factor, a[1] * factor, a[2] * factor];
export const norm = (a: Vec3): number => Math.hypot(a[0], a[1], a[2]);

export const row = (m: Mat3, i: number): Vec3 => [m[3 * i], m[3 * i + 1], m[3 * i + 2]];
export const transform = (m: Mat3, v: Vec3): Vec3 => [dot(row(m, 0), v), dot(row(m, 1), v), dot(row(m, 2), v)];
export const transpose = (m: Mat3): Mat3 => [m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]];

export function multiply(a: Mat3, b: Mat3): Mat3 {
  const columns = transpose(b);
  return [0, 1, 2].flatMap((i) => [0, 1, 2].map((j) => dot(row(a, i), row(columns, j)))) as Mat3;
}

export function rotation_matrix([w, x, y, z]: Quat): Mat3 {
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
  ];
}

/** R I R^T. */
export function turned(inertia: Mat3, rotation: Quat): Mat3 {
  const r = rotation_matrix(rotation);
  return multiply(multiply(r, inertia), transpose(r));
}

/** Zero for the zero matrix: bodies that are not dynamic have no inverse inertia. */
export function inverse(m: Mat3): Mat3 {
  const c0 = cross(row(m, 1), row(m, 2));
  const determinant = dot(row(m, 0), c0);
  if (determinant === 0) return [0, 0, 0, 0, 0, 0, 0, 0, 0];
  const c1 = cross(row(m, 2), row(m, 0));
  const c2 = cross(row(m, 0), row(m, 1));
  return [c0[0], c1[0], c2[0], c0[1], c1[1], c2[1], c0[2], c1[2], c2[2]].map((value) => value / determinant) as Mat3;
}

export function inverse_mass(body: Body): number {
  return body.mass > 0 ? 1 / body.mass : 0;
}
