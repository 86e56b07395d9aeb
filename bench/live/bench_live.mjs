// Tumble's live module beside the engines that have official packages for pages: error, bytes, time.
//   scripts/bench live [--rounds N]      writes docs/results/live.md
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { cases } from "./cases.mjs";
import { mujoco, rapier, tumble } from "./engines.mjs";

const [live_code, live_wasm, version, page, round_count] = process.argv.slice(2);
const rounds = Number(round_count);
const packages = join(fileURLToPath(import.meta.url), "../node_modules");

const engines = [await tumble({ code: live_code, wasm: live_wasm, version }), await rapier(packages), await mujoco(packages)];

function median(list) {
  const sorted = [...list].sort((a, b) => a - b);
  return sorted[Math.floor(sorted.length / 2)];
}

const number = (value) => String(Number(value.toPrecision(2)));
const megabytes = (bytes) => (bytes / 1e6).toFixed(2);

const lines = ["| engine | version | module, MB | compressed, MB |", "|---|---|---|---|",
  ...engines.map((e) => `| ${e.name} | ${e.version} | ${megabytes(e.bytes)} | ${megabytes(e.compressed)} |`), ""];
for (const scene of cases) {
  lines.push(`### ${scene.name[0].toUpperCase()}${scene.name.slice(1)}`, "",
    `| engine | ${scene.error} | a run from the scene to the last frame, median, ms |`, "|---|---|---|");
  const runs = engines.map((engine) => ({ engine, run: engine.prepare(scene), times: [], heights: null }));
  for (let round = 0; round < rounds; ++round) {
    for (const each of runs) {
      const start = performance.now();
      each.heights = each.run();
      each.times.push(performance.now() - start);
    }
  }
  for (const { engine, heights, times } of runs)
    lines.push(`| ${engine.name} | ${number(scene.error_of(heights))} | ${number(median(times))} |`);
  lines.push("");
}
lines.push("### Runs", "", `${new Date().toISOString().slice(0, 10)}, commit ${version}, Node ${process.versions.node}, ` +
  `${rounds} rounds: \`scripts/bench live\``, "");

const begin = "<!-- measured: begin -->", end = "<!-- measured: end -->";
const text = readFileSync(page, "utf8");
const from = text.indexOf(begin) + begin.length, to = text.indexOf(end);
writeFileSync(page, `${text.slice(0, from)}\n\n${lines.join("\n")}\n${text.slice(to)}`);
