// A page of `tumble page`: silent, drawn, in agreement with itself, usable by keyboard, by everyone and without WebGL.
import assert from "node:assert/strict";
import { statSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import type { Page } from "playwright-core";
import { accessibility_faults } from "./accessibility.ts";
import { no_webgl, open_page, type OpenedPage, type PageOptions } from "./browser.ts";
import { make_page } from "./made_page.ts";
import { colors, different_pixels, save_picture, take_picture, variance } from "./picture.ts";
import { scenes_folder } from "./program.ts";
import { controls_missed_by_tab } from "./tab_order.ts";

const wide = { width: 1280, height: 720 }, narrow = { width: 360, height: 640 };
let balls = "", boxes = "";
before(() => {
  balls = make_page("balls", join(scenes_folder, "bouncing_balls.toml"), "--set", "simulation.impacts=exact", "--overlay", "com,velocity");
  boxes = make_page("boxes", join(scenes_folder, "falling_boxes.toml"));
});

const stage = (opened: OpenedPage) => opened.page.locator("figure.tumble-player canvas").first();
const shown_time = (page: Page) => page.evaluate(() => window.tumble.time);

for (const [name, options] of Object.entries<PageOptions>({
  "wide-light": wide, "wide-dark": { ...wide, dark: true }, "narrow-light": narrow, "narrow-dark": { ...narrow, dark: true },
})) {
  test(`silent and drawn, ${name}`, async () => {
    const opened = await open_page(balls, options);
    const { page } = opened;
    assert.equal(await opened.player_state(), "ready");
    await page.evaluate(() => window.tumble.seek(1.3));
    const picture = await take_picture(stage(opened));
    assert.ok(variance(picture) > 100 && colors(picture) > 500, `variance ${variance(picture)}, ${colors(picture)} colors`);
    // Away and back.
    await page.evaluate(() => window.tumble.seek(0.4));
    assert.ok(different_pixels(picture, await take_picture(stage(opened)), 8) > 100);
    await page.evaluate(() => window.tumble.seek(1.3));
    assert.equal(different_pixels(picture, await take_picture(stage(opened))), 0);
    assert.ok(await page.evaluate(() => document.scrollingElement!.scrollWidth <= innerWidth), "the page is wider than the window");
    await save_picture(page, `balls-${name}`);
    assert.deepEqual(await opened.problems(), []);
    await opened.close();
  });
}

test("dark and light backgrounds", async () => {
  for (const dark of [false, true]) {
    const opened = await open_page(balls, { ...narrow, dark });
    const background = await opened.page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/[\d.]+/g)!.slice(0, 3).map(Number));
    const mean = background.reduce((sum, value) => sum + value, 0) / 3;
    assert.ok(dark ? mean < 70 : mean > 200, `${background}`);
    await opened.close();
  }
});

test("stage, table, plot and slider agree", async () => {
  const opened = await open_page(balls, { ...wide, height: 1600 });
  for (const time of [0, 0.3, 1.23456, 2.5, 4.4444, 6]) {
    const seen = await opened.page.evaluate((t) => {
      const tumble = window.tumble;
      tumble.seek(t);
      const body = tumble.player.state.get("body")!;
      const numbers = [...document.querySelectorAll(".tp-state-table tr:first-child .tp-numbers span")].slice(0, 3);
      return {
        pose: tumble.pose(tumble.bodies[body]).position,
        table: numbers.map((cell) => Number(cell.textContent!.replace("\u2212", "-"))),
        marked: tumble.arrows().com.map((arrow) => arrow.from),
        cursor: tumble.cursor(),
        slider: Number(document.querySelector("[role=slider]")!.getAttribute("aria-valuenow")),
      };
    }, time);
    const near = (a: number[], b: number[], tolerance: number) => a.every((value, i) => Math.abs(value - b[i]) <= tolerance);
    assert.ok(near(seen.table, seen.pose, 1e-5), `table ${seen.table}, pose ${seen.pose}`);
    assert.ok(seen.marked.some((point) => near([...point], seen.pose, 1e-6)), `stage ${seen.marked}, pose ${seen.pose}`);
    assert.ok(seen.cursor !== null && Math.abs(seen.cursor - time) < 1e-3, `plot ${seen.cursor}`);
    assert.ok(Math.abs(seen.slider - time) <= 5e-4, `slider ${seen.slider}`);
  }
  await opened.close();
});

test("the drawn ball is where its pose is", async () => {
  const opened = await open_page(balls, wide);
  for (const time of [0, 0.7, 1.9, 3.3]) {
    const { drawn, expected } = await opened.page.evaluate(red_ball_on_picture, time);
    assert.ok(Math.hypot(drawn[0] - expected[0], drawn[1] - expected[1]) < 4, `drawn at ${drawn}, expected at ${expected}`);
  }
  await opened.close();
});

// Runs in the page. Pixels from the top left: the center of the red ball as drawn, and its center of mass seen by the camera.
function red_ball_on_picture(time: number): { drawn: number[]; expected: number[] } {
  const tumble = window.tumble;
  tumble.player.state.set({ overlays: new Set() });
  tumble.seek(time);
  const { width, height, data } = tumble.pixels()!;
  let count = 0, x = 0, y = 0;
  for (let i = 0; i < width * height; ++i) {
    const [r, g, b] = data.subarray(4 * i, 4 * i + 3);
    if (r > 1.8 * g && b > g && r > 100) {   // the orange ball beside it has more green than blue
      ++count;
      x += i % width;
      y += Math.floor(i / width);
    }
  }
  const { eye, target, up, vertical_fov } = tumble.player.state.run.scene.camera(time);
  const minus = (a: number[], b: number[]) => a.map((value, i) => value - b[i]);
  const dot = (a: number[], b: number[]) => a.reduce((sum, value, i) => sum + value * b[i], 0);
  const cross = (a: number[], b: number[]) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const unit = (a: number[]) => a.map((value) => value / Math.hypot(...a));
  const forward = unit(minus(target, eye)), right = unit(cross(forward, up)), top = cross(right, forward);
  const to = minus(tumble.pose("e = 0.95").position, eye);
  const scale = height / 2 / Math.tan((vertical_fov * Math.PI) / 360) / dot(to, forward);
  return { drawn: [x / count, y / count], expected: [width / 2 + scale * dot(to, right), height / 2 - scale * dot(to, top)] };
}

test("everything by keyboard alone", async () => {
  const opened = await open_page(balls, wide);
  const { page } = opened;
  assert.deepEqual(await controls_missed_by_tab(page), []);
  await page.evaluate(() => document.querySelector<HTMLElement>(".tp-stage")!.focus());
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  assert.ok(Math.abs(await shown_time(page) - 2 / 60) < 1e-12);
  await page.keyboard.press("ArrowLeft");
  assert.ok(Math.abs(await shown_time(page) - 1 / 60) < 1e-12);
  await page.keyboard.press("Shift+ArrowRight");
  const first = await page.evaluate(() => window.tumble.impacts[0].time);
  assert.ok(Math.abs(first - Math.sqrt(2 * 3.26 / 9.81)) < 1e-9);
  assert.ok(Math.abs(await shown_time(page) - first) < 1e-12);
  await page.keyboard.press("End");
  assert.equal(await shown_time(page), 6);
  await page.keyboard.press("Home");
  await page.keyboard.press(" ");
  await page.waitForFunction(() => window.tumble.time > 0.05);
  await page.keyboard.press(" ");
  const paused = await shown_time(page);
  await page.waitForTimeout(200);
  assert.equal(await shown_time(page), paused);
  const picture = await take_picture(stage(opened));
  for (const key of ["Alt+ArrowLeft", "Alt+ArrowUp", "+"]) await page.keyboard.press(key);
  const turned = await take_picture(stage(opened));
  assert.ok(different_pixels(picture, turned, 8) > 1000);
  await page.keyboard.press("r");
  assert.ok(different_pixels(picture, await take_picture(stage(opened)), 8) < 100);
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});

test("nothing for the accessibility checker to find", async () => {
  for (const options of [wide, { ...wide, dark: true }, narrow]) {
    const opened = await open_page(balls, options);
    assert.deepEqual(await accessibility_faults(opened.page), []);
    await opened.close();
  }
});

test("nothing plays by itself", async () => {
  const opened = await open_page(balls, { reduced_motion: true });
  await opened.page.waitForTimeout(300);
  assert.equal(await shown_time(opened.page), 0);
  assert.equal(await opened.page.evaluate(() => document.getAnimations().length), 0);
  await opened.close();
});

test("without WebGL the film, the plots and the table", async () => {
  const opened = await open_page(balls, { ...wide, args: no_webgl });
  assert.equal(await opened.player_state(), "no-webgl");
  const { page } = opened;
  assert.ok(await page.locator("video").isVisible());
  assert.ok(await page.locator("video").evaluate((video: HTMLVideoElement) => video.poster.startsWith("data:image/")));
  assert.ok(await page.locator(".tp-note:visible").first().isVisible());
  await page.evaluate(() => window.tumble.seek(2));
  assert.ok(Math.abs((await page.evaluate(() => window.tumble.cursor()))! - 2) < 1e-3);
  assert.deepEqual([...opened.requests, ...opened.errors, ...(await opened.violations())], []);
  await save_picture(page, "balls-no-webgl");
  await opened.close();
});

test("without script the film and the scene", async () => {
  const opened = await open_page(balls, { ...wide, java_script: false, wait_for: "" });
  assert.ok(await opened.page.locator("video").isVisible());
  assert.ok(await opened.page.getByText("Bouncing balls").first().isVisible());
  await save_picture(opened.page, "balls-no-script");
  await opened.close();
});

test("one context of WebGL, lost and restored", async () => {
  const opened = await open_page(balls);
  const { page } = opened;
  const picture = await take_picture(stage(opened));
  await page.evaluate(async () => {
    const canvas = document.querySelector<HTMLCanvasElement>("figure.tumble-player .tp-stage-host canvas")!;
    const extension = canvas.getContext("webgl2")!.getExtension("WEBGL_lose_context")!;
    extension.loseContext();
    await new Promise((resolve) => setTimeout(resolve, 100));
    const restored = new Promise((resolve) => canvas.addEventListener("webglcontextrestored", resolve, { once: true }));
    extension.restoreContext();
    await restored;
    await new Promise(requestAnimationFrame);
    await new Promise(requestAnimationFrame);
  });
  assert.ok(different_pixels(picture, await take_picture(stage(opened)), 8) < 50);
  await opened.close();
});

test("a page of 100 bodies, its size and its motion", async () => {
  assert.ok(statSync(boxes).size < 1.5e6, `${statSync(boxes).size} bytes`);
  const opened = await open_page(boxes, narrow);
  const data = await opened.page.evaluate(() => document.querySelector("script.tumble-clip")!.textContent!.length);
  assert.ok(data < 5e5, `${data} bytes of data`);
  const picture = await take_picture(stage(opened));
  await opened.page.evaluate(() => window.tumble.seek(5));
  assert.ok(different_pixels(picture, await take_picture(stage(opened)), 8) > 1000);
  await save_picture(opened.page, "boxes-narrow");
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});
