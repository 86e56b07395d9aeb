// decode_clip() against the tables of the program and closed forms. The program write_clip makes the data.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { test } from "node:test";
import type { Clip, Impact, Mat3, Quat, Run, Vec3 } from "../src/data/clip.ts";
import { contact_states, features, nobody } from "../src/data/clip.ts";
import { decode_clip } from "../src/data/decode_clip.ts";
import { conjugate, cross, difference, dot, inverse, norm, rotated, sum, times } from "../src/data/vectors.ts";
import { pick } from "../src/stage/pick.ts";
import { bouncing_height } from "./closed_forms.ts";
import { numbers, scenes_folder, table, temporary_folder, tumble, type Row } from "./program.ts";
import { tumble_path } from "./paths.mjs";
import { random_numbers } from "./random.ts";

const write_clip = join(dirname(tumble_path()), "tests/page/write_clip");
const skip = existsSync(write_clip) ? false : `there is no ${write_clip}`;

function scene_file(name: string, text: string): string {
  writeFileSync(join(temporary_folder, name), text);
  return join(temporary_folder, name);
}

interface Made {
  base64: string;
  clip: Clip;
  run: Run;
}

async function make(scene: string, ...set: string[]): Promise<Made> {
  const file = join(temporary_folder, "clip.b64");
  const made = spawnSync(write_clip, [file, scene, ...set], { encoding: "utf8" });
  assert.equal(made.status, 0, made.stderr);
  const base64 = readFileSync(file, "utf8");
  const clip = await decode_clip(base64);
  return { base64, clip, run: clip.runs[0] };
}

/** The tables of the same run. */
function simulate(scene: string, set: string[], ...tables: string[]): void {
  const options = set.flatMap((value) => ["--set", value]);
  tumble("simulate", scene, "--quiet", ...options, ...tables.flatMap((name) => [`--${name}`, `${name}.csv`]));
}

const vector = (row: Row, ...columns: string[]): Vec3 => numbers(row, ...columns) as Vec3;
const rotation_of = (row: Row): Quat => numbers(row, "qw", "qx", "qy", "qz") as Quat;

function angle_between(p: Quat, q: Quat): number {
  const chord = (sign: number) => Math.hypot(...p.map((x, i) => x - sign * q[i]));
  return 4 * Math.asin(Math.min(chord(1), chord(-1)) / 2);
}

const apart = (a: Vec3, b: Vec3) => norm(difference(a, b));

function at_most(found: number, most: number, text: string): void {
  assert.ok(found <= most, `${text}: ${found} is more than ${most}`);
}

interface Limits {
  position: number;
  rotation: number;
  velocity: number;
  angular_velocity: number;
}
const frame_limits: Limits = { position: 1e-6, rotation: 1e-5, velocity: 1e-3, angular_velocity: 2e-3 };

/** Compares all frames, and the stated errors with those found. */
function check_frames(run: Run, limits: Limits): void {
  const index = new Map(run.scene.bodies.map((body, i) => [body.name, i]));
  const worst = { position: 0, rotation: 0, velocity: 0, angular_velocity: 0 };
  for (const row of table("trajectory.csv")) {
    const state = run.motion.state(index.get(row.body)!, Number(row.frame) / run.fps);
    worst.position = Math.max(worst.position, apart(state.position, vector(row, "x", "y", "z")));
    worst.rotation = Math.max(worst.rotation, angle_between(state.rotation, rotation_of(row)));
    worst.velocity = Math.max(worst.velocity, apart(state.velocity, vector(row, "vx", "vy", "vz")));
    worst.angular_velocity = Math.max(worst.angular_velocity, apart(state.angular_velocity, vector(row, "wx", "wy", "wz")));
  }
  for (const key of ["position", "rotation", "velocity", "angular_velocity"] as const) {
    at_most(worst[key], limits[key], key);
    at_most(worst[key], 1.001 * run.motion.error[key] + 1e-13, `${key}, as stated`);
  }
}

const ball = (more: string) => `format = 1
[simulation]
duration = 3.0
${more}
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.5 }
position = [0.0, 4.0, 0.0]
restitution = 0.8
velocity = [1.0, 0.0, 0.0]
`;

test("a bouncing ball is where the closed form has it, at any time", { skip }, async () => {
  const { run } = await make(scene_file("ball.toml", ball('impacts = "exact"')));
  const random = random_numbers(1);
  assert.equal(run.motion.kind(1), "keys");
  for (let i = 0; i < 1000; ++i) {
    const time = 3 * random(), { position } = run.motion.state(1, time);
    at_most(Math.abs(position[1] - bouncing_height(4, 0.5, 0.8, time)), 1e-9, `height at ${time} s`);
    at_most(Math.abs(position[0] - time), 1e-9, `x at ${time} s`);
  }
});

test("many balls are right between frames too", { skip }, async () => {
  const grid = "grid = { count = [12, 1, 12], spacing = [1.5, 1.0, 1.5], jitter = 0.1 }\n";
  const text = ball('impacts = "exact"').replace("velocity = [1.0, 0.0, 0.0]\n", grid);
  const { run } = await make(scene_file("balls.toml", text));
  assert.equal(run.motion.kind(1), "frames");
  const random = random_numbers(2);
  for (let i = 0; i < 1000; ++i) {
    const time = 2.5 * random(), body = 1 + Math.floor(144 * random());
    const start = run.motion.state(body, 0).position[1];
    const { position } = run.motion.state(body, time);
    at_most(Math.abs(position[1] - bouncing_height(start, 0.5, 0.8, time)), 1e-6, `height of ball ${body} at ${time} s`);
  }
});

test("positions and rotations of demo scenes are those of the trajectory at each frame", { skip }, async () => {
  for (const [scene, ...set] of [
    ["bouncing_balls", "simulation.duration=2"],
    ["paddle", "simulation.duration=2"],
    ["paddle", "simulation.duration=2", "simulation.impacts='exact'"],
    ["tennis_racket"],
    ["furniture", "simulation.duration=2"],
  ]) {
    const file = join(scenes_folder, `${scene}.toml`);
    const { run } = await make(file, ...set);
    simulate(file, set, "trajectory");
    check_frames(run, frame_limits);
  }
});

const racket = `format = 1
[simulation]
duration = 4.0
gravity = [0.0, 0.0, 0.0]
impacts = "exact"
[[body]]
name = "racket"
shape = { type = "box", size = [0.4, 1.0, 0.1] }
velocity = [0.3, 0.1, -0.2]
angular_velocity = [6.0, 0.01, 0.02]
[[body]]
name = "disc"
position = [5.0, 0.0, 0.0]
shape = { type = "box", size = [1.0, 0.2, 1.0] }
angular_velocity = [1.0, 25.0, 2.0]
`;

test("free rotation is right between frames", { skip }, async () => {
  const file = scene_file("racket.toml", racket);
  const { run } = await make(file);
  simulate(file, ["output.fps=300", "simulation.steps_per_frame=1"], "trajectory");
  for (const row of table("trajectory.csv")) {
    const body = row.body === "racket" ? 0 : 1, state = run.motion.state(body, Number(row.time));
    at_most(apart(state.position, vector(row, "x", "y", "z")), 1e-7, `position at ${row.time} s`);
    at_most(angle_between(state.rotation, rotation_of(row)), 1e-5, `rotation of ${row.body} at ${row.time} s`);
    at_most(apart(state.angular_velocity, vector(row, "wx", "wy", "wz")), 1e-3, `spin at ${row.time} s`);
  }
});

const tumbling = `format = 1
[simulation]
duration = 1.5
impacts = "exact"
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "box"
shape = { type = "box", size = [1.0, 0.6, 0.8] }
position = [0.0, 2.0, 0.0]
rotation = { axis = [1, 2, 0.5], angle = 40 }
angular_velocity = [5.0, 2.0, -4.0]
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.3 }
position = [0.1, 4.0, 0.05]
`;

/** j of eq. 20 from the bodies' states before the impact. */
function impulse_of(run: Run, impact: Impact): number {
  const p: Vec3 = [impact.px, impact.py, impact.pz], n: Vec3 = [impact.nx, impact.ny, impact.nz];
  let speed = 0, denominator = 0;
  for (const [sign, body, pose] of [[-1, impact.body_a, impact.pose_a], [1, impact.body_b, impact.pose_b]] as const) {
    const { mass, inertia } = run.scene.bodies[body], before = run.motion.state_before(body, impact.time);
    assert.deepEqual(before.position, pose.position);
    const r = difference(p, pose.position);
    speed += sign * dot(n, sum(before.velocity, cross(before.angular_velocity, r)));
    if (mass === 0) continue;
    const turned = rotated(pose.rotation, times(inverse(inertia) as Mat3, rotated(conjugate(pose.rotation), cross(r, n))));
    denominator += 1 / mass + dot(n, cross(turned, r));
  }
  return (-(1 + impact.restitution) * speed) / denominator;
}

test("impacts are the rows of the table, and eq. 20 holds with the poses", { skip }, async () => {
  const file = scene_file("tumbling.toml", tumbling);
  for (const set of [[], ["simulation.impacts='stepped'"], ["simulation.method='notes'", "simulation.impacts='stepped'"]]) {
    const { run } = await make(file, ...set);
    simulate(file, set, "impacts");
    const rows = table("impacts.csv");
    assert.equal(run.impacts.length, rows.length);
    assert.ok(rows.length > 5);
    let alone = 0;
    rows.forEach((row, i) => {
      const impact = run.impacts[i];
      for (const [name, text] of Object.entries(row)) {
        const value = impact[name as keyof Impact];
        if (typeof value === "number") assert.equal(value + 0, Number(text) + 0, name);  // no -0
        else assert.equal(value, text, name);
      }
      if (rows.filter((other) => other.time === row.time).length > 1) return;
      ++alone;
      at_most(Math.abs(impulse_of(run, impact) / impact.impulse - 1), 1e-12, `impulse of row ${i}`);
      // The velocities after it.
      const n: Vec3 = [impact.nx, impact.ny, impact.nz], p: Vec3 = [impact.px, impact.py, impact.pz];
      const speed = [impact.body_a, impact.body_b].map((body) => {
        const after = run.motion.state_after(body, impact.time);
        return dot(n, sum(after.velocity, cross(after.angular_velocity, difference(p, after.position))));
      });
      at_most(Math.abs(speed[1] - speed[0] - impact.v_after), 1e-10, `speed after row ${i}`);
    });
    assert.ok(alone > 2);
  }
});

test("the energy table is that of the program", { skip }, async () => {
  const file = scene_file("ball.toml", ball("integrator = \"splitting\""));
  const { run } = await make(file);
  simulate(file, [], "energy");
  for (const row of table("energy.csv"))
    for (const [name, column] of Object.entries(run.energy)) {
      const value = Number(row[name]);
      at_most(Math.abs(column[Number(row.frame)] - value), 1e-12 * Math.abs(value), `${name} of frame ${row.frame}`);
    }
});

const resting = `format = 1
[simulation]
duration = 1.0
[wind]
velocity = [3.0, 0.0, 0.0]
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
friction = 0.5
[[body]]
name = "box"
shape = { type = "box", size = [1.0, 1.0, 1.0] }
position = [0.0, 0.6, 0.0]
friction = 0.5
velocity = [1.0, 0.0, 0.0]
[[force]]
body = "box"
force = [0.0, 0.0, 40.0]
end = 0.5
`;

test("contacts and loads are the rows of the tables", { skip }, async () => {
  const file = scene_file("resting.toml", resting);
  for (const set of [[], ["body.box.velocity=[0.0, 3.0, 0.0]"]]) {
    const { run } = await make(file, ...set);
    simulate(file, set, "contacts", "loads");
    const rows = table("contacts.csv"), contacts = run.contacts;
    assert.equal(contacts.a.length, rows.length);
    rows.forEach((row, i) => {
      const frame = Number(row.frame);
      assert.ok(contacts.first[frame] <= i && i < contacts.first[frame + 1], "frame");
      assert.equal(contacts.a[i] === nobody ? "" : run.scene.bodies[contacts.a[i]].name, row.a);
      assert.equal(run.scene.bodies[contacts.b[i]].name, row.b);
      const part = (values: Float32Array): Vec3 => [values[3 * i], values[3 * i + 1], values[3 * i + 2]];
      at_most(apart(part(contacts.point), vector(row, "px", "py", "pz")), 1e-5, "point");
      at_most(apart(part(contacts.normal), vector(row, "nx", "ny", "nz")), 1e-5, "normal");
      at_most(apart(part(contacts.tangential_force), vector(row, "fx", "fy", "fz")), 1e-2, "friction");
      at_most(Math.abs(contacts.normal_force[i] - Number(row.normal_force)), 1e-2, "normal force");
      assert.equal(contact_states[contacts.state[i]], row.state);
      assert.ok(features[contacts.feature[i]] !== undefined);
    });
    for (const row of table("loads.csv")) {
      const frame = Number(row.frame);
      if (frame === 0) continue;
      at_most(apart(run.loads.force(1, frame), vector(row, "fx", "fy", "fz")), 1e-2, `force of frame ${frame}`);
      at_most(apart(run.loads.moment(1, frame), vector(row, "mx", "my", "mz")), 5e-2, `moment of frame ${frame}`);
    }
  }
});

test("columns of joints are those that the plots name, with the numbers of the table", { skip }, async () => {
  const file = scene_file("rod.toml", `format = 1
[simulation]
duration = 0.5
[overlay]
plot = ["joint.hinge.turn_x", "joint.hinge.force", "energy"]
[[body]]
name = "rod"
shape = { type = "box", size = [1.0, 0.1, 0.1] }
position = [0.5, 2.0, 0.0]
[[joint]]
name = "hinge"
type = "hinge"
bodies = ["world", "rod"]
anchor = [0.0, 2.0, 0.0]
axis = [0.0, 0.0, 1.0]
`);
  const { run } = await make(file);
  simulate(file, [], "joints");
  assert.deepEqual([...run.joints.keys()].sort(), ["joint.hinge.force", "joint.hinge.turn_x"]);
  const angle = run.joints.get("joint.hinge.turn_x")!, force = run.joints.get("joint.hinge.force")!;
  const rows = table("joints.csv");
  assert.equal(angle.length, rows.length);
  rows.forEach((row, frame) => {
    at_most(Math.abs(angle[frame] - Number(row.turn_x)), 1e-11, `angle of frame ${frame}`);
    // No frame ends at the first one: it has the force of the next.
    at_most(Math.abs(force[frame] - norm(vector(rows[Math.max(frame, 1)], "fx", "fy", "fz"))), 1e-9, `force of frame ${frame}`);
  });
});

test("forces that cancel have a moment", { skip }, async () => {
  const force = (point: number, z: number) => `[[force]]\nbody = "bar"\npoint = [${point}, 0.0, 0.0]\nforce = [0.0, 0.0, ${z}]\nframe = "body"\n`;
  const { run } = await make(scene_file("couple.toml", `format = 1
[simulation]
duration = 0.5
gravity = [0.0, 0.0, 0.0]
[[body]]
name = "bar"
shape = { type = "box", size = [1.4, 0.2, 0.2] }
${force(0.6, -0.6)}${force(-0.6, 0.6)}`));
  for (let frame = 1; frame < run.frames; ++frame) {
    at_most(norm(run.loads.force(0, frame)), 1e-9, "force");
    at_most(apart(run.loads.moment(0, frame), [0, 0.72, 0]), 1e-6, "moment");
  }
});

test("a hundred bodies for five seconds take at most 500 kB", { skip }, async () => {
  const { base64, run } = await make(join(scenes_folder, "falling_boxes.toml"));
  assert.equal(run.scene.bodies.filter((body) => body.type === "dynamic").length, 100);
  assert.equal(run.duration, 5);
  at_most(base64.length, 500e3, "characters");
});

test("damaged data is refused in words", { skip }, async () => {
  const { base64 } = await make(scene_file("ball.toml", ball("")));
  await assert.rejects(decode_clip("%%%"), /not base64/);
  await assert.rejects(decode_clip(base64.slice(0, base64.length / 2 - (base64.length / 2) % 4)), /incomplete or damaged/);
  await assert.rejects(decode_clip(btoa("nonsense")), /damaged/);
});

// A ball breaks a bar that floats.
const breaking = `format = 1
[simulation]
duration = 0.5
gravity = [0.0, 0.0, 0.0]
[[body]]
name = "bar"
shape = { type = "box", size = [2.0, 0.1, 0.1] }
density = 1000.0
strength = 1e5
stiffness = 1e9
velocity = [0.0, 0.5, 0.0]
fracture = { cells = 4, pattern = "slabs", seed = 2 }
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.2 }
position = [0.9, 1.0, 0.0]
velocity = [0.0, -8.0, 0.0]
`;

test("a body shows until it breaks and its pieces from then on, with all of the momentum", { skip }, async () => {
  const file = scene_file("breaking.toml", breaking);
  const { run } = await make(file);
  simulate(file, [], "breaks");
  const breaks_at = Number(table("breaks.csv")[0].time);
  const { bodies } = run.scene, { motion } = run;
  const shown = (time: number) => bodies.filter((_, i) => motion.shows(i, time)).map((body) => body.name);
  const pieces = bodies.map((body) => body.name).filter((name) => name.startsWith("bar/"));
  assert.equal(pieces.length, 4);
  assert.deepEqual(shown(0), ["bar", "ball"]);
  assert.deepEqual(shown(breaks_at - 1 / run.fps), ["bar", "ball"]);
  assert.deepEqual(shown(breaks_at + 1 / run.fps).sort(), ["ball", ...pieces].sort());
  const momentum = (time: number) => bodies.reduce<Vec3>((total, _, i) => sum(total, motion.state(i, time).momentum), [0, 0, 0]);
  assert.ok(norm(momentum(0)) > 100);
  for (const time of [breaks_at - 1 / run.fps, breaks_at + 1 / run.fps, 0.5])
    at_most(apart(momentum(time), momentum(0)), 0.1, `momentum at ${time} s`);
  assert.deepEqual(run.cracks.map(({ pieces }) => pieces.map((piece) => bodies[piece].name)),
    [["bar/0", "bar/1"], ["bar/1", "bar/2"], ["bar/2", "bar/3"]]);
  for (const { outline } of run.cracks) {
    assert.equal(outline.length, 5);
    for (const [x, y, z] of outline) at_most(Math.hypot(x - outline[0][0], Math.abs(y) - 0.05, Math.abs(z) - 0.05), 1e-6, "corner");
  }
  const first = bodies.findIndex((body) => body.name === "bar/0");
  const picked = (time: number) => {
    const [x, y] = motion.state(first, time).position;
    return bodies[pick(run, time, { from: [x, y, 5], way: [0, 0, -1] })!].name;
  };
  assert.deepEqual([picked(0), picked(breaks_at + 1 / run.fps)], ["bar", "bar/0"]);
});
