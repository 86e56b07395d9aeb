// The numbers behind the panels, without a browser: curves, moments, the impulse of an impact, texts.
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Impact, Mat3, Run, Vec3 } from "../src/data/clip.ts";
import { impulse_terms, solve_impulse } from "../src/panels/impulse_equation.ts";
import { impulses_together, joint_row } from "../src/panels/joint_impulses.ts";
import { add, cross, dot, inverse, multiply, scaled, subtract, transform } from "../src/panels/linear.ts";
import { body_quantities, joint_column, read_subjects, scene_quantities } from "../src/panels/quantities.ts";
import { energy_stack, plot_series } from "../src/panels/series.ts";
import { paced_time } from "../src/ui/clock.ts";
import { number_text, tick_text, trimmed_text } from "../src/ui/format.ts";
import { moment_at, moment_text, moments_of, next_moment, previous_moment } from "../src/ui/moments.ts";
import { PlayerState } from "../src/ui/player_state.ts";
import { ball_at, bounces, box_landing, make_synthetic_clip, make_synthetic_run } from "./synthetic_clip.ts";

const run = make_synthetic_run(0.5);
const ball = 1;

test("curves of velocities jump at impacts and follow the closed form", () => {
  const { times, series } = plot_series([run], { kind: "body", quantity: "vy", body: ball });
  for (const bounce of bounces(0.5, run.duration)) {
    const at = times.findIndex((time) => Math.abs(time - bounce.time) < 1e-9);
    assert.ok(Math.abs(times[at + 1] - bounce.time) < 1e-9, "two rows at an impact");
    assert.ok(Math.abs(Number(series[0].values[at]) - ball_at(0.5, bounce.time, true).speed) < 1e-9);
    assert.ok(Math.abs(Number(series[0].values[at + 1]) - bounce.speed_after) < 1e-9);
  }
  for (let i = 1; i < times.length; i += 1) assert.ok(times[i] >= times[i - 1]);
});

test("a curve ends where its run ends", () => {
  const short: Run = { ...run, duration: 1, frames: 61 };
  const { times, series } = plot_series([run, short], { kind: "body", quantity: "y", body: ball });
  const last = times.length - 1;
  assert.equal(series[1].values[last], null);
  assert.ok(Number.isFinite(series[0].values[last]));
});

test("the stack of energies ends at the energy of the start plus work", () => {
  const stack = energy_stack(run);
  const top = stack.layers[stack.layers.length - 1].edge;
  const largest = Math.max(...top.map((value, frame) => Math.abs(value - stack.supply.values[frame])));
  assert.ok(largest < 1e-9 * stack.supply.values[0], `off by ${largest} J`);
  assert.ok(!stack.layers.some((layer) => layer.key === "elastic"), "a layer without energy is left out");
});

test("a potential energy below zero is stacked from its lowest value", () => {
  const shifted = { ...run, energy: { ...run.energy, potential: run.energy.potential.map((value) => value - 100) } };
  const stack = energy_stack(shifted);
  assert.equal(Math.min(...stack.layers[0].edge), 0);
  assert.ok(Math.abs(stack.layers[stack.layers.length - 1].edge[7] - stack.supply.values[7]) < 1e-9);
});

test("the impulse of eq. 20 is that of the closed form", () => {
  const bounce = run.impacts.find((impact) => impact.body_a === ball || impact.body_b === ball)!;
  assert.ok(solve_impulse(impulse_terms(run, bounce)).residual < 1e-12);
});

test("eq. 20 holds with two turned bodies and friction", () => {
  // The impulse is made from the change of velocities that it causes, apart from the code that is tested.
  const rotation: [number, number, number, number] = [0.5, 0.5, -0.5, 0.5];
  const inertia: Mat3 = [0.2, 0.01, 0, 0.01, 0.3, 0.02, 0, 0.02, 0.25];
  const bodies = [2, 3].map((mass) => ({ ...run.scene.bodies[ball], mass, inertia }));
  const n: Vec3 = [0.6, 0.8, 0], f: Vec3 = [0.16, -0.12, 0.3], j = 1.7;
  const positions: Vec3[] = [[0, 0, 0], [0.3, 0.7, 0.4]], p: Vec3 = [0.2, 0.1, 0.3];
  // R turns x to z, y to -x and z to -y: R I R^T by hand.
  const world: Mat3 = [0.3, 0.02, -0.01, 0.02, 0.25, 0, -0.01, 0, 0.2];
  const velocity_change = (i: number, impulse: Vec3): Vec3 => {
    const r = add(p, scaled(positions[i], -1));
    return add(scaled(impulse, 1 / bodies[i].mass), cross(transform(inverse(world), cross(r, impulse)), r));
  };
  const on_b = add(scaled(n, j), f);
  const change = dot(n, add(velocity_change(1, on_b), scaled(velocity_change(0, scaled(on_b, -1)), -1)));
  const e = 0.4, v_before = -change / (1 + e);
  const impact = {
    ...run.impacts[0], body_a: 0, body_b: 1, px: p[0], py: p[1], pz: p[2], nx: n[0], ny: n[1], nz: n[2], fx: f[0], fy: f[1], fz: f[2],
    impulse: j, restitution: e, v_before, v_after: -e * v_before,
    pose_a: { position: positions[0], rotation }, pose_b: { position: positions[1], rotation },
  } as Impact;
  const solved = solve_impulse(impulse_terms({ ...run, scene: { ...run.scene, bodies } }, impact));
  assert.ok(solved.residual < 1e-12, `residual ${solved.residual}`);
  assert.ok(Math.abs(solved.friction) > 1e-3, "friction takes part");
});

test("impulses that act together satisfy the row of each, and eq. 20 does not", () => {
  const corners = [0, 1, 2, 3];
  for (const index of corners) {
    assert.deepEqual(impulses_together(run, index), corners);
    const { before, after, shares, residual } = joint_row(run, index);
    assert.ok(residual < 1e-12, `residual ${residual}`);
    assert.ok(Math.abs(shares.reduce((sum, { share }) => sum + share, before) - after) < 1e-12);
    assert.ok(solve_impulse(impulse_terms(run, run.impacts[index])).residual > 0.1);
  }
  // The ball bounces alone.
  assert.deepEqual(impulses_together(run, 4), [4]);
  assert.ok(joint_row(run, 4).residual < 1e-12);
  // Passes of a law come one after the other, and so do the contacts of the method of the notes.
  const passes: Run = { ...run, impacts: run.impacts.map((impact, i) => ({ ...impact, pass: i % 2 })) };
  assert.deepEqual(impulses_together(passes, 0), [0, 2]);
  assert.deepEqual(impulses_together({ ...run, settings: { ...run.settings, method: "notes" } }, 0), [0]);
});

test("friction beside its point and turned bodies take part in the row", () => {
  // Two impulses on one body, made from the change of velocities that they cause, apart from the code that is tested.
  const mass = 2, inertia: Mat3 = [0.2, 0, 0, 0, 0.3, 0, 0, 0, 0.25];
  const bodies = [run.scene.bodies[0], { ...run.scene.bodies[ball], mass, inertia }];
  const center: Vec3 = [0.3, 0.7, 0.4], identity: [number, number, number, number] = [1, 0, 0, 0];
  const parts = [
    { p: [0.2, 0, 0.1] as Vec3, n: [0, 1, 0] as Vec3, j: 1.3, f: [0.2, 0, 0.1] as Vec3, beside: [0, 0.05, 0] as Vec3 },
    { p: [0.5, 0.1, 0.6] as Vec3, n: [0.6, 0.8, 0] as Vec3, j: 0.7, f: [0.08, -0.06, 0.2] as Vec3, beside: [0, 0, 0] as Vec3 },
  ];
  let v: Vec3 = [0, 0, 0], w: Vec3 = [0, 0, 0];
  for (const { p, n, j, f, beside } of parts) {
    const impulse = add(scaled(n, j), f);
    v = add(v, scaled(impulse, 1 / mass));
    w = add(w, transform(inverse(inertia), add(cross(subtract(p, center), impulse), beside)));
  }
  const impacts = parts.map(({ p, n, j, f, beside }) => {
    const moment = add(cross(p, add(scaled(n, j), f)), beside);
    const change = dot(n, add(v, cross(w, subtract(p, center))));
    return {
      ...run.impacts[0], body_a: 0, body_b: 1, px: p[0], py: p[1], pz: p[2], nx: n[0], ny: n[1], nz: n[2], impulse: j, fx: f[0], fy: f[1], fz: f[2],
      mx: moment[0], my: moment[1], mz: moment[2], v_before: -change, v_after: 0, restitution: 0, pass: 0,
      pose_a: { position: [0, 0, 0], rotation: identity }, pose_b: { position: center, rotation: identity },
    } as Impact;
  });
  const pair: Run = { ...run, impacts, scene: { ...run.scene, bodies } };
  for (const index of [0, 1]) assert.ok(joint_row(pair, index).residual < 1e-12);
});

test("an inverse times its matrix is one", () => {
  const m: Mat3 = [2, 1, 0, 1, 3, 0.5, 0, 0.5, 4];
  multiply(m, inverse(m)).forEach((value, i) => assert.ok(Math.abs(value - (i % 4 === 0 ? 1 : 0)) < 1e-14));
});

test("impacts at one time are one moment, found in both directions", () => {
  const landing = moment_at(run, box_landing)!;
  assert.deepEqual([landing.first, landing.last], [0, 3]);
  assert.match(moment_text(run, landing), /^Impacts 1 to 4 at 0\.2473 s: box on ground$/);
  assert.equal(next_moment(run, box_landing)!.first, 4);
  assert.equal(previous_moment(run, box_landing), null);
  assert.equal(previous_moment(run, box_landing + 1e-3), landing);
  const moments = moments_of(run);
  assert.equal(next_moment(run, moments[moments.length - 1].time), null);
});

test("momenta of the scene are those of its bodies, about the world origin", () => {
  const at = 1, { series } = plot_series([run], { kind: "scene", quantity: "momentum" });
  const speed = ball_at(0.5, at).speed;
  assert.ok(Math.abs(series[0].at(at, false) - Math.abs(speed)) < 1e-9, "the box rests, the ball has 1 kg");
  const angular = plot_series([run], { kind: "scene", quantity: "angular-momentum" }).series[0].at(at, false);
  const spin = 2 * (0.8 ** 2 + 0.6 ** 2) / 12 * 1.5;
  // The ball flies beside the origin, at x = -0.6 m; the box spins.
  assert.ok(Math.abs(angular - Math.hypot(0.6 * speed, spin)) < 1e-9);
});

test("names of plots are read as `tumble plot` has them", () => {
  const named: Run = { ...run, scene: { ...run.scene, bodies: run.scene.bodies.map((body, i) => ({ ...body, name: ["a", "ball.v2", "c"][i] })) } };
  assert.deepEqual(read_subjects("energy, body.ball.v2.spin,total,body.none.y,nonsense", named),
    [{ kind: "energy" }, { kind: "body", quantity: "spin", body: 1 }, { kind: "scene", quantity: "total" }]);
});

test("each quantity of the list that the program and pages share has a value", () => {
  assert.ok(body_quantities.size > 11 && scene_quantities.size > 6);
  const state = run.motion.state(ball, 1);
  for (const [name, { value }] of body_quantities) assert.equal(typeof value(run, ball, state), "number", name);
  for (const [name, { value }] of scene_quantities) assert.equal(typeof value(run, 1), "number", name);
});

test("a column of a joint is a plot, linear between frames", () => {
  const name = "joint.arm.2.turn_x_speed";
  const jointed: Run = { ...run, joints: new Map([[name, Float64Array.from({ length: run.frames }, (_, frame) => 2 * frame)]]) };
  assert.deepEqual(read_subjects(`${name},joint.arm.2.force`, jointed), [{ kind: "joint", quantity: name }]);
  assert.deepEqual(joint_column(name), { label: "speed about x of arm.2", unit: "rad/s" });
  const { unit, series } = plot_series([jointed, run], { kind: "joint", quantity: name });
  assert.equal(unit, "rad/s");
  assert.ok(Math.abs(series[0].at(3.5 / run.fps, false) - 7) < 1e-9);
  assert.ok(Number.isNaN(series[1].at(0, false)), "a run without the joint has no curve");
});

test("a state tells each listener once, and leaves the side of an impact with the moment", () => {
  const state = new PlayerState(make_synthetic_clip());
  const calls: string[][] = [];
  state.on(["time", "before"], (changed) => calls.push([...changed].sort()));
  state.set({ time: 1, before: true });
  state.set({ time: 1 });
  state.set({ time: 9 });
  assert.deepEqual(calls, [["before", "time"], ["before", "time"]]);
  assert.equal(state.get("time"), state.duration);
  assert.equal(state.get("before"), false);
});

test("numbers are short, aligned and complete as asked", () => {
  assert.equal(number_text(-1.25, 6), "\u22121.25000");
  assert.equal(number_text(3.14e-7, 3), "3.14\u00b710\u207b\u2077");
  assert.equal(Number(number_text(0.1, 17)), 0.1);
  assert.equal(trimmed_text(0), "0");
  assert.equal(number_text(-15361.7, 4), "\u221215360");
  assert.equal(trimmed_text(200), "200");
  assert.equal(tick_text(-4e6), "\u22124\u00b710\u2076");
  assert.equal(trimmed_text(0.5), "0.5");
  assert.equal(trimmed_text(2e9), "2\u00b710\u2079");
});

test("a clip whose speed changes plays its frames at their times", () => {
  const fps = 10;
  const pace = [0, 0.1, 0.2, 0.22, 0.24, 0.24, 0.24, 0.34]; // slow from 0.2 s, and a stop at 0.24 s
  const near = (value: number, expected: number) => assert.ok(Math.abs(value - expected) < 1e-12, `${value}`);
  for (let frame = 0; frame < pace.length - 1; ++frame) near(paced_time(pace, fps, 0, frame / fps), pace[frame]);
  near(paced_time(pace, fps, 0.05, 0.1), 0.15);
  near(paced_time(pace, fps, 0.2, 0.05), 0.21);
  near(paced_time(pace, fps, 0.24, 0.2), 0.24);
  near(paced_time(pace, fps, 0.24, 0.25), 0.29);
  assert.equal(paced_time(pace, fps, 0.24, 1), Infinity);
  near(paced_time([], fps, 0.3, 0.2), 0.5);
});
