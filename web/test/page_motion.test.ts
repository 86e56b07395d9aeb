// The motion that a page shows: against the trajectory, and between frames against closed forms.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import type { Quat, Vec3 } from "../src/data/clip.ts";
import { open_page } from "./browser.ts";
import { bouncing_height } from "./closed_forms.ts";
import { angle_between, distance, make_page, shown_poses } from "./made_page.ts";
import { numbers, scenes_folder, table, temporary_folder, tumble } from "./program.ts";
import { random_numbers } from "./random.ts";

// In flight: a sphere that bounces, and a box that tumbles.
const flight = `format = 1
[simulation]
duration = 2.0
impacts = "exact"
[[body]]
type = "fixed"
shape = { type = "plane" }
restitution = 0.9
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.5 }
position = [-2.0, 1.5, 0.0]
velocity = [0.25, 0.0, 0.0]
angular_velocity = [0.0, 0.0, 6.0]
[[body]]
name = "box"
shape = { type = "box", size = [0.6, 0.3, 0.9] }
position = [3.0, 1.2, 0.0]
velocity = [0.0, 1.0, 0.5]
angular_velocity = [5.0, 4.0, -3.0]
`;

/** The page against the trajectory at `count` random rows. */
async function compare_with_trajectory(path: string, count = 1000): Promise<void> {
  const rows = table("t.csv");
  const random = random_numbers(29);
  const chosen = Array.from({ length: count }, () => rows[Math.floor(random() * rows.length)]);
  const bodies = [...new Set(chosen.map((row) => row.body))];
  const times = [...new Set(chosen.map((row) => Number(row.time)))];
  const opened = await open_page(path);
  const poses = await shown_poses(opened.page, bodies, times);
  let position_error = 0, rotation_error = 0;
  for (const row of chosen) {
    const { position, rotation } = poses[times.indexOf(Number(row.time))][bodies.indexOf(row.body)];
    position_error = Math.max(position_error, distance(position, numbers(row, "x", "y", "z") as Vec3));
    rotation_error = Math.max(rotation_error, angle_between(rotation, numbers(row, "qw", "qx", "qy", "qz") as Quat));
  }
  assert.ok(position_error < 1e-6, `${position_error} m`);
  assert.ok(rotation_error < 1e-5, `${rotation_error} rad`);
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
}

for (const scene of ["falling_boxes", "turntable", "newtons_cradle", "paddle"]) {
  test(`${scene} at frames`, async () => {
    const file = join(scenes_folder, `${scene}.toml`);
    tumble("simulate", file, "--trajectory", "t.csv", "--quiet");
    await compare_with_trajectory(make_page(scene, file, "--no-film"));
  });
}

test("exact flights between frames", async () => {
  const file = join(temporary_folder, "flight.toml");
  writeFileSync(file, flight);
  tumble("simulate", file, "--trajectory", "t.csv", "--quiet", "--fps", 7680, "--steps-per-frame", 1);
  await compare_with_trajectory(make_page("flight", file, "--no-film"));
});

test("exact bounces between frames as the closed form", async () => {
  const path = make_page("balls", join(scenes_folder, "bouncing_balls.toml"), "--set", "simulation.impacts=exact", "--no-film");
  const opened = await open_page(path);
  const restitutions = [0.95, 0.9, 0.8, 0.7, 0.55, 0.4, 0.2];
  const random = random_numbers(29);
  const times = Array.from({ length: 1000 }, () => 6 * random());
  const poses = await shown_poses(opened.page, restitutions.map((e) => `e = ${e}`), times);
  for (const [i, time] of times.entries()) {
    for (const [k, restitution] of restitutions.entries()) {
      const error = Math.abs(poses[i][k].position[1] - bouncing_height(3.6, 0.34, restitution, time));
      assert.ok(error < 1e-6, `e = ${restitution}: ${error} m at ${time} s`);
    }
  }
  await opened.close();
});

test("runs of a variation", async () => {
  const file = join(scenes_folder, "bouncing_balls.toml");
  const path = make_page("varied", file, "--vary", "simulation.gravity=[0,-9.81,0],[0,-1.62,0]", "--no-film", "--set",
                         "simulation.impacts=exact");
  const opened = await open_page(path);
  assert.equal((await opened.page.evaluate(() => window.tumble.runs)).length, 2);
  for (const [run, gravity] of [[1, 1.62], [0, 9.81]]) {
    await opened.page.evaluate((index) => window.tumble.select_run(index), run);
    const [[pose]] = await shown_poses(opened.page, ["e = 0.95"], [1.7]);
    assert.ok(Math.abs(pose.position[1] - bouncing_height(3.6, 0.34, 0.95, 1.7, gravity)) < 1e-6, `run ${run}`);
  }
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});
