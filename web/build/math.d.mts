import type { Plugin } from "esbuild";

export const math_characters: string;
export function equation_markup(tex: string): string;
export function math_plugin(): Plugin;
