// The stage of a page against the frame of the program: the same scene, moment, camera and size.
import assert from "node:assert/strict";
import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test, type TestContext } from "node:test";
import { open_page } from "./browser.ts";
import { make_page } from "./made_page.ts";
import { write_png } from "./png_file.ts";
import { run_tumble, scenes_folder, temporary_folder, tumble } from "./program.ts";

/** Mean FLIP (docs/reference/comparison.md); pictures that differ by antialiasing and soft shadows alone have less. */
const most = 0.05;

interface Shown {
  scene: string;
  time: number;
  overlays: string;
  set?: string[];
  /** Instead of `most`. */
  flip?: number;
}

const file = (name: string) => join(temporary_folder, name);

/** FLIP of the two pictures, of a moment that is a frame of both. */
async function compare(t: TestContext, name: string, { scene, time, overlays, set = [], flip: limit = most }: Shown): Promise<void> {
  const options = ["--overlay", overlays, "--duration", time, "--fps", 30,
    ...["overlay.legend=false", ...set].flatMap((value) => ["--set", value])];
  const opened = await open_page(make_page(name, join(scenes_folder, scene), "--no-film", ...options), { width: 1280, height: 720 });
  const { width, height, text } = await opened.page.evaluate((time) => {
    window.tumble.seek(time);
    const { width, height, data } = window.tumble.pixels()!;
    return { width, height, text: btoa(Array.from(data, (value) => String.fromCharCode(value)).join("")) };
  }, time);
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
  const data = Buffer.from(text, "base64");
  const folder = process.env.TUMBLE_PICTURES ?? temporary_folder;
  const [stage, frames] = [join(folder, `${name}_stage.png`), join(folder, `${name}_frame`)];
  write_png(stage, width, height, (x, y) => [...data.subarray(4 * (y * width + x), 4 * (y * width + x) + 3)] as [number, number, number]);
  const frame = Math.round(30 * time);
  rmSync(frames, { recursive: true, force: true });
  tumble("render", join(scenes_folder, scene), "--frames", frames, "--frames-range", frame, "--size", `${width}x${height}`, "--quiet", ...options);
  writeFileSync(file("limits.toml"), `levels = 255\nflip = ${limit}\n`);
  const drawn = join(frames, `frame_${String(frame).padStart(6, "0")}.png`);
  const compared = run_tumble("compare", drawn, stage, "--tolerances", file("limits.toml"), "--json", file("result.json"));
  assert.ok(compared.status !== null && compared.status <= 1, compared.stderr);
  const figures: { metric: string; value: number }[] = JSON.parse(readFileSync(file("result.json"), "utf8")).images[0].figures;
  const flip = figures.find((figure) => figure.metric === "flip")!.value;
  t.diagnostic(`FLIP ${flip.toFixed(4)}, ${width} x ${height} pixels`);
  assert.ok(flip < limit, `FLIP ${flip}`);
}

const pictures: Record<string, Shown> = {
  boxes: { scene: "falling_boxes.toml", time: 1, overlays: "none" },
  boxes_overlays: { scene: "falling_boxes.toml", time: 1, overlays: "velocity,omega,contacts,forces,trails,com,aabb" },
  joints: { scene: "wrecking_ball.toml", time: 1, overlays: "none" },
  joints_overlays: { scene: "wrecking_ball.toml", time: 1, overlays: "joints,axes,momentum,loads" },
  balls: { scene: "bouncing_balls.toml", time: 1, overlays: "none", set: ['materials.ball.pattern="checker"'] },
  balls_overlays: {
    scene: "bouncing_balls.toml", time: 1, overlays: "velocity,impulses,ghosts,islands,normals", set: ['materials.ball.pattern="checker"'],
  },
  textures: { scene: "dice.toml", time: 0.4, overlays: "none" },
  surfaces: { scene: "../../web/test/surfaces/scene.toml", time: 0, overlays: "none" },
  patterns: { scene: "marbles.toml", time: 0.4, overlays: "none" },
  environment: {
    scene: "bouncing_balls.toml", time: 1, overlays: "none",
    set: ['environment.preset="dusk"', "environment.rotation=40", "output.exposure=0.5", "materials.ball.metallic=1"],
  },
  pool: { scene: "../../web/test/surfaces/pool.toml", time: 0.5, overlays: "none", flip: 0.065 },   // shown colors are blended, not light
  background: { scene: "falling_boxes.toml", time: 1, overlays: "none", set: ['environment.background=["#f0d8b0", "#405080"]'] },
};
for (const [name, shown] of Object.entries(pictures)) test(`${name}: ${shown.scene}, ${shown.overlays}`, (t) => compare(t, name, shown));
