// Eq. 20 of the notes, the impulse of a contact, with the numbers of an impact. No elements: lessons use it too.
import type { Impact, Mat3, Run, Vec3 } from "../data/clip.ts";
import { cross, dot, inverse, inverse_mass, subtract, transform, turned } from "./linear.ts";

export interface ImpulseTerms {
  t: number;
  /** Point and unit normal, from A to B. */
  p: Vec3;
  n: Vec3;
  /** Arms from the centers of mass to the point. */
  ra: Vec3;
  rb: Vec3;
  xa: Vec3;
  xb: Vec3;
  /** Relative velocity along n before and after the impulse, m/s. */
  vrel: number;
  vrelp: number;
  e: number;
  /** Recorded, N s. */
  j: number;
  /** Friction impulse on B, N s. */
  f: Vec3;
  ma: number;
  mb: number;
  ima: number;
  imb: number;
  /** World frame. */
  Ia: Mat3;
  Ib: Mat3;
  iIa: Mat3;
  iIb: Mat3;
}

export function impulse_terms(run: Run, impact: Impact): ImpulseTerms {
  const a = run.scene.bodies[impact.body_a];
  const b = run.scene.bodies[impact.body_b];
  const p: Vec3 = [impact.px, impact.py, impact.pz];
  return {
    t: impact.time, p, n: [impact.nx, impact.ny, impact.nz],
    ra: subtract(p, impact.pose_a.position), rb: subtract(p, impact.pose_b.position),
    xa: impact.pose_a.position, xb: impact.pose_b.position,
    vrel: impact.v_before, vrelp: impact.v_after, e: impact.restitution, j: impact.impulse,
    f: [impact.fx, impact.fy, impact.fz],
    ma: a.mass, mb: b.mass, ima: inverse_mass(a), imb: inverse_mass(b),
    Ia: turned(a.inertia, impact.pose_a.rotation), Ib: turned(b.inertia, impact.pose_b.rotation),
    iIa: turned(inverse(a.inertia), impact.pose_a.rotation), iIb: turned(inverse(b.inertia), impact.pose_b.rotation),
  };
}

/** n . ((I^-1 (r x force)) x r), the velocity along n that a unit of turning gives the point. */
function turning(inverse_inertia: Mat3, r: Vec3, force: Vec3, n: Vec3): number {
  return dot(n, cross(transform(inverse_inertia, cross(r, force)), r));
}

export interface ImpulseEquation {
  /** -(1 + e) v_rel. */
  numerator: number;
  /** Change of v_rel by the friction impulse, which acts at the same time, m/s. */
  friction: number;
  /** Its four terms: 1/m and turning, of A and of B, 1/kg. */
  denominator: { mass_a: number; mass_b: number; turn_a: number; turn_b: number; sum: number };
  /** N s. */
  j: number;
  /** |j - recorded| over the larger of them. */
  residual: number;
}

export function solve_impulse(terms: ImpulseTerms): ImpulseEquation {
  const { n, ra, rb, iIa, iIb, f } = terms;
  const turn_a = turning(iIa, ra, n, n);
  const turn_b = turning(iIb, rb, n, n);
  const sum = terms.ima + terms.imb + turn_a + turn_b;
  const numerator = -(1 + terms.e) * terms.vrel;
  const friction = (terms.ima + terms.imb) * dot(n, f) + turning(iIa, ra, f, n) + turning(iIb, rb, f, n);
  const j = (numerator - friction) / sum;
  const largest = Math.max(Math.abs(j), Math.abs(terms.j));
  return {
    numerator, friction, denominator: { mass_a: terms.ima, mass_b: terms.imb, turn_a, turn_b, sum }, j,
    residual: largest > 0 ? Math.abs(j - terms.j) / largest : 0,
  };
}
