// The path of one body: moments in order of time, between which its motion is a segment.
import type { Vec3 } from "./clip.ts";
import { MotionSegment, type FreeSpin, type Moment } from "./segment.ts";

/** A body at an impact of it. */
export interface BodyEvent {
  /** s, when the body is there: the start of the step, where a step resolves the impact. */
  time: number;
  /** s, of the impact: the end of that step. */
  impact_time: number;
  before: Moment;
  after: Moment;
}

/** A moment with the velocities before and after it; `at`: at its time. */
interface Node {
  in: Moment;
  out: Moment;
  at: Moment;
}

const same_time = 1e-9; // s

export class Track {
  readonly #nodes: Node[];
  readonly #spin: FreeSpin;
  readonly #free: boolean;
  #segment: MotionSegment | null = null;

  /**
   * `free`: the body is torque-free between all moments; else each two are looked at.
   * `frames`: at frames, in order of time.
   */
  constructor(frames: Moment[], events: BodyEvent[], spin: FreeSpin, free: boolean) {
    this.#nodes = make_nodes(frames, events);
    this.#spin = spin;
    this.#free = free;
  }

  moment(time: number): Moment {
    const found = this.#find(time);
    return found instanceof MotionSegment ? found.at(time) : found;
  }

  /** Only position and rotation. */
  place(time: number): Pick<Moment, "position" | "rotation"> {
    const found = this.#find(time);
    return found instanceof MotionSegment ? { position: found.position(time), rotation: found.rotation(time) } : found;
  }

  #find(time: number): Moment | MotionSegment {
    const nodes = this.#nodes;
    const kept = this.#segment;
    if (kept !== null && kept.start.time < time && time < kept.end.time) return kept;
    if (time <= nodes[0].at.time) return nodes[0].at;
    let low = 0, high = nodes.length; // the last node not after the time is in [low, high)
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (nodes[middle].at.time <= time) low = middle;
      else high = middle;
    }
    if (low + 1 === nodes.length || nodes[low].at.time === time) return nodes[low].at;
    const start = nodes[low].out, end = nodes[low + 1].in;
    this.#segment = new MotionSegment(start, end, this.#free || this.#spin.is_free(start, end) ? this.#spin : null);
    return this.#segment;
  }
}

const with_velocities = (moment: Moment, velocity: Vec3, angular_velocity: Vec3): Moment => ({
  ...moment,
  velocity,
  angular_velocity,
});

/** Impacts at the time of the moment before add their velocities to that. */
function make_nodes(frames: Moment[], events: BodyEvent[]): Node[] {
  const nodes: Node[] = [];
  let last_is_frame = false, last_is_impact = false, next = 0;
  const add_impact = ({ time, impact_time, before, after }: BodyEvent) => {
    const exact = time === impact_time; // else the body is in its state before the impact until the step
    const last = nodes.at(-1);
    const near = last !== undefined && before.time - last.at.time <= (last_is_frame ? same_time : 0);
    if (!near) {
      nodes.push({ in: before, out: after, at: exact ? after : before });
      last_is_frame = false;
    } else {
      if (!last_is_impact) last.in = with_velocities(last.in, before.velocity, before.angular_velocity);
      last.out = with_velocities(last.out, after.velocity, after.angular_velocity);
      if (!last_is_frame && exact) last.at = last.out;
    }
    last_is_impact = true;
  };
  for (const frame of frames) {
    for (; next < events.length && events[next].time <= frame.time - same_time; ++next) add_impact(events[next]);
    nodes.push({ in: frame, out: frame, at: frame });
    last_is_frame = true;
    last_is_impact = false;
    for (; next < events.length && events[next].time <= frame.time + same_time; ++next) add_impact(events[next]);
  }
  return nodes;
}
