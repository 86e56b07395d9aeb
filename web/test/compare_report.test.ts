// The report of `tumble compare --report`: silent, with the right pixels in each view, usable by keyboard and by everyone.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import type { Page } from "playwright-core";
import { accessibility_faults } from "./accessibility.ts";
import { open_page, type OpenedPage, type PageOptions } from "./browser.ts";
import { save_picture, take_picture, type Picture } from "./picture.ts";
import { write_png, type Rgb } from "./png_file.ts";
import { run_tumble, temporary_folder } from "./program.ts";
import { controls_missed_by_tab } from "./tab_order.ts";

const wide = { width: 1280, height: 900 }, narrow = { width: 360, height: 740 };
const gray: Rgb = [100, 110, 120], red: Rgb = [200, 40, 30], black: Rgb = [0, 0, 0];
const width = 64, height = 48;
const hostile = `"><img src=x onerror=alert(1)>.png`;

/** A square of 16 pixels with its left edge at a column. */
const square = (left: number) => (x: number, y: number): Rgb => (x >= left && x < left + 16 && y >= 12 && y < 28 ? red : gray);

const report = join(temporary_folder, "report.html");
before(() => {
  const references = join(temporary_folder, "references"), images = join(temporary_folder, "images");
  mkdirSync(references);
  mkdirSync(images);
  const pair = (name: string, reference: (x: number, y: number) => Rgb, image: (x: number, y: number) => Rgb) => {
    write_png(join(references, name), width, height, reference);
    write_png(join(images, name), width, height, image);
  };
  for (const name of ["same_1.png", "same_2.png"]) pair(name, square(16), square(16));
  pair("moved.png", square(16), square(24));
  pair(hostile, square(16), (x, y) => (x < 8 && y < 8 ? [110, 110, 120] : square(16)(x, y)));
  pair("noise.png", square(16), (x, y) => (x === 40 && y === 40 ? [101, 110, 120] : square(16)(x, y)));
  write_png(join(references, "gone.png"), width, height, square(16));
  write_png(join(images, "extra.png"), width, height, square(24));
  pair("broken.png", square(16), square(16));
  writeFileSync(join(images, "broken.png"), "not a picture");
  assert.equal(run_tumble("compare", references, images, "--report", report, "--platform", "none").status, 2);
});

const open = (options: PageOptions = {}) => open_page(report, { ...wide, wait_for: "main", ...options });
const names = (page: Page) => page.locator(".list li:visible .name").allTextContents();
const shown = (page: Page) => page.locator("article:visible h2 .name").textContent();

async function show(page: Page, name: string): Promise<void> {
  await page.locator(".list a", { hasText: name }).first().click();
  assert.equal(await shown(page), name);
}

/** The color in the middle of a pixel of the picture in a frame of the viewer. */
async function color_at(page: Page, x: number, y: number, frame = 0): Promise<Rgb> {
  const place = await page.locator(".stage .layer").nth(frame).evaluate((layer, [column, row]) => {
    const scale = layer.getBoundingClientRect().width / layer.clientWidth, box = layer.getBoundingClientRect();
    const stage = layer.parentElement!.getBoundingClientRect();
    return [box.x - stage.x + (column + 0.5) * scale, box.y - stage.y + (row + 0.5) * scale];
  }, [x, y]);
  const picture: Picture = await take_picture(page.locator(".stage").nth(frame));
  const at = 4 * (Math.floor(place[1]) * picture.width + Math.floor(place[0]));
  return [...picture.data.slice(at, at + 3)] as Rgb;
}

async function view(page: Page, label: string): Promise<void> {
  await page.getByRole("button", { name: label, exact: true }).click();
}

for (const [name, options] of Object.entries<PageOptions>({
  "wide-light": wide, "wide-dark": { ...wide, dark: true }, "narrow-light": narrow, "narrow-dark": { ...narrow, dark: true },
})) {
  test(`silent, accessible and within the window, ${name}`, async () => {
    const opened = await open(options);
    const { page } = opened;
    for (const label of name === "wide-light" ? ["gone.png", "broken.png", "moved.png"] : ["moved.png"]) {
      await show(page, label);
      assert.deepEqual(await accessibility_faults(page), []);
      assert.ok(await page.evaluate(() => document.scrollingElement!.scrollWidth <= innerWidth), "the page is wider than the window");
    }
    await show(page, "moved.png");
    for (const label of ["Slider", "Blink", "Difference", "Perceived", "8 × 8 means", "Side by side"]) {
      await view(page, label);
      if (name === "wide-light") assert.deepEqual(await accessibility_faults(page), [], label);
    }
    await save_picture(page, `compare-report-${name}`);
    assert.deepEqual(await opened.problems(), []);
    await opened.close();
  });
}

test("worst first, with names as text", async () => {
  const opened = await open();
  const { page } = opened;
  assert.deepEqual(await names(page), ["broken.png", "gone.png", "moved.png", hostile, "extra.png", "noise.png"]);
  assert.deepEqual(await page.locator(".same li").allTextContents(), ["same_1.png", "same_2.png"]);
  assert.match((await page.locator("h1").textContent())!, /^5 of 8 pictures fail$/);
  assert.equal(await page.locator("article:visible").count(), 1);
  assert.equal(await page.evaluate(() => scrollY), 0);
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});

test("the policy allows the page's own script and style only", async () => {
  const policy = /Content-Security-Policy" content="([^"]*)"/.exec(readFileSync(report, "utf8"))![1];
  assert.match(policy, /^default-src 'none'; script-src 'sha256-[\w+/]{43}='; style-src 'sha256-[\w+/]{43}='; img-src data:; base-uri 'none'; form-action 'none'$/);
  const opened = await open();
  await opened.page.evaluate(() => document.body.insertAdjacentHTML("beforeend", `<img src=x onerror="document.title='run'">`));
  assert.ok((await opened.violations()).length > 0);
  assert.notEqual(await opened.page.title(), "run");
  await opened.close();
});

test("side by side shows the same part of both pictures, pixel by pixel", async () => {
  const opened = await open();
  const { page } = opened;
  await show(page, "moved.png");
  const check = async () => {
    assert.deepEqual(await color_at(page, 20, 20, 0), red);
    assert.deepEqual(await color_at(page, 20, 20, 1), gray);
    assert.deepEqual(await color_at(page, 36, 20, 0), gray);
    assert.deepEqual(await color_at(page, 36, 20, 1), red);
  };
  await check();
  await page.keyboard.press("c");
  await check();
  // Enlarged pixels have hard edges.
  for (const x of [16, 31]) assert.deepEqual(await color_at(page, x, 20, 0), red, `column ${x}`);
  assert.deepEqual(await color_at(page, 32, 20, 0), gray);
  const zoom = async () => Number((await page.locator(".zoom output").textContent())!.replace(" %", ""));
  const near = await zoom();
  await page.keyboard.press("f");
  assert.ok(near > await zoom());
  await opened.close();
});

test("the slider divides reference and image", async () => {
  const opened = await open();
  const { page } = opened;
  await show(page, "moved.png");
  await view(page, "Slider");
  const handle = page.getByRole("slider");
  await handle.focus();
  await page.keyboard.press("End");
  assert.equal(await handle.getAttribute("aria-valuenow"), "100");
  assert.deepEqual(await color_at(page, 20, 20), red);      // the reference
  assert.deepEqual(await color_at(page, 36, 20), gray);
  await page.keyboard.press("Home");
  assert.deepEqual(await color_at(page, 20, 20), gray);     // the image
  assert.deepEqual(await color_at(page, 36, 20), red);
  // Dragged to the middle of the picture, column 32.
  const box = (await page.locator(".stage").boundingBox())!;
  await page.mouse.move(box.x + 2, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2, box.y + 40, { steps: 4 });
  await page.mouse.up();
  assert.deepEqual(await color_at(page, 20, 20), red);
  assert.deepEqual(await color_at(page, 36, 20), red);
  await opened.close();
});

test("blinking swaps the pictures, and stands still where motion is reduced", async () => {
  const opened = await open({ reduced_motion: true });
  const { page } = opened;
  await show(page, "moved.png");
  await page.keyboard.press("3");
  const tag = page.locator(".stage .tag");
  await page.waitForTimeout(1200);   // of two swaps a second
  assert.equal(await tag.textContent(), "Reference");
  assert.deepEqual(await color_at(page, 20, 20), red);
  await page.locator(".stage").focus();
  await page.keyboard.press(" ");
  assert.equal(await tag.textContent(), "Image");
  assert.deepEqual(await color_at(page, 20, 20), gray);
  await opened.close();

  const moving = await open();
  await show(moving.page, "moved.png");
  await view(moving.page, "Blink");
  await moving.page.waitForFunction(() => document.querySelector(".stage .tag")!.textContent === "Image");
  await moving.page.waitForFunction(() => document.querySelector(".stage .tag")!.textContent === "Reference");
  await view(moving.page, "Pause");
  await view(moving.page, "Side by side");
  assert.deepEqual(await moving.problems(), []);
  await moving.close();
});

test("difference and heat maps are black where the pictures are equal", async () => {
  const opened = await open();
  const { page } = opened;
  await show(page, "moved.png");
  await view(page, "Difference");
  await page.getByLabel("Gain").selectOption("1");
  await page.waitForTimeout(100);
  assert.deepEqual(await color_at(page, 20, 20), [100, 70, 90]);
  assert.deepEqual(await color_at(page, 28, 20), black);
  await page.getByLabel("Gain").selectOption("4");
  await page.waitForTimeout(100);
  assert.deepEqual(await color_at(page, 20, 20), [255, 255, 255]);
  const cold: Rgb = [0, 0, 4];
  await view(page, "Perceived");
  assert.ok((await color_at(page, 20, 20))[0] > 180);
  assert.deepEqual(await color_at(page, 60, 44), cold);
  await view(page, "8 × 8 means");
  assert.deepEqual(await color_at(page, 20, 20), [252, 253, 191]);   // the largest mean
  assert.deepEqual(await color_at(page, 60, 44), cold);
  await opened.close();
});

test("keys and the filter choose images", async () => {
  const opened = await open();
  const { page } = opened;
  assert.equal(await shown(page), "broken.png");
  await page.keyboard.press("j");
  assert.equal(await shown(page), "gone.png");
  await page.keyboard.press("j");
  assert.equal(await shown(page), "moved.png");
  assert.match(page.url(), /#image-3$/);
  await page.keyboard.press("k");
  assert.equal(await shown(page), "gone.png");
  await page.getByRole("button", { name: "different 2" }).click();
  assert.deepEqual(await names(page), ["moved.png", hostile]);
  assert.equal(await shown(page), "moved.png");
  await page.keyboard.press("j");
  await page.keyboard.press("j");
  assert.equal(await shown(page), hostile);
  await page.getByRole("button", { name: "all 6" }).click();
  assert.equal((await names(page)).length, 6);
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});

test("rules have their figures, limits and places", async () => {
  const opened = await open();
  const { page } = opened;
  await show(page, "moved.png");
  const row = page.locator("article:visible tr", { hasText: "pixels beyond the tolerance" });
  assert.match((await row.textContent())!, /256 pixels\s*at most 1/);
  const before_zoom = await page.locator(".zoom output").textContent();
  await row.getByRole("button").click();
  assert.notEqual(await page.locator(".zoom output").textContent(), before_zoom);
  assert.match((await page.locator("article:visible .facts").textContent())!, /64 × 48 pixels.*256 pixels differ.*changed region 24 × 16 from x 16, y 12/);
  assert.ok(await page.locator("article:visible .perception dd").count() >= 5);
  await page.mouse.move(0, 0);
  await page.keyboard.press("f");
  const box = (await page.locator(".stage").first().boundingBox())!;
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction(() => /difference \d+/.test(document.querySelector(".readout")!.textContent!));
  assert.match((await page.locator(".readout").textContent())!, /reference 100 110 120.*image 200 40 30.*difference 100/);
  await opened.close();
});

test("each control is reached with the tab key", async () => {
  const opened = await open();
  await show(opened.page, "moved.png");
  assert.deepEqual(await controls_missed_by_tab(opened.page), []);
  await opened.close();
});

test("without scripts all pictures are shown", async () => {
  const opened: OpenedPage = await open({ java_script: false });
  const { page } = opened;
  assert.equal(await page.locator("article:visible").count(), 6);
  assert.equal(await page.locator("figure:visible").count(), 1 + 1 + 4 + 4 + 1 + 4);
  await opened.close();
});
