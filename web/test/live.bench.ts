// Times of live runs: from a change to the decoded clip, in the module and natively. Printed as a table.
import { spawnSync } from "node:child_process";
import { readFileSync, statSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { deflateRawSync } from "node:zlib";
import { read_clip } from "../src/data/decode_clip.ts";
import { LiveModule } from "../src/live/module.ts";
import { encode91 } from "../build/text91.mjs";
import { tumble_path } from "./paths.mjs";
import { repository, temporary_folder } from "./program.ts";

const wasm = join(repository, "build/live/live.wasm");
const live_data = join(dirname(tumble_path()), "tests/live/live_data");

const head = `format = 1
[simulation]
duration = 3.0
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
`;
const ball = `[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.1 }
position = [0, 1.1, 0]
restitution = 0.8
`;
const boxes = (count: number): string => Array.from({ length: count }, (_, i) => `[[body]]
name = "box${i}"
shape = { type = "box", size = [0.4, 0.3, 0.5] }
position = [${(0.05 * (i % 3)).toFixed(2)}, ${(0.5 + 0.45 * i).toFixed(2)}, ${(0.04 * (i % 2)).toFixed(2)}]
`).join("");
const scenes: Record<string, string> = {
  "ball on a plane, exact": head.replace("duration = 3.0", 'duration = 3.0\nimpacts = "exact"') + ball,
  "two boxes": head + boxes(2),
  "20 boxes": head + boxes(20),
};

const bytes = readFileSync(wasm);
const start = performance.now();
const module = await LiveModule.of(await WebAssembly.compile(bytes));
const packed = deflateRawSync(bytes, { level: 9, memLevel: 9 });
console.log(`module ${statSync(wasm).size} bytes, deflated ${packed.length}, in a page ${encode91(packed).length}; compiled and instantiated in ${(performance.now() - start).toFixed(0)} ms`);
const median = (values: number[]): number => values.sort((a, b) => a - b)[values.length >> 1];
for (const [name, text] of Object.entries(scenes)) {
  const runs: number[] = [], decoded: number[] = [];
  // The engine compiles the module again while it runs: not measured.
  for (let i = -10; i < 21; ++i) {
    const begin = process.cpuUsage();
    const run = module.open("scene.toml", text, []);
    run.advance(run.all_frames);
    const data = run.data()!;
    run.close();
    const used = process.cpuUsage(begin);
    if (i >= 0) runs.push((used.user + used.system) / 1e3);
    const middle = process.cpuUsage();
    read_clip(data);
    const more = process.cpuUsage(middle);
    if (i >= 0) decoded.push((more.user + more.system) / 1e3);
  }
  const file = join(temporary_folder, "scene.toml");
  writeFileSync(file, text);
  const native = Number(spawnSync(live_data, ["--time", file], { encoding: "utf8" }).stdout);
  console.log(`${name}: module ${median(runs).toFixed(1)} ms, native ${native.toFixed(1)} ms, ratio ${(median(runs) / native).toFixed(2)}, decoding ${median(decoded).toFixed(1)} ms (processor time)`);
}
const before = module.memory;
for (let i = 0; i < 500; ++i) {
  const run = module.open("scene.toml", scenes["ball on a plane, exact"], []);
  run.advance(run.all_frames);
  run.data();
  run.close();
}
console.log(`memory ${before} bytes, after 500 runs ${module.memory}`);
