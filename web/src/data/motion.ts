// The motion of all bodies of a run: `Motion` of clip.ts.
import type { Body, BodyState, Motion, Pose, Quat, Vec3 } from "./clip.ts";
import type { ArrayReference, Container } from "./container.ts";
import { estimated_events } from "./estimated_events.ts";
import { channel_count, decode_frames } from "./frame_channels.ts";
import type { MotionHeader, RunHeader } from "./header.ts";
import { FreeSpin, type Moment } from "./segment.ts";
import { Track, type BodyEvent } from "./track.ts";
import { conjugate, difference, rotated, scaled, times } from "./vectors.ts";

export type Kind = "still" | "keys" | "frames";
type Reader = Container<unknown>;

const same_time = 1e-10; // s, of an impact's time given and known

/** Rows of a table whose columns are stored one after the other. */
class Rows {
  readonly count: number;
  readonly #values: Float64Array;
  constructor(reader: Reader, reference: ArrayReference, columns: number) {
    this.#values = reader.doubles(reference);
    this.count = this.#values.length / columns;
  }
  #value(row: number, column: number): number {
    return this.#values[column * this.count + row];
  }
  vector(row: number, column: number): Vec3 {
    return [this.#value(row, column), this.#value(row, column + 1), this.#value(row, column + 2)];
  }
  rotation(row: number): Quat {
    return [this.#value(row, 0), ...this.vector(row, 1)];
  }
  moment(row: number, time: number): Moment {
    return {
      time,
      rotation: this.rotation(row),
      position: this.vector(row, 4),
      velocity: this.vector(row, 7),
      angular_velocity: this.vector(row, 10),
    };
  }
}

/** By body. */
export function read_events(header: MotionHeader, step: number, reader: Reader): BodyEvent[][] | null {
  if (header.events === null) return null;
  const counts = reader.integers(header.events.counts), at = reader.doubles(header.events.times);
  const exact = reader.integers(header.events.exact);
  const rows = new Rows(reader, header.events.values, 19);
  let row = 0;
  return Array.from(counts, (count) =>
    Array.from({ length: count }, () => {
      const before = rows.moment(row, at[row]);
      const after = { ...before, velocity: rows.vector(row, 13), angular_velocity: rows.vector(row, 16) };
      const time = at[row], impact_time = exact[row++] === 1 ? time : time + step;
      return { time, impact_time, before, after };
    }),
  );
}

export class DecodedMotion implements Motion {
  readonly error: Motion["error"];
  readonly #bodies: Body[];
  readonly #kinds: Kind[] = [];
  readonly #tracks: Track[] = [];
  readonly #events: BodyEvent[][];
  readonly #asleep: Map<number, number[]>;
  readonly #absent: Map<number, number[]>;
  readonly #fps: number;
  readonly #duration: number;

  /** `events`: by body. `struck_at`: by body, the times when it is struck, for impacts without events. */
  constructor(run: RunHeader, reader: Reader, events: BodyEvent[][] | null, struck_at: number[][]) {
    this.error = run.motion.error;
    this.#bodies = run.bodies;
    this.#fps = run.fps;
    this.#duration = (run.frames - 1) / run.fps;
    this.#events = events ?? run.bodies.map(() => []);
    this.#asleep = new Map(run.motion.asleep);
    this.#absent = new Map(run.motion.absent ?? []);
    const add = (body: number, kind: Kind, moments: Moment[]) => {
      this.#kinds[body] = kind;
      const own = this.#events[body];
      const more = kind === "frames" && events === null;
      const all = more ? estimated_events(moments, struck_at[body], run.settings.gravity) : own;
      this.#tracks[body] = new Track(moments, all, new FreeSpin(run.bodies[body].inertia), kind === "keys");
    };
    this.#read_still(run.motion, reader, add);
    this.#read_keys(run.motion, reader, add);
    this.#read_frames(run.motion, reader, add);
  }

  #read_still(header: MotionHeader, reader: Reader, add: (body: number, kind: Kind, moments: Moment[]) => void): void {
    const rows = new Rows(reader, header.still.values, 13);
    header.still.bodies.forEach((body, row) => add(body, "still", [rows.moment(row, 0)]));
  }

  #read_keys(header: MotionHeader, reader: Reader, add: (body: number, kind: Kind, moments: Moment[]) => void): void {
    const counts = reader.integers(header.keys.counts), steps = reader.integers(header.keys.frames);
    const rows = new Rows(reader, header.keys.values, 13);
    let row = 0;
    header.keys.bodies.forEach((body, k) => {
      let frame = 0;
      const moments = Array.from({ length: counts[k] }, () => {
        frame += steps[row];
        return rows.moment(row++, frame / this.#fps);
      });
      add(body, "keys", moments);
    });
  }

  #read_frames(header: MotionHeader, reader: Reader, add: (body: number, kind: Kind, moments: Moment[]) => void): void {
    const { bodies, quanta } = header.frames;
    const orders = reader.integers(header.frames.orders), values = reader.integers(header.frames.values);
    const size = values.length / Math.max(1, bodies.length);
    bodies.forEach((body, k) => {
      const own = orders.subarray(k * channel_count, (k + 1) * channel_count);
      add(body, "frames", decode_frames(values.subarray(k * size, (k + 1) * size), own, quanta, this.#fps));
    });
  }

  kind(body: number): Kind {
    return this.#kinds[body];
  }

  state(body: number, time: number): BodyState {
    return this.#state_of(body, this.#tracks[body].moment(this.#clamped(time)));
  }

  state_before(body: number, time: number): BodyState {
    const event = this.#events[body].find((e) => Math.abs(e.impact_time - time) <= same_time);
    return event ? this.#state_of(body, event.before) : this.state(body, time);
  }

  state_after(body: number, time: number): BodyState {
    const event = this.#events[body].findLast((e) => Math.abs(e.impact_time - time) <= same_time);
    return event ? this.#state_of(body, event.after) : this.state(body, time);
  }

  pose(body: number, time: number, out: Pose): Pose {
    const { position, rotation } = this.#tracks[body].place(this.#clamped(time));
    out.position = position;
    out.rotation = rotation;
    out.origin = difference(position, rotated(rotation, this.#bodies[body].center_of_mass));
    return out;
  }

  shows(body: number, time: number): boolean {
    return !this.#absent.has(body) || !this.#within(this.#absent, body, this.#clamped(time));
  }

  place(body: number, time: number): { position: Vec3; rotation: Quat } {
    const { position, rotation } = this.#tracks[body].place(this.#clamped(time));
    return { position, rotation };
  }

  #clamped(time: number): number {
    return Math.min(Math.max(time, 0), this.#duration);
  }

  #state_of(body: number, moment: Moment): BodyState {
    const { inertia, center_of_mass } = this.#bodies[body];
    const { position, rotation, velocity, angular_velocity } = moment;
    const present = this.shows(body, moment.time) ? 1 : 0;
    return {
      position,
      origin: difference(position, rotated(rotation, center_of_mass)),
      rotation,
      velocity,
      angular_velocity,
      momentum: scaled(present * this.#bodies[body].mass, velocity),
      angular_momentum: scaled(present, rotated(rotation, times(inertia, rotated(conjugate(rotation), angular_velocity)))),
      asleep: this.#within(this.#asleep, body, moment.time),
    };
  }

  /** True if an odd number of the frames has come. */
  #within(spans: Map<number, number[]>, body: number, time: number): boolean {
    const frames = spans.get(body) ?? [];
    const frame = time * this.#fps + 1e-6;
    return frames.filter((n) => n <= frame).length % 2 === 1;
  }
}
