// The arrows of a lesson's symbols: of equation 20 at an impact, or of the state of a body at a moment.
import type { BodyState, Impact, Run, Vec3 } from "../data/clip.ts";
import { bytes, from_text } from "./color.ts";
import { add, cross, length, rotate, scaled, subtract } from "./math.ts";
import { empty_frame, type OverlayFrame } from "./overlay_frame.ts";
import { axial, style } from "./overlay_style.ts";
import type { SceneSize } from "./scene_size.ts";

export interface SymbolRequest {
  name: string;
  impact?: Impact;
  body?: number;
}

const width = 5.5;
const lever_color = bytes(255, 222, 90);
const mark_color = bytes(255, 255, 255);
const tint = { color: bytes(255, 200, 40), share: 0.45 };
/** Of the viewing distance: arrows of quantities without a scale, such as a normal. */
const plain_length = 0.09;

class Drawing {
  readonly frame: OverlayFrame = empty_frame();
  constructor(
    readonly run: Run,
    readonly size: SceneSize,
  ) {}

  arrow(from: Vec3, way: Vec3, color: Vec3, text: string, double_head = false): void {
    if (!(length(way) > 0)) return this.point(from, `${text} = 0`);
    const to = add(from, way);
    this.frame.arrows.push({ overlay: "highlight", from, to, color, opacity: 1, width, double_head, allowance: Infinity });
    this.frame.labels.push({ at: to, text, color: null });
  }

  /** In the scale and the color of a quantity. */
  quantity(kind: keyof Run["overlays"]["scale"], from: Vec3, value: Vec3, text: string): void {
    const { scale, color } = this.run.overlays;
    this.arrow(from, scaled(value, scale[kind]), from_text(color[kind]), text, axial.has(kind));
  }

  point(at: Vec3, text: string): void {
    this.frame.markers.push({ overlay: "highlight", at, color: mark_color, form: "disc", radius: 6, allowance: Infinity });
    this.frame.labels.push({ at, text, color: null });
  }

  body(index: number, text: string): void {
    this.frame.tints.set(index, tint);
    const { position } = this.run.motion.state(index, 0);
    if (text) this.frame.labels.push({ at: position, text, color: null });
  }

  get plain(): number {
    return plain_length * this.size.viewing_distance;
  }
}

/** Null if the symbol has no picture. */
export function draw_symbol(run: Run, size: SceneSize, time: number, request: SymbolRequest): OverlayFrame | null {
  const name = request.name.replace(/[\\_^{}\s]/g, "");
  const drawing = new Drawing(run, size);
  const impact = request.impact ?? impact_near(run, time, request.body);
  const body = request.body ?? run.overlays.bodies[0];
  const of_impact = impact_symbols[name];
  const of_body = body_symbols[name];
  // A symbol of both kinds belongs to the impact only if an impact is asked for.
  if (of_impact && impact && (request.impact || !of_body)) of_impact(drawing, impact);
  else if (of_body && body !== undefined) of_body(drawing, body, run.motion.state(body, time), time);
  else return null;
  return drawing.frame;
}

function impact_near(run: Run, time: number, body: number | undefined): Impact | undefined {
  let best: Impact | undefined;
  for (const impact of run.impacts) {
    if (body !== undefined && impact.body_a !== body && impact.body_b !== body) continue;
    if (!best || Math.abs(impact.time - time) < Math.abs(best.time - time)) best = impact;
  }
  return best;
}

const place = (impact: Impact): Vec3 => [impact.px, impact.py, impact.pz];
const normal = (impact: Impact): Vec3 => [impact.nx, impact.ny, impact.nz];
const side = (impact: Impact, b: boolean) => ({
  body: b ? impact.body_b : impact.body_a,
  pose: b ? impact.pose_b : impact.pose_a,
  letter: b ? "b" : "a",
});
type ImpactSymbol = (drawing: Drawing, impact: Impact) => void;

const relative = (text: string, value: (impact: Impact) => number): ImpactSymbol => (drawing, impact) =>
  drawing.quantity("velocity", place(impact), scaled(normal(impact), value(impact)), text);

const lever = (b: boolean): ImpactSymbol => (drawing, impact) => {
  const { pose, letter } = side(impact, b);
  drawing.arrow(pose.position, subtract(place(impact), pose.position), lever_color, `r${sub(letter)}`);
};

const center = (b: boolean): ImpactSymbol => (drawing, impact) => {
  const { pose, letter } = side(impact, b);
  drawing.point(pose.position, `x${sub(letter)}`);
};

const moving = (b: boolean, after: boolean, what: "v" | "ω" | "ṗ"): ImpactSymbol => (drawing, impact) => {
  const { body, pose, letter } = side(impact, b);
  const { motion } = drawing.run;
  const state = after ? motion.state(body, impact.time) : motion.state_before(body, impact.time);
  const text = `${what}${sub(letter)}${after ? "⁺" : ""}`;
  if (what === "v") return drawing.quantity("velocity", pose.position, state.velocity, text);
  if (what === "ω") return drawing.quantity("omega", pose.position, state.angular_velocity, text);
  const at = place(impact);
  const lever_arm = subtract(at, pose.position);
  drawing.quantity("velocity", at, add(state.velocity, cross(state.angular_velocity, lever_arm)), text);
};

const whole = (b: boolean, text: string): ImpactSymbol => (drawing, impact) => {
  const { body, pose, letter } = side(impact, b);
  drawing.body(body, "");
  drawing.frame.labels.push({ at: pose.position, text: `${text}${sub(letter)}`, color: null });
};

const sub = (letter: string) => `_${letter}`;

const draw_normal: ImpactSymbol = (drawing, impact) =>
  drawing.arrow(place(impact), scaled(normal(impact), drawing.plain), style.normal_color, "n̂");
const draw_impulse: ImpactSymbol = (drawing, impact) =>
  drawing.quantity("impulse", place(impact), scaled(normal(impact), impact.impulse), "j n̂");

const impact_symbols: Record<string, ImpactSymbol> = {
  p: (drawing, impact) => drawing.point(place(impact), "p"),
  n: draw_normal,
  nhat: draw_normal,
  j: draw_impulse,
  jn: draw_impulse,
  f: (drawing, impact) => drawing.quantity("impulse", place(impact), [impact.fx, impact.fy, impact.fz], "f"),
  vrel: relative("v_rel", (impact) => impact.v_before),
  vrelm: relative("v_rel⁻", (impact) => impact.v_before),
  vrelp: relative("v_rel⁺", (impact) => impact.v_after),
  eps: (drawing, impact) => {
    draw_normal(drawing, impact);
    drawing.frame.labels.length = 0;
    drawing.frame.labels.push({ at: place(impact), text: `ε = ${impact.restitution}`, color: null });
  },
  ra: lever(false), rb: lever(true),
  xa: center(false), xb: center(true),
  pa: moving(false, false, "ṗ"), pb: moving(true, false, "ṗ"),
  ua: moving(false, false, "ṗ"), ub: moving(true, false, "ṗ"),
  uap: moving(false, true, "ṗ"), ubp: moving(true, true, "ṗ"),
  pap: moving(false, true, "ṗ"), pbp: moving(true, true, "ṗ"),
  va: moving(false, false, "v"), vb: moving(true, false, "v"),
  vap: moving(false, true, "v"), vbp: moving(true, true, "v"),
  wa: moving(false, false, "ω"), wb: moving(true, false, "ω"),
  wap: moving(false, true, "ω"), wbp: moving(true, true, "ω"),
  omegaa: moving(false, false, "ω"), omegab: moving(true, false, "ω"),
  ma: whole(false, "m"), mb: whole(true, "m"), ima: whole(false, "m"), imb: whole(true, "m"),
  Ia: whole(false, "I"), Ib: whole(true, "I"), iIa: whole(false, "I"), iIb: whole(true, "I"),
  e: (drawing, impact) => impact_symbols.eps(drawing, impact),
};

type BodySymbol = (drawing: Drawing, body: number, state: BodyState, time: number) => void;

const frame_axes = (text: string): BodySymbol => (drawing, body, state) => {
  const reach = 1.3 * drawing.size.radii[body];
  style.axis_colors.forEach((color, k) => {
    const axis: Vec3 = [k === 0 ? 1 : 0, k === 1 ? 1 : 0, k === 2 ? 1 : 0];
    drawing.arrow(state.position, scaled(rotate(state.rotation, axis), reach), color, `${text} ${"xyz"[k]}`);
  });
};

const draw_force: BodySymbol = (drawing, body, state, time) =>
  drawing.quantity("force", state.position, drawing.run.loads.force(body, frame_of(drawing.run, time)), "F");
const draw_torque: BodySymbol = (drawing, body, state, time) => {
  const { loads } = drawing.run;
  const frame = frame_of(drawing.run, time);
  const torque = subtract(loads.moment(body, frame), cross(state.position, loads.force(body, frame)));
  drawing.quantity("angular-momentum", state.position, torque, "τ");
};
const draw_gravity: BodySymbol = (drawing, _, state) => {
  const { gravity } = drawing.run.settings;
  const size = length(gravity);
  const way = size > 0 ? scaled(gravity, (2 * drawing.plain) / size) : gravity;
  drawing.arrow(state.position, way, from_text(drawing.run.overlays.color.force), "g");
};
const draw_mass: BodySymbol = (drawing, body, state) => {
  drawing.frame.tints.set(body, tint);
  drawing.frame.labels.push({ at: state.position, text: `m = ${drawing.run.scene.bodies[body].mass.toPrecision(4)} kg`, color: null });
};
const of_state = (kind: "velocity" | "omega" | "momentum" | "angular-momentum", text: string, value: (state: BodyState) => Vec3): BodySymbol =>
  (drawing, _, state) => drawing.quantity(kind, state.position, value(state), text);

const frame_of = (run: Run, time: number) => Math.min(Math.round(time * run.fps), run.frames - 1);
const draw_place: BodySymbol = (drawing, _, state) => drawing.point(state.position, "x");
const draw_velocity = of_state("velocity", "v", (state) => state.velocity);
const draw_spin = of_state("omega", "ω", (state) => state.angular_velocity);
const draw_momentum = of_state("momentum", "P", (state) => state.momentum);
const draw_angular = of_state("angular-momentum", "L", (state) => state.angular_momentum);

const body_symbols: Record<string, BodySymbol> = {
  x: draw_place, xx: draw_place,
  v: draw_velocity, vv: draw_velocity,
  w: draw_spin, ww: draw_spin, omega: draw_spin,
  P: draw_momentum, PP: draw_momentum,
  L: draw_angular, LL: draw_angular,
  R: frame_axes("R"), RR: frame_axes("R"), q: frame_axes("R"),
  I: frame_axes("I"), II: frame_axes("I"), iI: frame_axes("I"),
  m: draw_mass, mm: draw_mass,
  F: draw_force, FF: draw_force,
  tau: draw_torque, tauu: draw_torque,
  g: draw_gravity, gg: draw_gravity,
};
