// Pages of one TypeScript module, for tests of modules that need a browser but no clip of the program.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { build } from "esbuild";
import { glsl_plugin } from "../build/glsl.mjs";
import { repository } from "./paths.mjs";
import { temporary_folder } from "./temporary_folder.ts";

export interface BundledPageOptions {
  /** Between <body> and its script. */
  body?: string;
  css?: string;
  /** In <head>: a content security policy. */
  head?: string;
}

let pages = 0;

/** Writes a page that runs a module, given relative to web/ ("test/stage_page.ts"), and returns its path. The module sets
    `document.documentElement.dataset.player` to "ready" when the page can be looked at. */
export async function make_bundled_page(module: string, options: BundledPageOptions = {}): Promise<string> {
  return make_inline_page({ entryPoints: [module] }, options);
}

/** The same, of TypeScript source; its imports are relative to web/test. */
export async function make_source_page(source: string, options: BundledPageOptions = {}): Promise<string> {
  return make_inline_page({ stdin: { contents: source, loader: "ts", resolveDir: join(repository, "web/test") } }, options);
}

async function make_inline_page(entry: Parameters<typeof build>[0], options: BundledPageOptions): Promise<string> {
  const bundle = await build({
    ...entry, bundle: true, write: false, format: "iife", target: "chrome110", charset: "ascii",
    absWorkingDir: join(repository, "web"), loader: { ".css": "text" },
    plugins: [glsl_plugin()],
  });
  const script = bundle.outputFiles![0].text.replaceAll("</script", "<\\/script");
  const path = join(temporary_folder, `bundled_page${pages++}.html`);
  writeFileSync(path, `<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>Test</title>
<meta name="viewport" content="width=device-width"><link rel="icon" href="data:,">${options.head ?? ""}<style>${options.css ?? ""}</style></head>
<body>${options.body ?? ""}<script>${script}</script></body></html>`);
  return path;
}
