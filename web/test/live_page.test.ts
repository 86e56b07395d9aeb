// Live pages in Chromium: sliders and the scene's text give new runs, with the bytes of the program; without the simulation
// the recorded run stays, and a sentence says why.
import assert from "node:assert/strict";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import type { Page } from "playwright-core";
import { accessibility_faults } from "./accessibility.ts";
import { launch, no_webgl, open_page, type OpenedPage } from "./browser.ts";
import { make_page, shown_poses } from "./made_page.ts";
import { save_picture } from "./picture.ts";
import { player_folder } from "./paths.mjs";
import { temporary_folder } from "./program.ts";
import { controls_missed_by_tab } from "./tab_order.ts";

const skip = existsSync(join(player_folder, "live-page.html")) ? false : "there is no build/web/live-page.html (scripts/build-web --live)";

const scene = `format = 1
title = "A ball"

[simulation]
duration = 2.0
impacts = "exact"
gravity = [0.0, -9.81, 0.0]

[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }

[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.1 }
position = [0.0, 1.1, 0.0]
restitution = 0.5
`;

let path = "", plain = "";
before(() => {
  if (skip) return;
  writeFileSync(join(temporary_folder, "ball.toml"), scene);
  plain = make_page("plain", "ball.toml", "--no-film");
  path = make_page("live", "ball.toml", "--no-film", "--live", "body.ball.restitution", "simulation.gravity.1=-20:0:0.01",
    "simulation.impacts=exact,stepped");
});

const panel = (page: Page) => page.locator(".tp-live");
const status = (page: Page) => page.locator(".tp-live-status").innerText();

async function ready(opened: OpenedPage): Promise<Page> {
  await opened.page.waitForSelector('.tp-live[data-live="ready"]');
  return opened.page;
}

/** Waits for the next whole run after the action. */
async function run_after(page: Page, action: () => Promise<unknown>): Promise<void> {
  const runs = async () => Number((await panel(page).getAttribute("data-runs")) ?? 0);
  const count = await runs();
  await action();
  await page.waitForFunction((least) => Number(document.querySelector<HTMLElement>(".tp-live")!.dataset.runs ?? 0) > least, count);
}

const times = [0, 0.3, 0.7, 1.234, 2];

test("a slider, by keyboard, gives the program's run", { skip }, async () => {
  const opened = await open_page(path, { width: 1280, height: 900 });
  const page = await ready(opened);
  const slider = page.getByLabel("restitution of ball");
  await slider.focus();
  for (let i = 0; i < 3; ++i) await run_after(page, () => slider.press("ArrowRight"));
  assert.equal(await slider.getAttribute("aria-valuetext"), "0.65");
  await page.getByText("Show the command").click();
  const command = await page.locator(".tp-live-command").innerText();
  assert.equal(command, "tumble simulate ball.toml --set body.ball.restitution=0.65");
  const expected_page = await open_page(make_page("expected", "ball.toml", "--no-film", "--set", "body.ball.restitution=0.65"));
  assert.deepEqual(await shown_poses(page, ["ball"], times), await shown_poses(expected_page.page, ["ball"], times));
  const impacts = (each: Page) => each.evaluate(() => window.tumble.impacts.map(({ time, impulse }) => [time, impulse]));
  assert.deepEqual(await impacts(page), await impacts(expected_page.page));
  await save_picture(page, "live-slider");
  assert.deepEqual(await opened.problems(), []);
  await expected_page.close();
  await opened.close();
});

test("reset shows the recorded run again, and a kept run stays as a second one", { skip }, async () => {
  const opened = await open_page(path);
  const page = await ready(opened);
  const recorded = await shown_poses(page, ["ball"], times);
  await run_after(page, () => page.locator(".tp-live").getByLabel("impacts", { exact: true }).selectOption("stepped"));
  await page.getByRole("button", { name: "Keep for comparison" }).click();
  assert.equal((await page.evaluate(() => window.tumble.runs)).length, 2);
  await run_after(page, () => page.getByLabel("restitution of ball").press("End"));
  assert.deepEqual(await page.locator('.tp-live [aria-label="Run"] > .tp-segment').allTextContents(),
    ["restitution 1.00, impacts stepped", "kept: impacts stepped"]);
  await save_picture(page, "live-kept");
  await page.getByRole("button", { name: "Clear the comparison" }).click();
  await page.getByRole("button", { name: "Reset", exact: true }).click();
  assert.deepEqual(await shown_poses(page, ["ball"], times), recorded);
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});

test("the text of the scene: mistakes have a place, other bodies have a player", { skip }, async () => {
  const opened = await open_page(path, { width: 1280, height: 900 });
  const page = await ready(opened);
  await page.getByText("Change the scene").click();
  const area = page.getByLabel("Text of ball.toml");
  await area.fill(scene.replace("duration = 2.0", "duration = -2.0"));
  await page.waitForSelector('.tp-live-text[aria-invalid="true"]');
  assert.match(await page.locator(".tp-live-mistake").innerText(), /^Line 5, column 12: duration/);
  await run_after(page, () => area.fill(`${scene}\n[[body]]\nname = "second"\nshape = { type = "sphere", radius = 0.1 }\nposition = [0.5, 0.8, 0.0]\n`));
  assert.equal(await page.locator("figure.tumble-player").count(), 1);
  assert.equal(await page.locator(".tp-live-mistake").isVisible(), false);
  assert.match(await page.locator(".tp-panel-state").innerText(), /second/);
  await save_picture(page, "live-editor");
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});

test("a newer run makes an older one void, and a long one can be stopped", { skip }, async () => {
  writeFileSync(join(temporary_folder, "long.toml"), scene.replace("duration = 2.0", "duration = 20.0\nsteps_per_frame = 800").replace('"exact"', '"stepped"'));
  const long = make_page("long", "long.toml", "--no-film", "--live", "body.ball.restitution");
  const opened = await open_page(long);
  const page = await ready(opened);
  const slider = page.getByLabel("restitution of ball");
  for (let i = 0; i < 5; ++i) await slider.press("ArrowRight");
  const stop = page.getByRole("button", { name: "Stop" });
  await stop.waitFor();
  await stop.click();
  await page.waitForFunction(() => /^Stopped/.test(document.querySelector(".tp-live-status")!.textContent!));
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});

test("a page saved with its settings opens with them", { skip }, async () => {
  const opened = await open_page(path);
  const page = await ready(opened);
  await run_after(page, () => page.getByLabel("restitution of ball").press("Home"));
  const shown = await shown_poses(page, ["ball"], times);
  const [download] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", { name: "Save the page" }).click()]);
  const saved = join(temporary_folder, "saved.html");
  await download.saveAs(saved);
  await opened.close();
  const again = await open_page(saved);
  await again.page.waitForSelector('.tp-live[data-runs="1"]');
  assert.deepEqual(await shown_poses(again.page, ["ball"], times), shown);
  assert.deepEqual(await again.problems(), []);
  await again.close();
});

/** The page with another text, which stands once in it. */
function changed(name: string, ...replacements: [string | RegExp, string][]): string {
  let html = readFileSync(path, "utf8");
  for (const [from, to] of replacements) {
    const after = html.replace(from, () => to);
    assert.notEqual(after, html, `${from}`);
    html = after;
  }
  const file = join(temporary_folder, `${name}.html`);
  writeFileSync(file, html);
  return file;
}

async function refused(file: string, reason: RegExp): Promise<OpenedPage> {
  const opened = await open_page(file);
  await opened.page.waitForSelector('.tp-live[data-live="refused"]');
  assert.match(await status(opened.page), reason);
  assert.match(await status(opened.page), /The recorded run is shown\.$/);
  assert.ok(await opened.page.getByLabel("restitution of ball").isDisabled());
  assert.equal(await opened.player_state(), "ready");
  assert.deepEqual(opened.errors, []);
  return opened;
}

test("a policy that forbids WebAssembly leaves the recorded run", { skip }, async () => {
  const opened = await refused(changed("no-eval", [" 'wasm-unsafe-eval'", ""]), /forbids simulations/);
  await opened.close();
});

test("a policy that forbids workers leaves the recorded run", { skip }, async () => {
  const opened = await refused(changed("no-worker", ["worker-src blob:", "worker-src 'none'"]), /refuses to start the simulation/);
  await opened.close();
});

test("a browser without WebAssembly leaves the recorded run", { skip }, async () => {
  const browser = await launch();
  const context = await browser.newContext({ offline: true, locale: "en-US", viewport: { width: 640, height: 360 } });
  await context.addInitScript(() => { Object.defineProperty(globalThis, "WebAssembly", { value: undefined }); });
  const page = await context.newPage();
  await page.goto(`file://${path}`);
  await page.waitForSelector('.tp-live[data-live="refused"]');
  assert.match(await status(page), /no WebAssembly/);
  await context.close();
});

test("a browser without vectors leaves the recorded run", { skip }, async () => {
  const browser = await launch();
  const context = await browser.newContext({ offline: true, locale: "en-US", viewport: { width: 640, height: 360 } });
  await context.addInitScript(() => { WebAssembly.validate = () => false; });
  const page = await context.newPage();
  await page.goto(`file://${path}`);
  await page.waitForSelector('.tp-live[data-live="refused"]');
  assert.match(await status(page), /too old/);
  await context.close();
});

test("without WebGL the tables follow the sliders", { skip }, async () => {
  const opened = await open_page(path, { args: no_webgl });
  const page = await ready(opened);
  await run_after(page, () => page.getByLabel("restitution of ball").press("End"));
  assert.equal(await opened.player_state(), "no-webgl");
  await opened.close();
});

for (const [name, options] of Object.entries({ wide: { width: 1280, height: 900 }, narrow: { width: 360, height: 700 } })) {
  for (const dark of [false, true]) {
    test(`usable by everyone, ${name}${dark ? ", dark" : ""}`, { skip }, async () => {
      const opened = await open_page(path, { ...options, dark });
      const page = await ready(opened);
      await page.getByText("Change the scene").click();
      await page.getByText("Show the command").click();
      assert.deepEqual(await accessibility_faults(page), []);
      assert.deepEqual(await controls_missed_by_tab(page), []);
      assert.ok(await page.evaluate(() => document.scrollingElement!.scrollWidth <= innerWidth), "the page is wider than the window");
      await panel(page).scrollIntoViewIfNeeded();
      await save_picture(page, `live-${name}${dark ? "-dark" : ""}`);
      await opened.close();
    });
  }
}

test("pages without --live have neither the simulation nor its permissions", { skip }, () => {
  const html = readFileSync(plain, "utf8");
  assert.doesNotMatch(html, /wasm-unsafe-eval|worker-src|tumble-live/);
});
