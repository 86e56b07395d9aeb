// Energy, joints, impacts, contacts and loads of a run (src/page/table_data.h).
import { features, nobody, type ContactTable, type CrackMarks, type EnergyTable, type Impact, type JointMarks, type LoadTable, type Vec3 } from "./clip.ts";
import { sum_differences, type ArrayReference, type Container } from "./container.ts";
import type { ColumnReference, RunHeader } from "./header.ts";
import type { DecodedMotion } from "./motion.ts";
import type { BodyEvent } from "./track.ts";
import { cross, difference, moved, scaled, sum } from "./vectors.ts";

type Reader = Container<unknown>;

export function read_energy(run: RunHeader, reader: Reader): EnergyTable {
  const columns = Object.entries(run.energy).map(([name, array]) => [name, reader.doubles(array)]);
  return Object.fromEntries(columns);
}

export function read_joints(run: RunHeader, reader: Reader): Map<string, Float64Array> {
  return new Map(Object.entries(run.joints).map(([name, array]) => [name, reader.doubles(array)]));
}

/** When the impulse of an impact acts: at its time, or at the start of the step that resolves it. */
function acting_times(run: RunHeader, reader: Reader): Float64Array {
  const exact = reader.integers(run.impacts.exact);
  return reader.doubles(run.impacts.time).map((time, i) => (exact[i] === 1 ? time : time - run.settings.step));
}

/** The times when each body is struck; of the impacts of the table only, if there were too many. */
export function read_struck_times(run: RunHeader, reader: Reader): number[][] {
  const { struck } = run.motion;
  if (struck !== null) {
    const times = reader.doubles(struck.times);
    let next = 0;
    return Array.from(reader.integers(struck.counts), (count) => [...times.subarray(next, (next += count))]);
  }
  const all: number[][] = run.bodies.map(() => []);
  const time = acting_times(run, reader);
  for (const bodies of [reader.integers(run.impacts.a), reader.integers(run.impacts.b)])
    bodies.forEach((body, i) => all[body].push(time[i]));
  for (const times of all) times.sort((x, y) => x - y);
  return all;
}

export function read_impacts(run: RunHeader, reader: Reader, events: BodyEvent[][] | null, motion: DecodedMotion): Impact[] {
  const header = run.impacts;
  const whole = (array: ArrayReference) => reader.integers(array), real = (array: ArrayReference) => reader.doubles(array);
  const time = real(header.time), acts = acting_times(run, reader), exact = whole(header.exact), frame = whole(header.frame);
  const a = whole(header.a), b = whole(header.b), feature = whole(header.feature), pass = whole(header.pass);
  const [p, n, f] = [header.p, header.n, header.f].map((parts) => parts.map(real));
  const moments = new Map((header.moments ?? []).map(([row, x, y, z]): [number, Vec3] => [row, [x, y, z]]));
  const v_before = real(header.v_before), v_after = real(header.v_after);
  const restitution = real(header.restitution), impulse = real(header.impulse);
  const event_a = header.event_a && whole(header.event_a), event_b = header.event_b && whole(header.event_b);
  const pose = (body: number, event: number, at: number) => {
    const known = event >= 0 ? events?.[body][event] : undefined;
    if (known === undefined) return motion.place(body, at);
    return { position: known.before.position, rotation: known.before.rotation };
  };
  /** About the world origin, if the friction acts at the contact point too. */
  const moment_of = (i: number): Vec3 => {
    const at: Vec3 = [p[0][i], p[1][i], p[2][i]], normal: Vec3 = [n[0][i], n[1][i], n[2][i]];
    const friction: Vec3 = [f[0][i], f[1][i], f[2][i]], moment = cross(at, scaled(impulse[i], normal));
    return friction.every((x) => x === 0) ? moment : sum(moment, cross(at, friction));
  };
  return Array.from({ length: header.count }, (_, i): Impact => {
    const [mx, my, mz] = moments.get(i) ?? moment_of(i);
    return {
    time: time[i],
    exact: exact[i] === 1 ? 1 : 0,
    frame: frame[i],
    a: run.bodies[a[i]].name,
    b: run.bodies[b[i]].name,
    body_a: a[i],
    body_b: b[i],
    px: p[0][i], py: p[1][i], pz: p[2][i],
    nx: n[0][i], ny: n[1][i], nz: n[2][i],
    feature: features[feature[i]],
    v_before: v_before[i],
    v_after: v_after[i],
    restitution: restitution[i],
    impulse: impulse[i],
    fx: f[0][i], fy: f[1][i], fz: f[2][i],
    pass: pass[i],
    mx, my, mz,
    pose_a: pose(a[i], event_a ? event_a[i] : -1, acts[i]),
    pose_b: pose(b[i], event_b ? event_b[i] : -1, acts[i]),
    };
  });
}

const number_count = 12; // of a contact

export function read_contacts(run: RunHeader, reader: Reader): ContactTable {
  const header = run.contacts;
  const counts = reader.integers(header.counts);
  const steps_a = reader.integers(header.a), steps_b = reader.integers(header.b);
  const numbers = header.numbers.map((array) => reader.integers(array));
  const rows = steps_a.length;
  const table: ContactTable = {
    first: new Uint32Array(counts.length + 1),
    a: new Uint32Array(rows),
    b: new Uint32Array(rows),
    point: new Float32Array(3 * rows),
    normal: new Float32Array(3 * rows),
    normal_force: new Float32Array(rows),
    tangential_force: new Float32Array(3 * rows),
    state: new Uint8Array(rows),
    feature: new Uint8Array(rows),
  };
  // Rows of the same bodies are differences to those of the frame before, in their order.
  let before = new Map<number, number[]>();
  let row = 0;
  counts.forEach((count, frame) => {
    const now = new Map<number, number[]>();
    let a = 0, b = 0;
    for (const end = row + count; row < end; ++row) {
      a += steps_a[row];
      b += steps_b[row];
      const pair = (a + 1) * run.bodies.length + b;
      let same = now.get(pair);
      if (same === undefined) now.set(pair, (same = []));
      const reference = before.get(pair)?.[same.length];
      if (reference !== undefined) for (let k = 0; k < number_count; ++k) numbers[k][row] += numbers[k][reference];
      same.push(row);
      table.a[row] = a < 0 ? nobody : a;
      table.b[row] = b;
    }
    table.first[frame + 1] = row;
    before = now;
  });
  const [place, direction, force] = header.quanta;
  const force_of = (x: number) => force * (header.squares ? x * Math.abs(x) : x);
  for (let i = 0; i < rows; ++i) {
    for (let c = 0; c < 3; ++c) {
      table.point[3 * i + c] = place * numbers[c][i];
      table.normal[3 * i + c] = direction * numbers[3 + c][i];
      table.tangential_force[3 * i + c] = force_of(numbers[7 + c][i]);
    }
    table.normal_force[i] = force_of(numbers[6][i]);
    table.state[i] = numbers[10][i];
    table.feature[i] = numbers[11][i];
  }
  return table;
}

function read_column([quantum, order, array]: ColumnReference, reader: Reader): Float64Array {
  const values = reader.integers(array);
  sum_differences(values, order);
  return values.map((value) => quantum * value);
}

export function read_joint_marks(run: RunHeader, reader: Reader): JointMarks[] {
  return run.joint_marks.map((joint) => {
    const vectors = (references: ColumnReference[]) => {
      const columns = references.map((column) => read_column(column, reader));
      return (frame: number): Vec3 => [columns[0][frame], columns[1][frame], columns[2][frame]];
    };
    return { ...joint, states: reader.integers(joint.states), force: vectors(joint.force), torque: vectors(joint.torque) };
  });
}

export function read_cracks(run: RunHeader, reader: Reader): CrackMarks[] {
  if (!run.cracks) return [];
  const bodies = reader.integers(run.cracks.bodies), counts = reader.integers(run.cracks.counts);
  const places = reader.doubles(run.cracks.places);
  const all = places.length / 3;
  let next = 0;
  return Array.from(counts, (count, i): CrackMarks => ({
    whole: bodies[3 * i],
    pieces: [bodies[3 * i + 1], bodies[3 * i + 2]],
    outline: Array.from({ length: count }, (): Vec3 => [places[next], places[all + next], places[2 * all + next++]]),
  }));
}

/** Means over the frame that ends at a frame's time; of the first frame: the next one's, as nothing ends there. */
export function read_loads(run: RunHeader, reader: Reader, motion: DecodedMotion): LoadTable {
  const given = new Map<number, Float64Array[]>();
  for (const [body, columns] of run.loads) given.set(body, columns.map((column) => read_column(column, reader)));
  const shown = (frame: number) => Math.min(Math.max(frame, 1), run.frames - 1);
  const part = (body: number, frame: number, first: number): Vec3 | null => {
    const columns = given.get(body), n = shown(frame);
    return columns ? [columns[first][n], columns[first + 1][n], columns[first + 2][n]] : null;
  };
  const weight = (body: number) => scaled(run.bodies[body].mass, run.settings.gravity);
  return {
    force: (body, frame) => part(body, frame, 0) ?? weight(body),
    moment(body, frame) {
      const found = part(body, frame, 3);
      if (found !== null) return found;
      // Of the weight at the mean place: that of the cubic with both velocities.
      const n = shown(frame), span = 1 / run.fps;
      const from = motion.state(body, (n - 1) / run.fps), to = motion.state(body, n / run.fps);
      const middle = scaled(0.5, sum(from.position, to.position));
      return cross(moved(middle, -span / 12, difference(to.velocity, from.velocity)), weight(body));
    },
  };
}
