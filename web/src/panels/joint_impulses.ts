// Impulses that a law of impacts finds together: eq. 20 holds for one alone, and each contact has a row of the joint equations.
import type { Impact, Run, Vec3 } from "../data/clip.ts";
import { moments_of } from "../ui/moments.ts";
import { impulse_terms, type ImpulseTerms } from "./impulse_equation.ts";
import { add, cross, dot, scaled, subtract, transform } from "./linear.ts";

/** Indices of the impulses of the same moment and pass of the law that act on a dynamic body of this one, itself among them. */
export function impulses_together(run: Run, index: number): number[] {
  // The method of the notes takes one contact after the other.
  if (run.settings.method === "notes") return [index];
  const impact = run.impacts[index];
  const moment = moments_of(run).find((each) => each.first <= index && index <= each.last)!;
  const dynamic = [impact.body_a, impact.body_b].filter((body) => run.scene.bodies[body]?.type === "dynamic");
  const together: number[] = [];
  for (let i = moment.first; i <= moment.last; ++i) {
    const other = run.impacts[i];
    if (i === index || (other.pass === impact.pass && dynamic.some((body) => other.body_a === body || other.body_b === body))) together.push(i);
  }
  return together;
}

/** Impulse and moment about the center of mass of an impact on B of it. The moment has friction that acts beside the point. */
function load_on_b(impact: Impact, terms: ImpulseTerms, center: Vec3): { impulse: Vec3; turning: Vec3 } {
  const impulse = add(scaled(terms.n, terms.j), terms.f);
  return { impulse, turning: subtract([impact.mx, impact.my, impact.mz], cross(center, impulse)) };
}

/** Change of the relative velocity of one impact along its normal by another one, m/s. */
function share_of(own: Impact, terms: ImpulseTerms, other: Impact, other_terms: ImpulseTerms): number {
  let change = 0;
  for (const [body, sign, im, iI, r, x] of [
    [own.body_a, -1, terms.ima, terms.iIa, terms.ra, terms.xa],
    [own.body_b, 1, terms.imb, terms.iIb, terms.rb, terms.xb],
  ] as const) {
    const on = other.body_b === body ? 1 : other.body_a === body ? -1 : 0;
    if (on === 0) continue;
    const { impulse, turning } = load_on_b(other, other_terms, x);
    const point = add(scaled(impulse, im), cross(transform(iI, turning), r));
    change += sign * on * dot(terms.n, point);
  }
  return change;
}

export interface JointRow {
  /** Relative velocity along the normal before and after, as recorded, m/s. */
  before: number;
  after: number;
  /** By impulse: its index and what it adds, m/s. */
  shares: { index: number; share: number }[];
  /** |before + shares - after| over the largest of these numbers. */
  residual: number;
}

/** The row of an impulse: v_rel+ = v_rel- + the shares of all impulses that act together. */
export function joint_row(run: Run, index: number): JointRow {
  const own = run.impacts[index];
  const terms = impulse_terms(run, own);
  const shares = impulses_together(run, index).map((i) => ({ index: i, share: share_of(own, terms, run.impacts[i], impulse_terms(run, run.impacts[i])) }));
  const sum = shares.reduce((total, { share }) => total + share, own.v_before);
  const largest = Math.max(Math.abs(own.v_before), Math.abs(own.v_after), ...shares.map(({ share }) => Math.abs(share)));
  return { before: own.v_before, after: own.v_after, shares, residual: largest > 0 ? Math.abs(sum - own.v_after) / largest : 0 };
}
