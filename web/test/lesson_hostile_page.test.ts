// Pages of lessons and scenes from strangers, in the browser: nothing runs, nothing loads, the page stays where it is, and every
// hostile text is read as it was written.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { open_page, type OpenedPage } from "./browser.ts";
import { make_lesson } from "./made_lesson.ts";
import { make_page } from "./made_page.ts";
import { run_tumble, temporary_folder } from "./program.ts";

const meta = "'\"><meta http-equiv=refresh content=0;url=about:blank><img src=x onerror=alert(1)></title></script><script>alert(1)</script><!--{{body}}";
const text = JSON.stringify(meta);

const scene = `[simulation]
duration = 0.6
impacts = "exact"
[output]
size = [192, 108]
samples = 1
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = ${text}
shape = { type = "sphere", radius = 0.1 }
position = [0.0, 0.6, 0.0]
`;

const lesson = `+++
title = ${text}
summary = ${text}
+++

## ${meta}

Text [${meta}](http://localhost/ "${meta.replaceAll('"', "'")}") \`${meta}\`

## Two

| ${meta} |
|---|
| ${meta} |

::: note ${meta}
${meta}
:::

${"```"}tumble
format = 1
title = ${text}
[stage]
id = "drop"
alt = ${text}
caption = ${text}
vary = ["simulation.gravity=[0,-9.81,0],[0,-5,0]"]
labels = [${text}, "<b>two</b>"]
plot = "energy"
panels = ["plots", "state", "impacts", "source"]
${scene}${"```"}

${"```"}quiz
question = ${text}
answer = 1
tolerance = 1
unit = ${text}
hint = ${text}
explanation = ${text}
${"```"}

${"```"}measure
stage = "drop"
caption = ${text}
[[row]]
label = ${text}
formula = ${text}
expected = 0.6
tolerance = 1e-9
unit = ${text}
check = { of = ${JSON.stringify(`body.${meta}.y`)}, take = "first" }
${"```"}

${"```"}convergence
of = ${JSON.stringify(`body.${meta}.y`)}
at = 0.2
integrators = ["explicit-euler", "rk4"]
steps_per_frame = [1, 2, 4]
reference = "exact"
format = 1
[stage]
alt = ${text}
caption = ${text}
${scene.replace('impacts = "exact"\n', "")}${"```"}
`;

/** Elements and attributes that could run, load or lead away, in the page as it stands. */
function dangers(opened: OpenedPage): Promise<string[]> {
  return opened.page.evaluate(() => [...document.querySelectorAll("*")].flatMap((element) => {
    const found: string[] = [];
    const name = element.localName;
    if (["iframe", "object", "embed", "base", "applet", "frame", "portal"].includes(name)) found.push(`<${name}>`);
    if (name === "meta" && element.getAttribute("http-equiv")?.toLowerCase() === "refresh") found.push("<meta refresh>");
    if (name === "script" && !["text/plain", null].includes(element.getAttribute("type"))) found.push("<script>");
    for (const attribute of element.attributes) {
      if (attribute.name.startsWith("on")) found.push(`${name} ${attribute.name}`);
      // Texts to download are links of ours; a download runs nothing.
      const download = attribute.value.startsWith("data:text/plain;charset=utf-8,") && element.hasAttribute("download");
      if (!download && /^\s*(javascript|vbscript|data:text)/i.test(attribute.value)) found.push(`${name} ${attribute.name}="${attribute.value}"`);
    }
    return found;
  }));
}

async function stays_a_page(path: string, seen: number): Promise<void> {
  const opened = await open_page(path);
  const { page } = opened;
  const address = page.url();
  const dialogs: string[] = [];
  page.on("dialog", (dialog) => { dialogs.push(dialog.message()); void dialog.dismiss(); });
  await page.evaluate(() => document.querySelectorAll("details").forEach((details) => { details.open = true; }));
  await page.waitForTimeout(300);   // a navigation would have begun
  assert.equal(page.url(), address);
  assert.deepEqual(dialogs, []);
  assert.deepEqual(await dangers(opened), []);
  assert.deepEqual(await opened.problems(), []);
  assert.equal(await page.evaluate(() => document.scripts.length - document.querySelectorAll("script[type='text/plain']").length), 2, "two scripts run: the loader, and the player that it starts");
  const shown = await page.evaluate(() => document.body.innerText);
  const count = shown.split("onerror=alert(1)").length - 1;
  assert.ok(count >= seen, `${count} hostile texts are shown`);
  await opened.close();
}

test("a hostile lesson stays a page", () => stays_a_page(make_lesson("hostile", lesson), 15));

test("a hostile scene stays a page", async () => {
  writeFileSync(join(temporary_folder, "hostile.toml"), `format = 1\ntitle = ${text}\n${scene}# ${meta}\n`);
  await stays_a_page(make_page("hostile-scene", "hostile.toml", "--no-film", "--title", meta, "--set", "simulation.gravity=[0,-5,0]",
    "--vary", "body.floor.friction=0.1,0.2", "--label", meta, "--label", "<b>two</b>"), 3);
});

test("TeX that writes HTML is refused", () => {
  writeFileSync(join(temporary_folder, "tex.md"), `+++\ntitle = "T"\nsummary = "S"\n+++\n\n$\\includegraphics{x.y'><meta http-equiv=refresh content='0;url=about:blank'>}$\n`);
  const { status, stderr } = run_tumble("lesson", "tex.md", "-o", "tex-site");
  assert.equal(status, 2);
  assert.match(stderr, /^tex\.md:6:2: error: TeX: \\includegraphics cannot stand in a page$/m);
});
