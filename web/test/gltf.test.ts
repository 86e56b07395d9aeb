// `tumble export`: the validator of the glTF authors, and the motion as three.js plays it.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { validateBytes } from "gltf-validator";
import { AnimationMixer, LoopOnce, Quaternion, Vector3, type AnimationAction, type Object3D } from "three";
import { GLTFLoader, type GLTF } from "three/addons/loaders/GLTFLoader.js";
import { bouncing_height } from "./closed_forms.ts";
import { random_numbers } from "./random.ts";
import { numbers, scenes_folder, table, temporary_folder, tumble } from "./program.ts";

const scenes = readdirSync(scenes_folder).filter((file) => file.endsWith(".toml")).map((file) => file.slice(0, -".toml".length));

function export_scene(scene: string, ...options: (string | number)[]): Uint8Array {
  tumble("export", join(scenes_folder, `${scene}.toml`), "-o", "clip.glb", "--quiet", ...options);
  return new Uint8Array(readFileSync(join(temporary_folder, "clip.glb")));
}

/** A file as three.js plays it. */
class Player {
  private readonly nodes = new Map<string, Object3D>();
  private readonly mixer: AnimationMixer;
  private readonly action: AnimationAction;

  private constructor(gltf: GLTF) {
    // three.js changes names that are no identifiers: the file has the bodies' own.
    for (const [object, place] of gltf.parser.associations) {
      if (place?.nodes !== undefined) this.nodes.set(gltf.parser.json.nodes[place.nodes].name, object as Object3D);
    }
    assert.equal(gltf.animations.length, 1);
    this.mixer = new AnimationMixer(gltf.scene);
    this.action = this.mixer.clipAction(gltf.animations[0]);
    this.action.setLoop(LoopOnce, 1);
    this.action.clampWhenFinished = true;
  }

  static async of(file: Uint8Array): Promise<Player> {
    // The loader looks at them although the files have no pictures.
    Object.assign(globalThis, { self: globalThis, ProgressEvent: class {} });
    return new Player(await new GLTFLoader().parseAsync(file.slice().buffer, ""));
  }

  seek(time: number): void {
    this.action.reset().play();   // it has stopped if the last time was the end
    this.mixer.setTime(time);
  }

  node(body: string): Object3D {
    const node = this.nodes.get(body);
    assert.ok(node, `there is no node "${body}"`);
    return node;
  }
}

/** Radians between two rotations; exact for small ones, as an arc cosine is not. */
function angle_between(p: Quaternion, q: Quaternion): number {
  const difference = (sign: number) => Math.hypot(p.x - sign * q.x, p.y - sign * q.y, p.z - sign * q.z, p.w - sign * q.w);
  return 4 * Math.asin(Math.min(difference(1), difference(-1)) / 2);
}

for (const scene of scenes) {
  test(`the validator accepts ${scene}`, async () => {
    const report = await validateBytes(export_scene(scene, ...(scene === "thousand_boxes" ? ["--duration", 1] : [])));
    // A hint for WebGL 1; images keep the size of the mesh file's own.
    const messages = report.issues.messages.filter(({ code }) => code !== "IMAGE_NPOT_DIMENSIONS");
    assert.deepEqual(messages, []);
    assert.equal(report.info.animationCount, 1);
    assert.ok(report.info.totalVertexCount > 0);
  });
}

/** Compares the file, as three.js plays it, with the last trajectory at 1,000 random rows. */
async function compare_with_trajectory(file: Uint8Array): Promise<void> {
  const player = await Player.of(file);
  const rows = table("t.csv");
  const random = random_numbers(29);
  let position_error = 0, rotation_error = 0;
  for (let i = 0; i < 1000; ++i) {
    const row = rows[Math.floor(random() * rows.length)];
    player.seek(Number(row.time));
    const node = player.node(row.body);
    position_error = Math.max(position_error, node.position.distanceTo(new Vector3(...numbers(row, "x", "y", "z"))));
    rotation_error = Math.max(rotation_error, angle_between(node.quaternion, new Quaternion(...numbers(row, "qx", "qy", "qz", "qw"))));
  }
  assert.ok(position_error < 1e-5, `${position_error} m`);
  assert.ok(rotation_error < 1e-5, `${rotation_error} rad`);
}

// Every moment of the simulation that the file was made from, of scenes with bounces, spin and keyframes. Of the pile of falling boxes
// the frames only: the table would be large.
for (const [scene, ...rate] of [["paddle", "--fps", 960, "--steps-per-frame", 1], ["tower_hit", "--fps", 960, "--steps-per-frame", 1],
                                ["tennis_racket", "--fps", 120, "--steps-per-frame", 1],
                                ["newtons_cradle", "--fps", 960, "--steps-per-frame", 2], ["falling_boxes"]] as const) {
  test(`three.js plays ${scene} as the simulation`, async () => {
    tumble("simulate", join(scenes_folder, `${scene}.toml`), "--trajectory", "t.csv", "--quiet", ...rate);
    await compare_with_trajectory(export_scene(scene));
  });
}

test("three.js plays linear keys as the simulation", async () => {
  tumble("simulate", join(scenes_folder, "turntable.toml"), "--trajectory", "t.csv", "--quiet");
  const file = export_scene("turntable", "--keys", "frames");
  assert.deepEqual((await validateBytes(file)).issues.messages, []);
  await compare_with_trajectory(file);
});

test("three.js plays bouncing balls between frames as the closed form", async () => {
  const player = await Player.of(export_scene("bouncing_balls", "--set", "simulation.impacts=exact"));
  const random = random_numbers(29);
  for (const restitution of [0.95, 0.9, 0.8, 0.7, 0.55, 0.4, 0.2]) {
    for (let i = 0; i < 1000; ++i) {
      const time = 6 * random();
      player.seek(time);
      const error = Math.abs(player.node(`e = ${restitution}`).position.y - bouncing_height(3.6, 0.34, restitution, time));
      assert.ok(error < 1e-5, `e = ${restitution}: ${error} m at ${time} s`);
    }
  }
});
