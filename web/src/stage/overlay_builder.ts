// Turns a run and a moment into the shapes of its overlays, with the rules of src/overlay/overlay_builder.cpp.
import type { ArrowQuantity, Body, BodyState, Impact, OverlayName, Pose, Run, SketchPoint, Vec3 } from "../data/clip.ts";
import { nobody } from "../data/clip.ts";
import { world_box } from "./bounds.ts";
import { from_text } from "./color.ts";
import { ghosts_until, type GhostRow } from "./ghosts.ts";
import { island_roots } from "./islands.ts";
import { add, clamp, distance, length, rotate, scaled } from "./math.ts";
import { empty_frame, type OverlayArrow, type OverlayFrame } from "./overlay_frame.ts";
import { axial, contact_colors, contact_forms, style } from "./overlay_style.ts";
import type { SceneSize } from "./scene_size.ts";

export class OverlayBuilder {
  readonly shown: Set<number>;
  private readonly colors: Record<ArrowQuantity, Vec3>;
  private ghost_rows: GhostRow[] | null = null;

  constructor(
    private readonly run: Run,
    private readonly size: SceneSize,
  ) {
    this.shown = new Set(run.overlays.bodies);
    this.colors = Object.fromEntries(
      Object.entries(run.overlays.color).map(([quantity, color]) => [quantity, from_text(color)]),
    ) as Record<ArrowQuantity, Vec3>;
  }

  /** `before`: velocities just before an impact at that time. */
  build(time: number, before: boolean, overlays: Set<OverlayName>): OverlayFrame {
    const to = empty_frame();
    const { run } = this;
    const frame = clamp(Math.round(time * run.fps), 0, run.frames - 1);
    if (overlays.has("ghosts")) this.add_ghosts(to, time);
    if (overlays.has("islands")) this.add_islands(to, frame);
    if (overlays.has("cracks")) this.add_cracks(to, time);
    for (const body of this.shown) {
      if (!run.motion.shows(body, time)) continue;
      const state = before ? run.motion.state_before(body, time) : run.motion.state(body, time);
      this.add_body(to, body, state, frame, overlays);
    }
    this.add_contacts(to, frame, overlays);
    if (overlays.has("joints")) this.add_joints(to, time, frame);
    if (overlays.has("impulses")) this.add_impulses(to, time);
    return to;
  }

  /** From a foot, in the scale and color of the quantity. Null: of no length. */
  arrow(overlay: OverlayArrow["overlay"], quantity: ArrowQuantity, from: Vec3, value: Vec3, opacity = 1): OverlayArrow | null {
    const way = scaled(value, this.run.overlays.scale[quantity]);
    if (!(length(way) > 0)) return null;
    return {
      overlay, from, to: add(from, way), color: this.colors[quantity], opacity, width: style.arrow_width,
      double_head: axial.has(quantity), allowance: 0,
    };
  }

  private add_body(to: OverlayFrame, index: number, state: BodyState, frame: number, overlays: Set<OverlayName>): void {
    const body = this.run.scene.bodies[index];
    const radius = this.size.radii[index];
    if (overlays.has("sleep") && state.asleep) to.tints.set(index, { color: style.asleep_color, share: style.sleep_opacity });
    if (overlays.has("aabb")) this.add_box(to, body, state);
    if (overlays.has("axes")) this.add_axes(to, index, state);
    // It starts inside of its own body, which must not hide it.
    const push = (overlay: OverlayName, quantity: ArrowQuantity, value: Vec3) => {
      const made = overlays.has(overlay) ? this.arrow(overlay, quantity, state.position, value) : null;
      if (made) to.arrows.push({ ...made, allowance: 2 * radius });
      return made;
    };
    push("velocity", "velocity", state.velocity);
    push("omega", "omega", state.angular_velocity);
    push("momentum", "momentum", state.momentum);
    push("angular-momentum", "angular-momentum", state.angular_momentum);
    if (overlays.has("loads") && body.type === "dynamic") {
      const made = this.arrow("loads", "force", state.position, this.run.loads.force(index, frame));
      if (made) to.arrows.push({ ...made, color: style.load_color, allowance: 2 * radius });
    }
    if (overlays.has("com") && radius > 0)
      to.markers.push({
        overlay: "com", at: state.position, color: style.center_color, form: "center-of-mass", radius: style.center_radius,
        allowance: Infinity,
      });
    if (overlays.has("names")) {
      const letters = [...body.name];
      const text = letters.length > style.longest_name ? `${letters.slice(0, style.longest_name).join("")}…` : body.name;
      to.labels.push({ at: state.position, text, color: null });
    }
  }

  private add_box(to: OverlayFrame, body: Body, state: BodyState): void {
    const box = world_box(this.run.scene, body.shape, state.origin, state.rotation);
    if (!box) return;
    const corner = (bits: number): Vec3 => [0, 1, 2].map((i) => ((bits >> i) & 1 ? box.high[i] : box.low[i])) as Vec3;
    // One line through all twelve edges; three are passed twice.
    const points = [0, 1, 3, 2, 0, 4, 5, 1, 5, 7, 3, 7, 6, 2, 6, 4].map(corner);
    to.lines.push({ points, color: style.box_color, opacity: style.box_opacity, width: style.box_width, allowance: 0 });
  }

  private add_axes(to: OverlayFrame, index: number, state: BodyState): void {
    const radius = this.size.radii[index];
    style.axis_colors.forEach((color, k) => {
      const axis: Vec3 = [k === 0 ? 1 : 0, k === 1 ? 1 : 0, k === 2 ? 1 : 0];
      const way = scaled(rotate(state.rotation, axis), style.axis_length * radius);
      if (radius > 0)
        to.arrows.push({
          overlay: "axes", from: state.position, to: add(state.position, way), color, opacity: 1, width: style.axis_width,
          double_head: false, allowance: 2 * radius,
        });
    });
  }

  private add_joints(to: OverlayFrame, time: number, frame: number): void {
    const place = ([body, ...at]: SketchPoint): Vec3 => {
      if (body < 0) return at;
      const state = this.run.motion.state(body, time);
      return add(state.origin, rotate(state.rotation, at));
    };
    for (const joint of this.run.joint_marks) {
      const state = joint.states[frame];
      if (state === 0) continue;
      for (const line of joint.lines) {
        const color = !line.limit ? style.joint_color : state === 2 ? style.at_limit_color : style.limit_color;
        const width = line.limit ? style.limit_width : style.joint_width;
        to.lines.push({ points: line.points.map(place), color, opacity: 1, width, allowance: joint.allowance });
      }
      const at = place(joint.anchor);
      to.markers.push({ overlay: "joints", at, color: style.joint_color, form: joint.marker, radius: style.anchor_radius, allowance: joint.allowance });
      for (const made of [this.arrow("joints", "force", at, joint.force(frame)), this.arrow("joints", "torque", at, joint.torque(frame))])
        if (made) to.arrows.push({ ...made, allowance: joint.allowance });
    }
  }

  // A bond is open where its cells have moved apart; the edges of its face then are those of both pieces.
  private add_cracks(to: OverlayFrame, time: number): void {
    const { motion, cracks } = this.run;
    const poses = new Map<number, Pose>();
    const pose_of = (body: number): Pose => {
      let pose = poses.get(body);
      if (!pose) poses.set(body, (pose = motion.pose(body, time, { position: [0, 0, 0], origin: [0, 0, 0], rotation: [1, 0, 0, 0] })));
      return pose;
    };
    for (const { whole, pieces, outline } of cracks) {
      const radius = this.size.radii[whole];
      const places = (body: number) => outline.map((at) => add(pose_of(body).origin, rotate(pose_of(body).rotation, at)));
      const push = (points: Vec3[], color: Vec3) =>
        to.lines.push({ points, color, opacity: style.crack_opacity, width: style.crack_width, allowance: style.crack_allowance * radius });
      if (motion.shows(whole, time)) {
        push(places(whole), style.crack_color);
        continue;
      }
      const [one, other] = pieces.map(places);
      const open = one.some((at, i) => distance(at, other[i]) > style.crack_open * radius);
      push(one, open ? style.open_crack_color : style.crack_color);
      if (open) push(other, style.open_crack_color);
    }
  }

  private add_contacts(to: OverlayFrame, frame: number, overlays: Set<OverlayName>): void {
    const { contacts, scene, overlays: settings } = this.run;
    const of = (list: Float32Array, row: number): Vec3 => [list[3 * row], list[3 * row + 1], list[3 * row + 2]];
    for (let row = contacts.first[frame]; row < contacts.first[frame + 1]; ++row) {
      const a = contacts.a[row];
      const b = contacts.b[row];
      // A correction of the method is not a contact.
      if (a === nobody || !(this.shown.has(a) || this.shown.has(b))) continue;
      const point = of(contacts.point, row);
      const normal = of(contacts.normal, row);
      if (overlays.has("forces")) {
        const sign = scene.bodies[b].type === "dynamic" ? 1 : -1;
        const pressing = scaled(normal, sign * contacts.normal_force[row]);
        const friction = scaled(of(contacts.tangential_force, row), sign);
        const made = this.arrow("forces", "force", point, add(pressing, friction));
        if (made) to.arrows.push(made);
        if (length(friction) > style.least_friction * length(pressing))
          to.arrows.push({
            overlay: "forces", from: point, to: add(point, scaled(friction, settings.scale.force)), color: style.friction_color,
            opacity: 1, width: style.friction_width, double_head: false, allowance: 0,
          });
      }
      if (overlays.has("normals")) {
        const size = style.normal_length * Math.max(this.size.radii[a], this.size.radii[b]);
        to.arrows.push({
          overlay: "normals", from: point, to: add(point, scaled(normal, size)), color: style.normal_color, opacity: 1,
          width: style.normal_width, double_head: false, allowance: 0,
        });
      }
      if (overlays.has("contacts"))
        to.markers.push({
          overlay: "contacts", at: point, color: contact_colors[contacts.state[row]],
          form: contact_forms[contacts.feature[row]], radius: style.contact_radius, allowance: 0,
        });
    }
  }

  private add_impulses(to: OverlayFrame, time: number): void {
    const visible = this.run.overlays.impulse_time;
    for (const impact of this.run.impacts) {
      if (impact.time > time) break;
      if (impact.time < time - visible) continue;
      const { body, point, impulse } = impulse_of(impact, this.run);
      if (!this.shown.has(body)) continue;
      const age = visible > 0 ? (time - impact.time) / visible : 0;
      const made = this.arrow("impulses", "impulse", point, impulse, 1 - style.impulse_fade * clamp(age, 0, 1));
      if (made) to.arrows.push(made);
    }
  }

  private add_ghosts(to: OverlayFrame, time: number): void {
    this.ghost_rows ??= ghosts_until(this.run, this.size.radii, this.shown);
    for (const ghost of this.ghost_rows)
      if (ghost.time <= time + 1e-9 && !ghost.near(this.run.motion.state(ghost.body, time))) to.ghosts.push(ghost);
  }

  private add_islands(to: OverlayFrame, frame: number): void {
    const roots = island_roots(this.run, frame);
    for (const body of this.shown)
      if (this.run.scene.bodies[body].type === "dynamic")
        to.tints.set(body, {
          color: style.island_colors[roots[body] % style.island_colors.length], share: style.tint_opacity,
        });
  }
}

/** The impulse on B, or on A where only A is dynamic, with its friction; N s. */
export function impulse_of(impact: Impact, run: Run): { body: number; point: Vec3; impulse: Vec3 } {
  const on_b = run.scene.bodies[impact.body_b].type === "dynamic";
  const { impulse: j, nx, ny, nz, fx, fy, fz } = impact;
  return {
    body: on_b ? impact.body_b : impact.body_a,
    point: [impact.px, impact.py, impact.pz],
    impulse: scaled([j * nx + fx, j * ny + fy, j * nz + fz], on_b ? 1 : -1),
  };
}
