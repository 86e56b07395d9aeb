import { readFileSync } from "fs"; import { build } from "esbuild"; import { writeFileSync } from "fs"; import { math_plugin } from "./build/math.mjs";
const web = process.cwd();
const opt = { bundle: true, write: false, charset: "ascii", absWorkingDir: web, loader: { ".woff2": "dataurl" }, plugins: [math_plugin()], target: ["chrome110","firefox115","safari16.4"] };
const js = await build({ ...opt, entryPoints: ["test/synthetic_players.ts"], format: "iife" });
const css = await build({ ...opt, entryPoints: ["src/page.css"], minify: true });
console.log("js", js.outputFiles[0].text.length, "css", css.outputFiles[0].text.length);
const html = (body) => `<!doctype html><html lang="en" data-player="loading"><head><meta charset="utf-8"><title>t</title><meta name="viewport" content="width=device-width, initial-scale=1"><style>${readFileSync("src/shell.css","utf8")}
${css.outputFiles[0].text}</style></head><body class="page"><main>${body}</main><script>${js.outputFiles[0].text.replaceAll("</script","<\\/script")}</script></body></html>`;
writeFileSync("/work/tmp/panels/page.html", html(`<header class="masthead"><p class="eyebrow">Tumble clip</p><h1>A ball bounces beside a spinning box</h1><p class="lead">3 s, three bodies, impacts at their own times.</p></header><figure class="tumble-player" data-clip="a" data-options='{"layout":"page"}'><figcaption>The ball falls from 1.6 m; the two runs differ in its restitution.</figcaption></figure>`));
writeFileSync("/work/tmp/panels/lesson.html", html(`<header class="masthead"><h1>Restitution</h1></header><p>Text before the stage, long enough to see how it runs across the measure of the page and how the serif looks beside the figure.</p><figure class="tumble-player" data-clip="a" data-options='{"layout":"lesson","plot":"energy,body.ball.y","panels":["plots","state","impacts"]}'><figcaption>The ball falls.</figcaption></figure><p>Text after.</p>`));
