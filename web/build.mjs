// Builds the player, the template of pages and the compiler of lessons into ../build/web, or into the folder given. With a
// module (build/live/live.wasm), the template of live pages too.
//   node build.mjs [FOLDER [live.wasm]]
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { existsSync } from "node:fs";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateRawSync } from "node:zlib";
import { glsl_plugin } from "./build/glsl.mjs";
import { math_plugin } from "./build/math.mjs";
import { encode91 } from "./build/text91.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? join(here, "../build/web"));
const source = (name) => join(here, "src", name);
const target = ["chrome110", "firefox115", "safari16.4"];

/** The text of a bundle, and the files it was made of. */
async function bundled(options) {
  const result = await build({
    bundle: true,
    minify: true,
    target,
    charset: "ascii",
    legalComments: "none",
    metafile: true,
    write: false,
    absWorkingDir: here,
    loader: { ".woff2": "dataurl" },
    plugins: [glsl_plugin(), math_plugin()],
    ...options,
  });
  return { text: result.outputFiles[0].text.trimEnd(), inputs: Object.keys(result.metafile.inputs) };
}

// A classic script: file:// refuses modules.
const script = (entry) => bundled({ entryPoints: [source(entry)], format: "iife" });

/** The licenses of the packages that a bundle has code of; they ask for their text in every copy. */
async function licenses_of(inputs) {
  const packages = new Set(inputs.map((file) => /^node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(file)?.[1]).filter(Boolean));
  let text = "";
  for (const name of [...packages].sort()) {
    const folder = join(here, "node_modules", name);
    const license = ["LICENSE", "LICENSE.md", "LICENSE.txt", "license", "LICENSE-MIT.txt"].map((file) => join(folder, file)).find(existsSync);
    if (!license) throw new Error(`${name} has no license file`);
    text += `${name}:\n${(await readFile(license, "utf8")).trim()}\n\n`;
  }
  return text.trim();
}

const hash_of = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;

/** Texts for the places of the template; none may look like a place that the program fills in, or end the element. */
function fill(template, values) {
  return template.replace(/\[\[(\w+)\]\]/g, (_, name) => {
    const value = values[name];
    if (value === undefined) throw new Error(`page.html: unknown place ${name}`);
    if (/\{\{|<\/(script|style)/i.test(value)) throw new Error(`page.html: the text of ${name} cannot stand in a page`);
    return value;
  });
}

async function with_licenses({ text, inputs }) {
  const licenses = await licenses_of(inputs);
  return licenses ? `/*\n${licenses.replaceAll("*/", "* /")}\n*/\n${text}` : text;
}

const { text: style, inputs: style_inputs } = await bundled({
  stdin: { contents: '@import "./shell.css"; @import "./page.css";', resolveDir: join(here, "src"), loader: "css" },
});
const { text: bundle, inputs } = await script("player.ts");
// The font of equations is made by a plugin, so it is not among the inputs.
const font = "node_modules/@fontsource/noto-sans-math/package.json";
const player = await with_licenses({ text: bundle, inputs: [...inputs, ...style_inputs, font] });
const { text: loader } = await script("loader.ts");
const { text: contents } = await script("contents.ts");
const icon = `data:image/svg+xml;base64,${(await readFile(source("icon.svg"))).toString("base64")}`;
const page = fill(await readFile(source("page.html"), "utf8"), {
  hashes: `${hash_of(loader)} ${hash_of(player)} ${hash_of(contents)}`,
  contents,
  icon,
  style,
  loader,
  player: deflateRawSync(player, { level: 9 }).toString("base64"),
});

const compiler = await with_licenses(await bundled({
  entryPoints: [join(here, "lesson/main.ts")],
  platform: "node",
  format: "cjs",
  target: "node18",
}));

/** The template of live pages: the policy allows a worker of the page's own text, and WebAssembly in it. */
async function live_page(module) {
  const { text: worker } = await script("live/worker.ts");
  const { text, inputs: live_inputs } = await bundled({
    entryPoints: [source("live_player.ts")], format: "iife", define: { LIVE_WORKER: JSON.stringify(worker) },
  });
  const live_player = await with_licenses({ text, inputs: [...live_inputs, ...style_inputs, font] });
  const { text: live_style } = await bundled({
    stdin: { contents: '@import "./live/live.css";', resolveDir: join(here, "src"), loader: "css" },
  });
  const template = (await readFile(source("page.html"), "utf8"))
    .replace("[[hashes]];", "[[hashes]] 'wasm-unsafe-eval'; worker-src blob:;")
    .replace('<script type="text/plain" id="tumble-player">', '<script type="text/plain" id="tumble-live">[[module]]</script>\n$&');
  return fill(template, {
    hashes: `${hash_of(loader)} ${hash_of(live_player)} ${hash_of(contents)}`,
    contents,
    icon,
    style: style + live_style,
    loader,
    module: encode91(deflateRawSync(module, { level: 9, memLevel: 9 })),
    player: deflateRawSync(live_player, { level: 9 }).toString("base64"),
  });
}

await mkdir(out, { recursive: true });
if (process.argv[3]) await writeFile(join(out, "live-page.html"), await live_page(await readFile(process.argv[3])));
await writeFile(join(out, "player.js"), player);
await writeFile(join(out, "page.html"), page);
await writeFile(join(out, "lesson.cjs"), compiler);
