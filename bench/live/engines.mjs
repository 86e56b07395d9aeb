// The engines of the benchmark of live modules. Each takes a case of cases.mjs and gives a function that runs it from the
// start and returns the heights of its bodies, m, by frame: heights[frame][body].
import { readFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

/** Bytes that a page loads, as they are and compressed. */
function size_of(files) {
  const contents = files.map((file) => readFileSync(file));
  const sum = (list) => list.reduce((total, each) => total + each.length, 0);
  return { bytes: sum(contents), compressed: sum(contents.map((each) => gzipSync(each, { level: 9 }))) };
}

export async function tumble(live) {
  const { LiveModule, read_clip } = await import(live.code);
  const module = await LiveModule.of(await WebAssembly.compile(readFileSync(live.wasm)));
  return {
    name: "Tumble",
    version: live.version,
    ...size_of([live.wasm]),
    prepare: (scene) => () => {
      const run = module.open("case.toml", tumble_scene(scene), []);
      run.advance(run.all_frames);
      if (run.error) throw new Error(run.error.message);
      const data = run.data();
      run.close();
      const { runs: [{ scene: { bodies }, motion }] } = read_clip(data);
      const moving = bodies.map((body, k) => k).filter((k) => bodies[k].name !== "floor");
      return Array.from({ length: scene.frames + 1 }, (_, n) => moving.map((k) => motion.state(k, n / scene.fps).position[1]));
    },
  };
}

function tumble_scene({ frames, fps, steps, restitution, friction, bodies, impacts }) {
  const shape = (body) => body.radius ? `{ type = "sphere", radius = ${body.radius} }` : `{ type = "box", size = [${body.size}] }`;
  const list = bodies.map((body, k) => `[[body]]
name = "body${k}"
shape = ${shape(body)}
position = [0, ${body.height}, 0]
restitution = ${restitution}
friction = ${friction}
`);
  return `format = 1
[simulation]
duration = ${frames / fps}
steps_per_frame = ${steps}
impacts = "${impacts}"
[output]
fps = ${fps}
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
restitution = ${restitution}
friction = ${friction}
${list.join("")}`;
}

export async function rapier(folder) {
  const { default: RAPIER } = await import("@dimforge/rapier3d-compat");
  await RAPIER.init();
  return {
    name: "Rapier",
    version: RAPIER.version(),
    ...size_of([`${folder}/@dimforge/rapier3d-compat/dist/rapier_wasm3d_bg.wasm`]),
    prepare: (scene) => () => {
      const world = new RAPIER.World({ x: 0, y: -9.81, z: 0 });
      world.timestep = 1 / (scene.fps * scene.steps);
      const surface = (collider) => collider.setRestitution(scene.restitution).setFriction(scene.friction);
      world.createCollider(surface(RAPIER.ColliderDesc.cuboid(50, 5, 50)).setTranslation(0, -5, 0));
      const bodies = scene.bodies.map(({ radius, size, height }) => {
        const body = world.createRigidBody(RAPIER.RigidBodyDesc.dynamic().setTranslation(0, height, 0));
        const shape = radius ? RAPIER.ColliderDesc.ball(radius) : RAPIER.ColliderDesc.cuboid(...size.map((edge) => edge / 2));
        world.createCollider(surface(shape).setDensity(1000), body);
        return body;
      });
      const heights = [bodies.map((body) => body.translation().y)];
      for (let n = 0; n < scene.frames; ++n) {
        for (let k = 0; k < scene.steps; ++k) world.step();
        heights.push(bodies.map((body) => body.translation().y));
      }
      world.free();
      return heights;
    },
  };
}

/** MuJoCo has no coefficient of restitution: a contact is a spring with a damper, solref = (-stiffness, -damping). */
function mujoco_model(scene) {
  const step = 1 / (scene.fps * scene.steps);
  // e = exp(-pi z / sqrt(1 - z^2)) of a free oscillator of damping ratio z; half its period lasts 10 steps.
  const log = Math.log(scene.restitution), ratio = -log / Math.hypot(Math.PI, log);
  const rate = Math.PI / (10 * step);
  const solref = scene.restitution > 0 ? `solref="${-rate * rate} ${-2 * ratio * rate}" solimp="0.999 0.999 0.001"` : `solref="${2 * step} 1"`;
  const shape = ({ radius, size }) => radius ? `type="sphere" size="${radius}"` : `type="box" size="${size.map((edge) => edge / 2).join(" ")}"`;
  const bodies = scene.bodies.map((body) =>
    `<body pos="0 ${body.height} 0"><freejoint/><geom ${shape(body)} density="1000" friction="${scene.friction} 0 0" ${solref}/></body>`);
  return `<mujoco><option timestep="${step}" gravity="0 -9.81 0" cone="elliptic"/><worldbody>
<geom type="plane" size="0 0 1" zaxis="0 1 0" friction="${scene.friction} 0 0" ${solref}/>
${bodies.join("\n")}</worldbody></mujoco>`;
}

export async function mujoco(folder) {
  const { default: load } = await import("@mujoco/mujoco");
  const mj = await load();
  return {
    name: "MuJoCo",
    version: mj.mj_versionString(),
    ...size_of([`${folder}/@mujoco/mujoco/mujoco.wasm`, `${folder}/@mujoco/mujoco/mujoco.js`]),
    prepare: (scene) => () => {
      const model = mj.MjModel.from_xml_string(mujoco_model(scene)), data = new mj.MjData(model);
      const sample = () => scene.bodies.map((body, k) => data.qpos[7 * k + 1]);
      const heights = [sample()];
      for (let n = 0; n < scene.frames; ++n) {
        for (let k = 0; k < scene.steps; ++k) mj.mj_step(model, data);
        heights.push(sample());
      }
      data.delete();
      model.delete();
      return heights;
    },
  };
}
