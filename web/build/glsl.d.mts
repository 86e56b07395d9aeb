import type { Plugin } from "esbuild";

export function glsl_plugin(): Plugin;
