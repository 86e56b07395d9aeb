// Runs the tests of this folder: bundles each NAME.test.ts into ../../build/web-test and hands it to `node --test`.
//   node web/test/run.mjs [NAME]...            all, or those named: page, gltf ...
//   node web/test/run.mjs NAME --pattern TEXT  only the tests of NAME whose name matches TEXT
//   node web/test/run.mjs --bench NAME         the benchmark NAME.bench.ts instead: pages
// Environment: TUMBLE, the program (default: build/release/tumble); CHROMIUM, the browser (default: from PATH);
// TUMBLE_PICTURES, a folder for the pictures that tests look at.
// Exit code: 0 passed, 1 failed, 77 a test was skipped, as something that it needs is missing; a line says what.
import { existsSync } from "node:fs";
import { mkdir, readdir, symlink } from "node:fs/promises";
import { join } from "node:path";
import { spawnSync } from "node:child_process";
import { chromium_path, player_folder, repository, tumble_path } from "./paths.mjs";

const skipped_code = 77;
const web = join(repository, "web");
const here = join(web, "test");
const out = join(repository, "build/web-test");

function skip(name, reason) {
  console.log(`SKIPPED ${name}: ${reason}`);
  return skipped_code;
}

/** Programs and files that a test needs, told by the modules that it imports. */
function missing_part(inputs) {
  const imports = (module) => inputs.includes(`test/${module}`);
  if (imports("program.ts") && !existsSync(tumble_path())) return `there is no ${tumble_path()} (cmake --build --preset release)`;
  if ((imports("made_page.ts") || imports("made_lesson.ts")) && !existsSync(join(player_folder, "player.js"))) {
    return "there is no build/web/player.js (scripts/build-web)";
  }
  if (imports("browser.ts") && !chromium_path()) return "there is no chromium (scripts/install-dependencies --test)";
  return "";
}

async function run_test(esbuild, name, node_options) {
  const outfile = join(out, `${name}.${kind}.mjs`);
  const built = await esbuild.build({
    entryPoints: [join(here, `${name}.${kind}.ts`)],
    outfile,
    bundle: true,
    platform: "node",
    target: "node18",
    format: "esm",
    packages: "external",   // playwright-core cannot be bundled
    sourcemap: "inline",
    metafile: true,
    absWorkingDir: web,
  });
  const reason = missing_part(Object.keys(built.metafile.inputs));
  if (reason) return skip(name, reason);
  const run = spawnSync(process.execPath,
    ["--enable-source-maps", "--test-reporter=spec", "--test-reporter-destination=stdout", ...node_options, outfile],
    { stdio: "inherit", cwd: web });
  return run.status === 0 ? 0 : 1;
}

let kind = "test";
const names = [], node_options = [];
for (let i = 2; i < process.argv.length; ++i) {
  const argument = process.argv[i];
  if (argument === "--pattern" && i + 1 < process.argv.length) node_options.push(`--test-name-pattern=${process.argv[++i]}`);
  else if (argument === "--bench") kind = "bench";
  else if (argument.startsWith("-")) {
    console.error(`run.mjs: unknown option '${argument}'`);
    process.exit(2);
  } else names.push(argument);
}
if (!existsSync(join(web, "node_modules/esbuild"))) process.exit(skip("web tests", "there is no web/node_modules (scripts/build-web)"));
const esbuild = await import("esbuild");

const all = (await readdir(here)).filter((file) => file.endsWith(`.${kind}.ts`)).map((file) => file.slice(0, -`.${kind}.ts`.length)).sort();
for (const name of names) {
  if (!all.includes(name)) {
    console.error(`run.mjs: there is no ${kind} '${name}'; there are: ${all.join(", ")}`);
    process.exit(2);
  }
}
await mkdir(out, { recursive: true });
// The bundles find their packages as the sources do.
await symlink(join(web, "node_modules"), join(out, "node_modules")).catch((error) => {
  if (error.code !== "EEXIST") throw error;
});

const results = [];
for (const name of names.length ? names : all) results.push(await run_test(esbuild, name, node_options));
process.exit(results.includes(1) ? 1 : results.includes(skipped_code) ? skipped_code : 0);
