// Quantities that plots show: those of `tumble plot --of`, and more of a body. Of joints those that the page has.
import type { BodyState, EnergyTable, Run, Vec3 } from "../data/clip.ts";
import { add, cross, dot, norm, transform, turned } from "./linear.ts";

export interface BodyQuantity {
  label: string;
  symbol: string;
  unit: string;
  value(run: Run, body: number, state: BodyState): number;
}

export interface SceneQuantity {
  label: string;
  unit: string;
  value(run: Run, frame: number): number;
}

const axes = ["x", "y", "z"];

function components(prefix: string, label: string, symbol: string, unit: string, vector: (state: BodyState) => Vec3): [string, BodyQuantity][] {
  return axes.map((axis, index) => [prefix + axis, {
    label: `${label} ${axis}`, symbol: `${symbol}${axis}`, unit, value: (_run, _body, state) => vector(state)[index],
  }]);
}

function rotation_energy(run: Run, body: number, state: BodyState): number {
  const inertia = turned(run.scene.bodies[body].inertia, state.rotation);
  return dot(state.angular_velocity, transform(inertia, state.angular_velocity)) / 2;
}

export function kinetic_energy(run: Run, body: number, state: BodyState): number {
  return (run.scene.bodies[body].mass * dot(state.velocity, state.velocity)) / 2 + rotation_energy(run, body, state);
}

/** Of gravity, zero at the world origin. */
export function potential_energy(run: Run, body: number, state: BodyState): number {
  return -run.scene.bodies[body].mass * dot(run.settings.gravity, state.position);
}

export const body_quantities = new Map<string, BodyQuantity>([
  ...axes.map((axis, index): [string, BodyQuantity] => [axis, {
    label: index === 1 ? "height y" : `position ${axis}`, symbol: axis, unit: "m", value: (_run, _body, state) => state.position[index],
  }]),
  ...components("v", "velocity", "v", "m/s", (state) => state.velocity),
  ["speed", { label: "speed", symbol: "|v|", unit: "m/s", value: (_run, _body, state) => norm(state.velocity) }],
  ...components("w", "angular velocity", "\u03c9", "rad/s", (state) => state.angular_velocity),
  ["spin", { label: "spin", symbol: "|\u03c9|", unit: "rad/s", value: (_run, _body, state) => norm(state.angular_velocity) }],
  ...components("p", "momentum", "P", "N s", (state) => state.momentum),
  ...components("l", "angular momentum", "L", "N m s", (state) => state.angular_momentum),
  ["kinetic", { label: "kinetic energy", symbol: "E", unit: "J", value: kinetic_energy }],
  ["potential", { label: "potential energy", symbol: "E", unit: "J", value: potential_energy }],
]);

function column(label: string, unit: string, of: (energy: EnergyTable, frame: number) => number): SceneQuantity {
  return { label, unit, value: (run, frame) => of(run.energy, frame) };
}

/** Over the dynamic bodies. */
function sum(run: Run, frame: number, of: (state: BodyState) => Vec3): Vec3 {
  let total: Vec3 = [0, 0, 0];
  for (const [index, body] of run.scene.bodies.entries()) {
    if (body.type === "dynamic") total = add(total, of(run.motion.state(index, frame / run.fps)));
  }
  return total;
}

export const scene_quantities = new Map<string, SceneQuantity>([
  ["kinetic", column("kinetic energy", "J", (e, i) => e.kinetic_linear[i] + e.kinetic_angular[i])],
  ["potential", column("potential energy", "J", (e, i) => e.potential[i])],
  ["total", column("total energy", "J", (e, i) => e.kinetic_linear[i] + e.kinetic_angular[i] + e.potential[i] + e.elastic[i])],
  ["momentum", { label: "total momentum |P|", unit: "N s", value: (run, frame) => norm(sum(run, frame, (state) => state.momentum)) }],
  ["angular-momentum", {
    label: "total angular momentum |L|", unit: "N m s",
    value: (run, frame) => norm(sum(run, frame, (state) => add(cross(state.position, state.momentum), state.angular_momentum))),
  }],
  ["contacts", column("contact points", "", (e, i) => e.contacts[i])],
  ["penetration", column("deepest overlap", "m", (e, i) => e.max_penetration[i])],
]);

interface JointQuantity {
  label: string;
  unit: string;
}

function joint_components(prefix: string, suffix: string, label: string, unit: string): [string, JointQuantity][] {
  return axes.map((axis) => [prefix + axis + suffix, { label: `${label} ${axis}`, unit }]);
}

const joint_quantities = new Map<string, JointQuantity>([
  ...joint_components("move_", "", "displacement", "m"),
  ...joint_components("turn_", "", "angle about", "rad"),
  ...joint_components("move_", "_speed", "speed along", "m/s"),
  ...joint_components("turn_", "_speed", "speed about", "rad/s"),
  ["force", { label: "force", unit: "N" }],
  ...joint_components("f", "", "force", "N"),
  ["torque", { label: "torque", unit: "N m" }],
  ...joint_components("t", "", "torque", "N m"),
  ["gap", { label: "gap", unit: "m" }],
]);

/** Of a column of `Run.joints`; the name of a joint may hold dots. */
export function joint_column(name: string): JointQuantity {
  const dot = name.lastIndexOf(".");
  const quantity = joint_quantities.get(name.slice(dot + 1));
  return { label: `${quantity?.label ?? name.slice(dot + 1)} of ${name.slice("joint.".length, dot)}`, unit: quantity?.unit ?? "" };
}

/** A plot: the stacked energies, a quantity of the scene, a column of a joint, or a quantity of a body. */
export type PlotSubject =
  | { kind: "energy" }
  | { kind: "scene"; quantity: string }
  | { kind: "joint"; quantity: string }
  | { kind: "body"; quantity: string; body: number };

/** Of a text as `--plot` has it; names that the clip lacks are left out. */
export function read_subjects(text: string, run: Run): PlotSubject[] {
  const subjects: PlotSubject[] = [];
  for (const item of text.split(",").map((each) => each.trim())) {
    if (item === "energy") subjects.push({ kind: "energy" });
    else if (scene_quantities.has(item)) subjects.push({ kind: "scene", quantity: item });
    else if (run.joints.has(item)) subjects.push({ kind: "joint", quantity: item });
    // Names of bodies may hold dots; quantities do not.
    const match = /^body\.(.+)\.([a-z]+)$/.exec(item);
    const body = match ? run.scene.bodies.findIndex((each) => each.name === match[1]) : -1;
    if (match && body >= 0 && body_quantities.has(match[2])) subjects.push({ kind: "body", quantity: match[2], body });
  }
  return subjects;
}
