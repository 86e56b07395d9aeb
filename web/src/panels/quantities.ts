// Quantities that plots show: those of `tumble plot --of`, and more of a body. Of joints those that the page has.
import texts from "../../../src/quantities/quantity_texts.json";
import type { BodyState, EnergyTable, Run, Vec3 } from "../data/clip.ts";
import { term_of, text_of } from "../texts/texts.ts";
import { add, cross, dot, norm, transform, turned } from "./linear.ts";

export interface BodyQuantity {
  label: string;
  unit: string;
  value(run: Run, body: number, state: BodyState): number;
}

export interface SceneQuantity {
  label: string;
  unit: string;
  value(run: Run, frame: number): number;
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

const of_state = (value: (state: BodyState) => number): BodyQuantity["value"] => (_run, _body, state) => value(state);
const components = (prefix: string, vector: (state: BodyState) => Vec3) =>
  Object.fromEntries(["x", "y", "z"].map((axis, index) => [prefix + axis, of_state((state) => vector(state)[index])]));
const body_values: Record<string, BodyQuantity["value"]> = {
  ...components("", (state) => state.position),
  ...components("v", (state) => state.velocity),
  speed: of_state((state) => norm(state.velocity)),
  ...components("w", (state) => state.angular_velocity),
  spin: of_state((state) => norm(state.angular_velocity)),
  ...components("p", (state) => state.momentum),
  ...components("l", (state) => state.angular_momentum),
  kinetic: kinetic_energy,
  potential: potential_energy,
};
export const body_quantities = new Map<string, BodyQuantity>([...texts.body_quantities, ...texts.page_body_quantities].map(
  ({ name, title, unit }) => [name, { label: term_of(title), unit, value: body_values[name] }]));

/** Over the dynamic bodies. */
function sum(run: Run, frame: number, of: (state: BodyState) => Vec3): Vec3 {
  let total: Vec3 = [0, 0, 0];
  for (const [index, body] of run.scene.bodies.entries()) {
    if (body.type === "dynamic") total = add(total, of(run.motion.state(index, frame / run.fps)));
  }
  return total;
}

const column = (of: (energy: EnergyTable, frame: number) => number): SceneQuantity["value"] => (run, frame) => of(run.energy, frame);
const scene_values: Record<string, SceneQuantity["value"]> = {
  kinetic: column((e, i) => e.kinetic_linear[i] + e.kinetic_angular[i]),
  potential: column((e, i) => e.potential[i]),
  total: column((e, i) => e.kinetic_linear[i] + e.kinetic_angular[i] + e.potential[i] + e.elastic[i]),
  momentum: (run, frame) => norm(sum(run, frame, (state) => state.momentum)),
  "angular-momentum": (run, frame) => norm(sum(run, frame, (state) => add(cross(state.position, state.momentum), state.angular_momentum))),
  contacts: column((e, i) => e.contacts[i]),
  penetration: column((e, i) => e.max_penetration[i]),
};
export const scene_quantities = new Map<string, SceneQuantity>(texts.scene_quantities.map(
  ({ name, title, unit }) => [name, { label: term_of(title), unit, value: scene_values[name] }]));

/** Of a column of `Run.joints`; the name of a joint may hold dots. */
export function joint_column(name: string): { label: string; unit: string } {
  const dot = name.lastIndexOf("."), quantity = name.slice(dot + 1);
  const { axis, unit } = texts.joint_quantities.find((each) => each.name === quantity) ?? { axis: quantity, unit: "" };
  return { label: text_of("quantity_of", { quantity: term_of(axis), whose: name.slice("joint.".length, dot) }), unit };
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
