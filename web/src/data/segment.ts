// The motion of a body between two moments: the same equations as in src/page/motion_segment.h.
//
// The center moves along the cubic with the velocities of both ends: exact in free fall. The rotation is a uniform one
// from end to end, followed by a small one that has the angular velocities of both ends. Of "keys" it also has the angular
// accelerations of a torque-free body, by which it is of sixth order.
import type { Mat3, Quat, Vec3 } from "./clip.ts";
import { conjugate, cross, difference, dot, inverse, moved, norm, normalized, product, rotated, scaled, sum, times, turn_by, turn_of } from "./vectors.ts";

export interface Moment {
  /** s */
  time: number;
  /** Of the center of mass, m. */
  position: Vec3;
  rotation: Quat;
  velocity: Vec3;
  angular_velocity: Vec3;
}

const most_change = 1e-4; // of the angular momentum, of a torque-free body
const least_contradiction = 1e-5, contradiction = 0.04; // m; of the speed

/** Angular acceleration of a torque-free body. */
export class FreeSpin {
  readonly #inertia: Mat3;
  readonly #inverse: Mat3 | null;
  constructor(inertia: Mat3) {
    this.#inertia = inertia;
    this.#inverse = inverse(inertia);
  }
  /** Whether no torque has acted, as far as rounded velocities can tell. */
  is_free(start: Moment, end: Moment): boolean {
    const from = this.#momentum(start), to = this.#momentum(end);
    return norm(difference(to, from)) <= most_change * norm(from);
  }
  #momentum({ rotation, angular_velocity }: Moment): Vec3 {
    return rotated(rotation, times(this.#inertia, rotated(conjugate(rotation), angular_velocity)));
  }
  acceleration(moment: Moment): Vec3 {
    if (this.#inverse === null) return [0, 0, 0];
    const w = rotated(conjugate(moment.rotation), moment.angular_velocity);
    return rotated(moment.rotation, times(this.#inverse, cross(times(this.#inertia, w), w)));
  }
}

export class MotionSegment {
  readonly start: Moment;
  readonly end: Moment;
  readonly #span: number;
  readonly #velocities: [Vec3, Vec3];
  readonly #turn: Vec3;
  readonly #rates: [Vec3, Vec3];
  readonly #accelerations: [Vec3, Vec3] | null;

  /** `spin`: of a torque-free body; null: the angular accelerations are unknown. */
  constructor(start: Moment, end: Moment, spin: FreeSpin | null) {
    this.start = start;
    this.end = end;
    const span = (this.#span = end.time - start.time);
    // Velocities that contradict the way: an impact or a landing at an unknown time in between.
    const mean_velocity = scaled(1 / span, difference(end.position, start.position));
    const off = norm(difference(scaled(0.5, sum(start.velocity, end.velocity)), mean_velocity));
    const fastest = Math.max(norm(start.velocity), norm(end.velocity));
    const contradicts = span * off > least_contradiction && off > contradiction * fastest;
    this.#velocities = contradicts ? [mean_velocity, mean_velocity] : [start.velocity, end.velocity];
    this.#turn = whole_turn(start, end, span);
    const mean = scaled(1 / span, this.#turn);
    const back = turn_by(scaled(-1, this.#turn));
    this.#rates = [difference(start.angular_velocity, mean), difference(rotated(back, end.angular_velocity), mean)];
    this.#accelerations = spin && [
      difference(spin.acceleration(start), cross(mean, this.#rates[0])),
      difference(rotated(back, spin.acceleration(end)), cross(mean, this.#rates[1])),
    ];
  }

  position(time: number): Vec3 {
    const u = (time - this.start.time) / this.#span, v = 1 - u;
    const way = difference(this.end.position, this.start.position);
    const velocity = moved(scaled(v, this.#velocities[0]), -u, this.#velocities[1]);
    return moved(moved(this.start.position, u * u * (3 - 2 * u), way), this.#span * u * v, velocity);
  }

  rotation(time: number): Quat {
    const u = (time - this.start.time) / this.#span;
    return normalized(product(product(turn_by(scaled(u, this.#turn)), turn_by(this.#small(u)[0])), this.start.rotation));
  }

  at(time: number): Moment {
    const u = (time - this.start.time) / this.#span, v = 1 - u;
    const way = difference(this.end.position, this.start.position);
    const [v0, v1] = this.#velocities;
    const [small, rate] = this.#small(u);
    const bent = cross(small, rate);
    const uniform = turn_by(scaled(u, this.#turn));
    return {
      time,
      position: this.position(time),
      rotation: this.rotation(time),
      velocity: moved(moved(scaled((6 * u * v) / this.#span, way), v * (1 - 3 * u), v0), u * (1 - 3 * v), v1),
      angular_velocity: moved(
        rotated(uniform, moved(moved(rate, 0.5, bent), 1 / 6, cross(small, bent))),
        1 / this.#span,
        this.#turn,
      ),
    };
  }

  /** The small rotation as a rotation vector (rad), and its derivative by time. */
  #small(u: number): [Vec3, Vec3] {
    const v = 1 - u, span = this.#span;
    const [r0, r1] = this.#rates;
    if (this.#accelerations === null)
      return [
        scaled(span * u * v, moved(scaled(v, r0), -u, r1)),
        moved(scaled(v * (1 - 3 * u), r0), u * (1 - 3 * v), r1),
      ];
    const [a0, a1] = this.#accelerations;
    const u2 = u * u, v2 = v * v;
    const of_rates = moved(scaled(u * v2 * v * (1 + 3 * u), r0), -u2 * u * v * (1 + 3 * v), r1);
    const of_accelerations = moved(scaled(0.5 * u2 * v2 * v, a0), 0.5 * u2 * u * v2, a1);
    const rate = moved(scaled(v2 * (1 + 2 * u - 15 * u2), r0), u2 * (1 + 2 * v - 15 * v2), r1);
    const by_accelerations = moved(scaled(0.5 * u * v2 * (2 - 5 * u), a0), 0.5 * u2 * v * (3 - 5 * u), a1);
    return [moved(scaled(span, of_rates), span * span, of_accelerations), moved(rate, span, by_accelerations)];
  }
}

/** The rotation vector from start to end, with the whole turns that the angular velocities say. */
function whole_turn(start: Moment, end: Moment, span: number): Vec3 {
  const turn = turn_of(product(end.rotation, conjugate(start.rotation)));
  const expected = scaled(0.5 * span, sum(start.angular_velocity, end.angular_velocity));
  const angle = norm(turn), length = norm(expected);
  if (angle <= 1e-9 && length === 0) return turn;
  const axis = angle > 1e-9 ? scaled(1 / angle, turn) : scaled(1 / length, expected);
  const turns = Math.round((dot(axis, expected) - dot(axis, turn)) / (2 * Math.PI));
  return moved(turn, 2 * Math.PI * turns, axis);
}
