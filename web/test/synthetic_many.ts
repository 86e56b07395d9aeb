// Many bodies in free flight, to measure the cost of a frame.
import type { Body, BodyState, Clip, Motion, Vec3 } from "../src/data/clip.ts";
import { gravity, make_synthetic_clip } from "./synthetic_clip.ts";

/** Boxes and balls, thrown from a square grid on the ground. */
export function make_many(count: number): Clip {
  const clip = make_synthetic_clip();
  const run = clip.runs[0];
  const ground = run.scene.bodies[0];
  const side = Math.ceil(Math.sqrt(count));
  const colors = ["#d1495b", "#e8833a", "#edae49", "#8cb369", "#3b7dd9"];
  const bodies: Body[] = [ground];
  for (let i = 0; i < count; ++i)
    bodies.push({
      ...run.scene.bodies[1 + (i % 2)], name: `body ${i}`, color: colors[i % 5], pattern: "panel",
      shape: i % 2 ? { type: "sphere", radius: 0.3 } : { type: "box", size: [0.5, 0.6, 0.4] },
    });
  const state = (body: number, time: number): BodyState => {
    const i = body - 1;
    const speed = body === 0 ? 0 : 4 + (i % 7) * 0.5;
    const position: Vec3 = body === 0 ? [0, 0, 0] : [(i % side) - side / 2, 0.5 + speed * time - (gravity / 2) * time * time, Math.floor(i / side) - side / 2];
    const angle = body === 0 ? 0 : time * (1 + (i % 5));
    return {
      position, origin: position, rotation: [Math.cos(angle), Math.sin(angle), 0, 0], velocity: [0, speed - gravity * time, 0],
      angular_velocity: [2 * (1 + (i % 5)), 0, 0], momentum: [0, 0, 0], angular_momentum: [0, 0, 0], asleep: false,
    };
  };
  const motion: Motion = {
    ...run.motion, state, state_before: state, kind: (body) => (body === 0 ? "still" : "keys"),
    pose: (body, time, out) => Object.assign(out, state(body, time)),
  };
  const far = 1.3 * side;
  run.scene = {
    ...run.scene, bodies,
    camera: () => ({ eye: [0.4 * far, 0.6 * far, far], target: [0, 0.5, 0], up: [0, 1, 0], vertical_fov: 40 }),
  };
  run.motion = motion;
  run.overlays = { ...run.overlays, bodies: bodies.slice(1).map((_, i) => i + 1) };
  run.impacts = [];
  run.contacts = { ...run.contacts, first: new Uint32Array(run.frames + 1) };
  return { ...clip, runs: [run] };
}
