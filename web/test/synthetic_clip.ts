// A clip by closed forms, for tests that need no program: a ball bounces on a plane, a box lands flat beside it and spins on
// without friction. Two runs differ in the restitution of the ball.
import type {
  Body, BodyState, Clip, ContactTable, EnergyTable, Impact, Mat3, Motion, OverlaySettings, Pose, Quat, Run, Vec3,
} from "../src/data/clip.ts";

import { cross } from "../src/panels/linear.ts";

export const gravity = 9.81;
export const fps = 60;
export const frames = 181;
export const ball_radius = 0.25;
export const ball_mass = 1;
/** Of the lowest point of the ball above the plane, m. */
export const drop_height = 1.6;
export const box_size: Vec3 = [0.8, 0.4, 0.6];
export const box_mass = 2;
/** Of the lower face of the box above the plane, m. */
export const box_drop = 0.3;
/** rad/s, about the vertical. */
export const box_spin = 1.5;
/** A bounce that would be slower ends in rest, m/s. */
const slowest_bounce = 0.05;
const ball_x = -0.6;
const box_x = 0.8;
const bodies_index = { ground: 0, ball: 1, box: 2 };

interface Bounce {
  /** s. */
  time: number;
  /** Upward, m/s; 0: the ball rests. */
  speed_after: number;
}

/** Impacts of the ball: at the start it falls from drop_height. */
export function bounces(restitution: number, until: number): Bounce[] {
  const list: Bounce[] = [];
  let time = Math.sqrt((2 * drop_height) / gravity);
  let speed = gravity * time;
  while (time <= until && speed > 0) {
    const after = speed * restitution;
    list.push({ time, speed_after: after < slowest_bounce ? 0 : after });
    speed = list[list.length - 1].speed_after;
    time += (2 * speed) / gravity;
  }
  return list;
}

/** Height above its rest position and upward speed of the ball; `before` takes the state before an impact at that time. */
export function ball_at(restitution: number, time: number, before = false): { height: number; speed: number } {
  const passed = bounces(restitution, time).filter((bounce) => (before ? bounce.time < time : bounce.time <= time));
  const last = passed[passed.length - 1];
  if (!last) return { height: drop_height - (gravity * time * time) / 2, speed: -gravity * time };
  if (last.speed_after === 0) return { height: 0, speed: 0 };
  const t = time - last.time;
  return { height: last.speed_after * t - (gravity * t * t) / 2, speed: last.speed_after - gravity * t };
}

export const box_landing = Math.sqrt((2 * box_drop) / gravity);

export function box_at(time: number, before = false): { height: number; speed: number; angle: number } {
  const landed = before ? time > box_landing : time >= box_landing;
  return {
    height: landed ? 0 : box_drop - (gravity * time * time) / 2,
    speed: landed ? 0 : -gravity * time,
    angle: box_spin * time,
  };
}

const identity: Quat = [1, 0, 0, 0];
const about_y = (angle: number): Quat => [Math.cos(angle / 2), 0, Math.sin(angle / 2), 0];
const diagonal = (x: number, y: number, z: number): Mat3 => [x, 0, 0, 0, y, 0, 0, 0, z];
const ball_inertia = 0.4 * ball_mass * ball_radius ** 2;
const box_inertia = (a: number, b: number) => (box_mass / 12) * (a * a + b * b);
const box_inertia_y = box_inertia(box_size[0], box_size[2]);

function make_bodies(restitution: number): Body[] {
  const common = {
    visible: true, center_of_mass: [0, 0, 0] as Vec3, metallic: 0, friction: 0, roughness: 0.6, pattern: "panel" as const,
  };
  return [
    {
      ...common, name: "ground", type: "fixed", shape: { type: "plane", normal: [0, 1, 0], offset: 0 }, color: "#8a9199",
      roughness: 0.9, pattern: "grid", mass: 0, inertia: diagonal(0, 0, 0), restitution,
    },
    {
      ...common, name: "ball", type: "dynamic", shape: { type: "sphere", radius: ball_radius }, color: "#d95f3b",
      mass: ball_mass, inertia: diagonal(ball_inertia, ball_inertia, ball_inertia), restitution,
    },
    {
      ...common, name: "box", type: "dynamic", shape: { type: "box", size: box_size }, color: "#3b7dd9", mass: box_mass,
      inertia: diagonal(box_inertia(box_size[1], box_size[2]), box_inertia_y, box_inertia(box_size[0], box_size[1])),
      restitution: 0,
    },
  ];
}

function state_at(restitution: number, duration: number, body: number, wanted: number, before: boolean): BodyState {
  const time = Math.min(Math.max(wanted, 0), duration);
  const still: BodyState = {
    position: [0, 0, 0], origin: [0, 0, 0], rotation: identity, velocity: [0, 0, 0], angular_velocity: [0, 0, 0],
    momentum: [0, 0, 0], angular_momentum: [0, 0, 0], asleep: false,
  };
  if (body === bodies_index.ball) {
    const { height, speed } = ball_at(restitution, time, before);
    const position: Vec3 = [ball_x, ball_radius + height, 0];
    return { ...still, position, origin: [...position], velocity: [0, speed, 0], momentum: [0, ball_mass * speed, 0] };
  }
  if (body === bodies_index.box) {
    const { height, speed, angle } = box_at(time, before);
    const position: Vec3 = [box_x, box_size[1] / 2 + height, 0];
    return {
      ...still, position, origin: [...position], rotation: about_y(angle), velocity: [0, speed, 0],
      angular_velocity: [0, box_spin, 0], momentum: [0, box_mass * speed, 0],
      angular_momentum: [0, box_inertia_y * box_spin, 0],
    };
  }
  return still;
}

function make_motion(restitution: number, duration: number): Motion {
  return {
    state: (body, time) => state_at(restitution, duration, body, time, false),
    state_before: (body, time) => state_at(restitution, duration, body, time, true),
    state_after: (body, time) => state_at(restitution, duration, body, time, false),
    pose(body: number, time: number, out: Pose): Pose {
      const { position, origin, rotation } = state_at(restitution, duration, body, time, false);
      return Object.assign(out, { position, origin, rotation });
    },
    shows: () => true,
    kind: (body) => (body === bodies_index.ground ? "still" : "keys"),
    error: { position: 0, rotation: 0, velocity: 0, angular_velocity: 0 },
  };
}

/** Lower corners of the box in the world. */
export function box_corners(time: number): Vec3[] {
  const { height, angle } = box_at(time);
  return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([sx, sz]) => {
    const x = (sx * box_size[0]) / 2;
    const z = (sz * box_size[2]) / 2;
    return [box_x + x * Math.cos(angle) + z * Math.sin(angle), height, z * Math.cos(angle) - x * Math.sin(angle)];
  });
}

function make_impacts(motion: Motion, restitution: number, duration: number): Impact[] {
  const row = (time: number, body: number, point: Vec3, impulse: number, v: [number, number], e: number, feature: string) => {
    const pose = motion.state(body, time);
    const moment = cross(point, [0, impulse, 0]);
    return {
      time, exact: 1 as const, frame: Math.floor(time * fps), a: "ground", b: body === 1 ? "ball" : "box", body_a: 0,
      body_b: body, px: point[0], py: point[1], pz: point[2], nx: 0, ny: 1, nz: 0, feature, v_before: v[0], v_after: v[1],
      restitution: e, impulse, fx: 0, fy: 0, fz: 0, pass: 0, mx: moment[0], my: moment[1], mz: moment[2],
      pose_a: { position: [0, 0, 0] as Vec3, rotation: identity },
      pose_b: { position: pose.position, rotation: pose.rotation },
    };
  };
  const list: Impact[] = bounces(restitution, duration).map(({ time, speed_after }) => {
    const before = motion.state_before(bodies_index.ball, time).velocity[1];
    const impulse = ball_mass * (speed_after - before);
    return row(time, bodies_index.ball, [ball_x, 0, 0], impulse, [before, speed_after], restitution, "sphere");
  });
  const speed = -gravity * box_landing;
  for (const corner of box_corners(box_landing))
    list.push(row(box_landing, bodies_index.box, corner, (-speed * box_mass) / 4, [speed, 0], 0, "face-face"));
  return list.sort((one, other) => one.time - other.time);
}

function make_contacts(restitution: number): ContactTable {
  const first = new Uint32Array(frames + 1);
  const rows: { b: number; point: Vec3; force: number; feature: number }[] = [];
  for (let frame = 0; frame < frames; ++frame) {
    const time = frame / fps;
    const ball = ball_at(restitution, time);
    if (frame > 0 && ball.height === 0 && ball.speed === 0)
      rows.push({ b: bodies_index.ball, point: [ball_x, 0, 0], force: ball_mass * gravity, feature: 4 });
    if (time > box_landing)
      for (const point of box_corners(time))
        rows.push({ b: bodies_index.box, point, force: (box_mass * gravity) / 4, feature: 3 });
    first[frame + 1] = rows.length;
  }
  return {
    first,
    a: new Uint32Array(rows.length),
    b: Uint32Array.from(rows, (row) => row.b),
    point: Float32Array.from(rows.flatMap((row) => row.point)),
    normal: Float32Array.from(rows.flatMap(() => [0, 1, 0])),
    normal_force: Float32Array.from(rows, (row) => row.force),
    tangential_force: new Float32Array(3 * rows.length),
    state: Uint8Array.from(rows, (row) => (row.b === bodies_index.box ? 1 : 0)),
    feature: Uint8Array.from(rows, (row) => row.feature),
  };
}

function make_energy(motion: Motion, contacts: ContactTable, impacts: Impact[]): EnergyTable {
  const column = (value: (frame: number, time: number) => number) =>
    Float64Array.from({ length: frames }, (_, frame) => value(frame, frame / fps));
  const speed = (body: number, time: number) => motion.state(body, time).velocity[1];
  const height = (body: number, time: number) => motion.state(body, time).position[1];
  const loss = (impact: Impact) => {
    const mass = impact.body_b === bodies_index.ball ? ball_mass : box_mass / 4;
    return (mass / 2) * (impact.v_before ** 2 - impact.v_after ** 2);
  };
  return {
    kinetic_linear: column((_, t) => (ball_mass * speed(1, t) ** 2 + box_mass * speed(2, t) ** 2) / 2),
    kinetic_angular: column(() => (box_inertia_y * box_spin ** 2) / 2),
    potential: column((_, t) => gravity * (ball_mass * height(1, t) + box_mass * height(2, t))),
    elastic: column(() => 0),
    work: column(() => 0),
    impact_loss: column((_, t) => impacts.reduce((sum, impact) => sum + (impact.time <= t ? loss(impact) : 0), 0)),
    friction_loss: column(() => 0),
    contacts: column((frame) => contacts.first[frame + 1] - contacts.first[frame]),
    max_penetration: column(() => 0),
  };
}

function make_overlays(): OverlaySettings {
  return {
    show: ["contacts", "forces", "velocity"],
    bodies: [bodies_index.ball, bodies_index.box],
    scale: { force: 0.02, impulse: 0.1, velocity: 0.1, omega: 0.3, momentum: 0.1, "angular-momentum": 2, torque: 0.1 },
    color: {
      force: "#d62728", impulse: "#e377c2", velocity: "#1f77b4", omega: "#9467bd", momentum: "#2ca02c",
      "angular-momentum": "#8c564b", torque: "#ff7f0e",
    },
    impulse_time: 0.25,
    trail_time: Infinity,
    trail_points: [],
    ghost_every: 10,
    plot: "energy,body.ball.y",
  };
}

export function make_synthetic_run(restitution: number): Run {
  const duration = (frames - 1) / fps;
  const motion = make_motion(restitution, duration);
  const impacts = make_impacts(motion, restitution, duration);
  const contacts = make_contacts(restitution);
  const mass_of = (body: number) => (body === bodies_index.ball ? ball_mass : body === bodies_index.box ? box_mass : 0);
  return {
    label: `restitution ${restitution}`,
    duration, fps, pace: [], frames,
    settings: { impacts: "exact", method: "tumble", integrator: "exact", step: 1 / 240, gravity: [0, -gravity, 0] },
    scene: {
      bodies: make_bodies(restitution),
      cords: [],
      meshes: [], textures: [],
      light: { direction: [-0.4, -0.8, -0.45], shadows: true },
      environment: null,
      water: null,
      exposure: 0,
      tone: "filmic",
      camera_moves: false,
      camera: () => ({ eye: [1.6, 1.7, 4.2], target: [0, 0.75, 0], up: [0, 1, 0], vertical_fov: 40 }),
    },
    motion,
    energy: make_energy(motion, contacts, impacts),
    joints: new Map(),
    impacts,
    all_impacts: impacts.length,
    contacts,
    all_contacts: contacts.a.length,
    joint_marks: [],
    cracks: [],
    loads: {
      force: (body) => [0, -mass_of(body) * gravity, 0],
      moment(body, frame) {
        const [x, , z] = motion.state(body, frame / fps).position;
        const weight = -mass_of(body) * gravity;
        return [-z * weight, 0, x * weight];
      },
    },
    overlays: make_overlays(),
  };
}

export function make_synthetic_clip(): Clip {
  return {
    title: "A ball and a box",
    generator: "synthetic",
    sources: [{ name: "synthetic.toml", text: "# A ball bounces; a box lands flat and spins on.\nformat = 1\n" }],
    runs: [make_synthetic_run(0.5), make_synthetic_run(0.8)],
  };
}
