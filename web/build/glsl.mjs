// A plugin of esbuild for the shaders of the program: a .glsl file becomes its text without comments. The module that
// imports it joins the files that it includes.
import { readFile } from "node:fs/promises";

export function glsl_plugin() {
  return {
    name: "glsl",
    setup(build) {
      build.onLoad({ filter: /\.glsl$/ }, async ({ path }) => {
        const text = await readFile(path, "utf8");
        return { contents: text.replace(/\s*\/\/.*|^\s+|^#include.*\n/gm, "").replace(/\n+/g, "\n"), loader: "text" };
      });
    },
  };
}
