// Scenes whose runs the module of live pages must make with the native bytes.
import { readdirSync, readFileSync } from "node:fs";
import { basename, join } from "node:path";
import { repository, scenes_folder } from "./program.ts";

export const module_file = join(repository, "build/live/live.wasm");
/** Without vector instructions. */
export const scalar_module_file = join(repository, "build/live/scalar/live.wasm");

/** Seconds of each scene. */
export const short_run = "simulation.duration=0.5";

/** Needs a file, which the module does not read. */
const needs_file = /\b(file|image|texture|height_map|heights|normal_map|roughness_map)\s*=\s*"|\[sweep\]|\[\[axis\]\]/;
/** Takes minutes. */
const too_large = /thousand|ten_thousand|heap|pile|tower|hundred/;

/** Scenes of the program, of teaching and of the course that need no file and are short enough for a test of each. */
export function live_scenes(): string[] {
  return [scenes_folder, join(scenes_folder, "teaching"), join(repository, "course/scenes")].flatMap((folder) =>
    readdirSync(folder).filter((name) => name.endsWith(".toml") && !too_large.test(name)).map((name) => join(folder, name))
      .filter((file) => !needs_file.test(readFileSync(file, "utf8"))));
}

/** "teaching/01_drop.toml". */
export const short_name = (file: string): string => `${basename(join(file, ".."))}/${basename(file)}`;
