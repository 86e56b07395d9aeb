// A plugin of esbuild for mathematics: `equations.json` (TeX) becomes MathML, and `tumble-math.css` temml's rules and a font
// for MathML that has only the characters that equations use.
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import subset_font from "subset-font";
import temml from "temml";
import { math_characters } from "./math_characters.mjs";

export function equation_markup(tex) {
  return temml.renderToString(tex, { displayMode: true, throwOnError: true });
}

async function font_rule(packages) {
  const file = join(packages, "@fontsource/noto-sans-math/files/noto-sans-math-latin-400-normal.woff2");
  const font = await subset_font(await readFile(file), math_characters, {
    targetFormat: "woff2",
    preserveNameIds: [0, 13, 14],   // copyright and license, which every copy must have
  });
  return `@font-face { font-family: "Tumble Math"; src: url(data:font/woff2;base64,${font.toString("base64")}) format("woff2"); }`;
}

/** Without temml's own font, which only script letters need. */
async function temml_rules(packages) {
  const text = await readFile(join(packages, "temml/dist/Temml-Local.css"), "utf8");
  return text.replace(/@font-face\s*\{[^}]*\}/g, "").replace(/[^{}]*\{\s*font-family:\s*["']?Temml["']?;\s*\}/g, "");
}

export function math_plugin() {
  return {
    name: "math",
    setup(build) {
      build.onLoad({ filter: /[\\/]equations\.json$/ }, async ({ path }) => {
        const equations = Object.entries(JSON.parse(await readFile(path, "utf8")));
        return { contents: JSON.stringify(Object.fromEntries(equations.map(([name, tex]) => [name, equation_markup(tex)]))), loader: "json" };
      });
      build.onResolve({ filter: /^tumble-math\.css$/ }, ({ path }) => ({ path, namespace: "math" }));
      build.onLoad({ filter: /.*/, namespace: "math" }, async () => {
        // From the working folder: a bundle of this module may lie elsewhere.
        const packages = join(build.initialOptions.absWorkingDir ?? process.cwd(), "node_modules");
        return { contents: `${await font_rule(packages)}\n${await temml_rules(packages)}`, loader: "css" };
      });
    },
  };
}
