// Starts the fuzz target of the compiler of lessons (web/test/lesson_fuzz.ts), which tells its options.
// Exit code: 0 nothing found, 1 a finding, 77 the packages of npm are missing (scripts/build-web).
import { existsSync } from "node:fs";
import { readdir } from "node:fs/promises";
import { spawnSync } from "node:child_process";
import { join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const here = fileURLToPath(new URL(".", import.meta.url));
const repository = resolve(here, "../..");
const web = join(repository, "web");
const out = join(repository, "build/web-fuzz");
if (!existsSync(join(web, "node_modules/esbuild"))) {
  console.log("SKIPPED fuzz target lesson: there is no web/node_modules (scripts/build-web)");
  process.exit(77);
}
const { build } = await import(pathToFileURL(join(web, "node_modules/esbuild/lib/main.js")).href);
await build({
  entryPoints: [join(web, "test/lesson_fuzz.ts"), join(web, "test/lesson_fuzz_worker.ts")],
  outdir: out,
  outExtension: { ".js": ".mjs" },
  bundle: true,
  platform: "node",
  target: "node18",
  format: "esm",
  sourcemap: "inline",
  logLevel: "error",
  absWorkingDir: web,
});
const course = (await readdir(join(repository, "course"))).filter((name) => /^\d.*\.md$/.test(name)).map((name) => join(repository, "course", name));
const run = spawnSync(process.execPath, ["--enable-source-maps", join(out, "lesson_fuzz.mjs"), "--dictionary", join(here, "lesson.dict"),
  ...process.argv.slice(2), ...course], { stdio: "inherit" });
process.exit(run.status ?? 1);
