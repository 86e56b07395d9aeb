// Builds the player and the lesson compiler into ../build/web, or into the folder given.
//   node build.mjs [FOLDER]
import { build } from "esbuild";
import { mkdir } from "node:fs/promises";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? join(here, "../build/web"));
await mkdir(out, { recursive: true });

// A classic script: file:// refuses modules.
await build({
  entryPoints: [join(here, "src/player.ts")],
  outfile: join(out, "player.js"),
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome110", "firefox115", "safari16.4"],
  charset: "ascii",
  legalComments: "none",
});
