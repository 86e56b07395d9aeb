// Sizes of the pages of demo scenes, times to open them, and times of a step of scrubbing: state, plots, table, picture and its
// pixels read back. Prints a table. Only medians of runs on the same machine compare.
//   node web/test/run.mjs --bench pages
// Environment: TUMBLE_SCENES, names of scenes separated by commas (default: all demo scenes).
import { readdirSync, statSync } from "node:fs";
import { join } from "node:path";
import { launch, open_page } from "./browser.ts";
import { make_page } from "./made_page.ts";
import { scenes_folder } from "./program.ts";

const sizes = [[1280, 720], [360, 640]];
const opened_times = 3, steps = 60;

const demo_scenes = readdirSync(scenes_folder).filter((file) => file.endsWith(".toml")).map((file) => file.slice(0, -".toml".length));
const scenes = process.env.TUMBLE_SCENES?.split(",") ?? demo_scenes;

function median(values: number[]): number {
  return [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
}

// Runs in the page.
function scrub(count: number): number[] {
  const times: number[] = [];
  for (let i = 0; i < count; ++i) {
    const start = performance.now();
    window.tumble.seek((window.tumble.duration * ((7 * i) % count)) / count);
    window.tumble.pixels();
    times.push(performance.now() - start);
  }
  return times;
}

const columns = ["scene", "bodies", "page, kB", "data, kB", ...sizes.flatMap(([w, h]) => [`opens ${w}x${h}, ms`, `step ${w}x${h}, ms`])];
console.log(`| ${columns.join(" | ")} |\n|${"---|".repeat(columns.length)}`);
await launch();
for (const scene of scenes) {
  const path = make_page(scene, join(scenes_folder, `${scene}.toml`));
  const cells = [scene];
  for (const [width, height] of sizes) {
    const opening: number[] = [];
    let step = 0;
    for (let i = 0; i < opened_times; ++i) {
      const start = performance.now();
      const { page, close } = await open_page(path, { width, height });
      await page.evaluate(() => window.tumble.pixels());
      opening.push(performance.now() - start);
      if (i === 0) {
        step = median(await page.evaluate(scrub, steps));
        if (cells.length === 1) {
          const data = await page.evaluate(() => document.querySelector("script.tumble-clip")!.textContent!.length);
          cells.push(...[await page.evaluate(() => window.tumble.bodies.length), statSync(path).size / 1e3, data / 1e3].map((v) => v.toFixed(0)));
        }
      }
      await close();
    }
    cells.push(median(opening).toFixed(0), step.toFixed(0));
  }
  console.log(`| ${cells.join(" | ")} |`);
}
await (await launch()).close();
