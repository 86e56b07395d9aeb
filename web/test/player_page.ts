// Pages with players of the clip by closed forms, for tests of the player that need no program.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { build, type BuildOptions } from "esbuild";
import { glsl_plugin } from "../build/glsl.mjs";
import { math_plugin } from "../build/math.mjs";
import { repository } from "./paths.mjs";
import { temporary_folder } from "./temporary_folder.ts";

const web = join(repository, "web");

async function bundled(options: BuildOptions): Promise<string> {
  const result = await build({
    bundle: true, write: false, target: "chrome110", charset: "ascii", absWorkingDir: web, loader: { ".woff2": "dataurl" },
    plugins: [glsl_plugin(), math_plugin()], ...options,
  });
  return result.outputFiles![0].text;
}

let parts: Promise<{ script: string; style: string }> | null = null;

async function built_parts(): Promise<{ script: string; style: string }> {
  const [script, style] = await Promise.all([
    bundled({ entryPoints: ["test/synthetic_players.ts"], format: "iife" }),
    bundled({ entryPoints: ["src/page.css"] }),
  ]);
  return { script: script.replaceAll("</script", "<\\/script"), style };
}

/** Writes a page with a player for each object of options, and returns its path. */
export async function make_player_page(name: string, players: object[]): Promise<string> {
  const { script, style } = await (parts ??= built_parts());
  const shell = readFileSync(join(web, "src/shell.css"), "utf8");
  const figures = players.map((options) => `<h2>A clip</h2><figure class="tumble-player" data-clip="clip"
    data-options='${JSON.stringify(options)}'><p>The film of the clip.</p><figcaption>A ball and a box.</figcaption></figure>`);
  const path = join(temporary_folder, `${name}.html`);
  writeFileSync(path, `<!DOCTYPE html><html lang="en" data-player="loading"><head><meta charset="utf-8"><title>Players</title>
<meta name="viewport" content="width=device-width, initial-scale=1"><link rel="icon" href="data:,"><style>${shell}
${style}</style></head><body><main><h1>Players</h1>${figures.join("")}</main><script>${script}</script></body></html>`);
  return path;
}
