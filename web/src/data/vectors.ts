// The few operations on vectors and quaternions (w, x, y, z) that motion needs.
import type { Mat3, Quat, Vec3 } from "./clip.ts";

export const sum = (a: Vec3, b: Vec3): Vec3 => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const difference = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scaled = (s: number, a: Vec3): Vec3 => [s * a[0], s * a[1], s * a[2]];
/** a + s b */
export const moved = (a: Vec3, s: number, b: Vec3): Vec3 => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const norm = (a: Vec3): number => Math.sqrt(dot(a, a));
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const times = (m: Mat3, v: Vec3): Vec3 => [
  m[0] * v[0] + m[1] * v[1] + m[2] * v[2],
  m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
  m[6] * v[0] + m[7] * v[1] + m[8] * v[2],
];

export function inverse(m: Mat3): Mat3 | null {
  const [a, b, c, d, e, f, g, h, i] = m;
  const A = e * i - f * h, B = f * g - d * i, C = d * h - e * g;
  const determinant = a * A + b * B + c * C;
  if (determinant === 0) return null;
  const s = 1 / determinant;
  return [
    s * A, s * (c * h - b * i), s * (b * f - c * e),
    s * B, s * (a * i - c * g), s * (c * d - a * f),
    s * C, s * (b * g - a * h), s * (a * e - b * d),
  ];
}

export const product = (a: Quat, b: Quat): Quat => [
  a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
  a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
  a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
  a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
];
export const conjugate = (q: Quat): Quat => [q[0], -q[1], -q[2], -q[3]];

export function normalized(q: Quat): Quat {
  const s = 1 / Math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return [s * q[0], s * q[1], s * q[2], s * q[3]];
}

export function rotated(q: Quat, v: Vec3): Vec3 {
  const axis: Vec3 = [q[1], q[2], q[3]];
  const t = scaled(2, cross(axis, v));
  return sum(moved(v, q[0], t), cross(axis, t));
}

/** A rotation vector (rad) as a rotation. */
export function turn_by(turn: Vec3): Quat {
  const angle = norm(turn);
  if (angle === 0) return [1, 0, 0, 0];
  const s = Math.sin(0.5 * angle) / angle;
  return [Math.cos(0.5 * angle), s * turn[0], s * turn[1], s * turn[2]];
}

/** The rotation vector of a rotation, at most half a turn. */
export function turn_of(q: Quat): Vec3 {
  const sine = Math.sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (sine === 0) return [0, 0, 0];
  const sign = q[0] < 0 ? -1 : 1;
  return scaled((sign * 2 * Math.atan2(sine, sign * q[0])) / sine, [q[1], q[2], q[3]]);
}
