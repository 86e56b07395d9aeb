// Numbers of the symbols: of an impact, or of a body at a moment.
import type { Run, Vec3 } from "../data/clip.ts";
import { impulse_terms } from "../panels/impulse_equation.ts";
import { impulses_together } from "../panels/joint_impulses.ts";
import { add, cross, dot, inverse, rotation_matrix, scaled, subtract, transform, turned } from "../panels/linear.ts";
import { moment_at } from "../ui/moments.ts";
import type { Values } from "./evaluate.ts";

interface Velocities {
  v: Vec3;
  w: Vec3;
}

/** Of a body before the impulse of that index, which acts together with those of its pass, and after the earlier ones of its
 * moment. */
function velocities_before(run: Run, index: number, body: number): Velocities {
  const impact = run.impacts[index];
  const state = run.motion.state_before(body, impact.time);
  let { velocity: v, angular_velocity: w } = state;
  const together = new Set(impulses_together(run, index));
  for (let i = moment_at(run, impact.time)?.first ?? index; i < index; ++i)
    if (!together.has(i)) ({ v, w } = after_impulse(run, i, body, { v, w }));
  return { v, w };
}

function after_impulse(run: Run, index: number, body: number, { v, w }: Velocities): Velocities {
  const impact = run.impacts[index];
  if (impact.body_a !== body && impact.body_b !== body) return { v, w };
  const terms = impulse_terms(run, impact);
  const on_b = add(scaled(terms.n, terms.j), terms.f);
  const is_b = impact.body_b === body;
  const impulse = is_b ? on_b : scaled(on_b, -1);
  const [im, iI, r] = is_b ? [terms.imb, terms.iIb, terms.rb] : [terms.ima, terms.iIa, terms.ra];
  return { v: add(v, scaled(impulse, im)), w: add(w, transform(iI, cross(r, impulse))) };
}

/** Of the impulse alone in its moment the recorded velocities after it, else those that follow from the impulses together. */
function velocities_after(run: Run, index: number, body: number): Velocities {
  const impact = run.impacts[index];
  const moment = moment_at(run, impact.time);
  if (moment && moment.first === moment.last) {
    const { velocity, angular_velocity } = run.motion.state_after(body, impact.time);
    return { v: velocity, w: angular_velocity };
  }
  return impulses_together(run, index).reduce((state, i) => after_impulse(run, i, body, state), velocities_before(run, index, body));
}

const point_velocity = ({ v, w }: Velocities, r: Vec3): Vec3 => add(v, cross(w, r));

export function impact_values(run: Run, index: number): Values {
  const impact = run.impacts[index];
  const terms = impulse_terms(run, impact);
  const a = velocities_before(run, index, impact.body_a);
  const b = velocities_before(run, index, impact.body_b);
  const a_after = velocities_after(run, index, impact.body_a);
  const b_after = velocities_after(run, index, impact.body_b);
  return {
    ...terms,
    va: a.v, wa: a.w, vb: b.v, wb: b.w, vap: a_after.v, wap: a_after.w, vbp: b_after.v, wbp: b_after.w,
    ua: point_velocity(a, terms.ra), ub: point_velocity(b, terms.rb),
    uap: point_velocity(a_after, terms.ra), ubp: point_velocity(b_after, terms.rb),
  };
}

/** `before`: just before an impact at that time. */
export function moment_values(run: Run, time: number, body: number, before: boolean): Values {
  const { mass: m, inertia } = run.scene.bodies[body];
  const state = before ? run.motion.state_before(body, time) : run.motion.state(body, time);
  const { position: x, velocity: v, angular_velocity: w, momentum: P, angular_momentum: L, rotation } = state;
  // Loads are means over the frame that holds the time.
  const frame = Math.min(Math.max(Math.ceil(time * run.fps - 1e-6), 1), run.frames - 1);
  const F = run.loads.force(body, frame);
  const { gravity: g, step: h } = run.settings;
  return {
    t: time, h, g, x, v, w, P, L, m,
    R: rotation_matrix(rotation), I: turned(inertia, rotation), iI: turned(inverse(inertia), rotation),
    Ekin: (m * dot(v, v) + dot(w, L)) / 2, Epot: -m * dot(g, x),
    F, tau: subtract(run.loads.moment(body, frame), cross(x, F)),
  };
}
