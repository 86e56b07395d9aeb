// The player in a browser: keys, agreement of its parts, accessibility, and pages without WebGL or motion.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import type { Page } from "playwright-core";
import type { TumbleApi } from "../src/ui/api.ts";
import { no_webgl, open_page, type PageOptions } from "./browser.ts";
import { repository } from "./paths.mjs";
import { save_picture } from "./picture.ts";
import { make_player_page } from "./player_page.ts";
import { ball_at, bounces } from "./synthetic_clip.ts";

declare const tumble: TumbleApi;
declare const axe: { run(root: Document, options: object): Promise<{ violations: { id: string; impact: string; nodes: { html: string }[] }[] }> };

const restitution = 0.5;
let page_path = "";
before(async () => { page_path = await make_player_page("page", [{ layout: "page", plot: "energy,body.ball.y" }]); });

async function with_player(options: PageOptions, run: (page: Page) => Promise<void>, path = page_path): Promise<void> {
  const opened = await open_page(path, { width: 1100, height: 700, ...options });
  try {
    await run(opened.page);
    if (!options.args) assert.deepEqual(await opened.problems(), []);
  } finally {
    await opened.close();
  }
}

const press = async (page: Page, ...keys: string[]): Promise<void> => { for (const key of keys) await page.keyboard.press(key); };
const shown = (page: Page) => page.evaluate(() => ({ time: tumble.time, frame: tumble.frame, cursor: tumble.cursor() }));
const live_text = (page: Page) => page.textContent("[role=status].tp-visually-hidden");
/** Equal pictures have equal numbers. */
const picture_number = (page: Page) => page.evaluate(() => tumble.pixels()!.data.reduce((hash, byte) => (Math.imul(hash, 31) + byte) | 0, 7));

test("the keys of the help move the time, the speed and the view", () => with_player({}, async (page) => {
  await page.focus(".tp-stage");
  await press(page, "ArrowRight", "ArrowRight", "ArrowRight", "ArrowLeft");
  assert.equal((await shown(page)).frame, 2);
  await press(page, "End");
  assert.equal((await shown(page)).time, 3);
  await press(page, "Home");
  assert.equal((await shown(page)).time, 0);
  await press(page, "Shift+ArrowRight", "Shift+ArrowRight");
  assert.ok(Math.abs((await shown(page)).time - bounces(restitution, 3)[0].time) < 1e-9, "at the first bounce");
  assert.match((await live_text(page))!, /^Impact 5 at 0\.5711 s: ball on ground, impulse 8\.40 N s$/);
  const speed = () => page.evaluate(() => tumble.state("ball").velocity[1]);
  const after = await speed();
  await press(page, "b");
  assert.ok(Math.abs((await speed()) + after / restitution) < 1e-9, "before the bounce");
  await press(page, "ArrowUp");
  assert.equal(await page.inputValue("select.tp-speed"), "2");
  const chosen = () => page.evaluate(() => tumble.player.state.get("body"));
  const first = await chosen();
  await press(page, "n");
  assert.notEqual(await chosen(), first);
  await press(page, "Shift+N");
  assert.equal(await chosen(), first);

  const start = await picture_number(page);
  for (const key of ["Alt+ArrowLeft", "Alt+Shift+ArrowUp", "+", "f"]) {
    const last = await picture_number(page);
    await press(page, key);
    if (key !== "f") assert.notEqual(await picture_number(page), last, key);
  }
  await press(page, "r");
  assert.equal(await picture_number(page), start, "the view is back");

  await press(page, "?");
  assert.ok(await page.isVisible("dialog.tp-help"));
  await press(page, "Escape");
  assert.ok(!(await page.isVisible("dialog.tp-help")));
  await press(page, "o");
  assert.equal(await page.evaluate(() => document.activeElement!.closest(".tp-overlays") !== null), true);
  await press(page, "p");
  assert.equal(await page.evaluate(() => document.activeElement!.closest(".tp-panels") !== null), true);
}));

test("the tab key reaches every control, and each shows its focus", () => with_player({}, async (page) => {
  await page.evaluate(() => document.querySelectorAll("details").forEach((each) => { each.open = true; }));
  await page.click(".tp-more");
  await page.evaluate(() => { (document.activeElement as HTMLElement).blur(); });
  const wanted = await page.evaluate(() => {
    const all = [...document.querySelectorAll<HTMLElement>("button, select, summary, a[href], [tabindex='0']")];
    const visible = all.filter((each) => each.checkVisibility() && !each.closest("dialog"));
    visible.forEach((each, index) => { each.dataset.order = String(index); });
    return visible.length;
  });
  const reached = new Set<string>();
  for (let i = 0; i < wanted + 5; i += 1) {
    await press(page, "Tab");
    const focused = await page.evaluate(() => {
      const element = document.activeElement as HTMLElement;
      return { order: element.dataset.order, outline: getComputedStyle(element).outlineStyle, html: element.outerHTML.slice(0, 80) };
    });
    if (focused.order === undefined) continue;
    assert.notEqual(focused.outline, "none", `${focused.html} shows its focus`);
    reached.add(focused.order);
  }
  const missed = await page.evaluate((found) => [...document.querySelectorAll<HTMLElement>("[data-order]")]
    .filter((each) => !found.includes(each.dataset.order!)).map((each) => each.outerHTML.slice(0, 80)), [...reached]);
  assert.deepEqual(missed, []);
}));

test("stage, table, plot and slider agree on the time", () => with_player({}, async (page) => {
  for (const time of [0, 0.123, 1 / 3, bounces(restitution, 3)[0].time, 2.71828, 3]) {
    const now = await page.evaluate((t) => {
      tumble.seek(t);
      const cell = (row: number, column: number) => document.querySelectorAll(".tp-state-table tr")[row].querySelectorAll(".tp-numbers span")[column];
      return {
        cursor: tumble.cursor()!, y: tumble.pose("ball").position[1], table: cell(0, 1).textContent,
        slider: document.querySelector(".tp-scrub")!.getAttribute("aria-valuetext"), legend: document.querySelectorAll(".tp-values")[1].textContent,
      };
    }, time);
    const height = ball_at(restitution, time).height + 0.25;
    assert.ok(Math.abs(now.y - height) < 1e-9, `height at ${time} s`);
    assert.ok(Math.abs(now.cursor - time) < 1e-6, `plot at ${now.cursor} s, not ${time} s`);
    assert.equal(now.table, height.toPrecision(6));
    assert.ok(now.legend!.includes(`${height.toPrecision(4)} m`), now.legend!);
    assert.equal(now.slider, `${Number(time.toFixed(3))} s, frame ${Math.floor(time * 60 + 1e-6)}`);
  }
}));

test("dragging in a plot and on the slider sets the time", () => with_player({}, async (page) => {
  for (const [selector, start, end] of [[".u-over", 0, 3], [".tp-track", 0, 3]] as const) {
    const box = (await page.locator(selector).first().boundingBox())!;
    await page.mouse.move(box.x + box.width * 0.2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.75, box.y + box.height / 2, { steps: 3 });
    await page.mouse.up();
    const { time, cursor } = await shown(page);
    assert.ok(Math.abs(time - (start + 0.75 * (end - start))) < 0.02, `${selector}: ${time} s`);
    assert.ok(Math.abs(cursor! - time) < 1e-6);
    await page.mouse.move(box.x, box.y + box.height / 2);
    assert.equal((await shown(page)).time, time, "no drag without a button");
  }
}));

test("an impact of the list is sought and its impulse computed", () => with_player({}, async (page) => {
  await page.focus(".tp-impacts-table tr[tabindex='0']");
  await press(page, "ArrowDown", "ArrowDown", "ArrowDown", "ArrowDown", "Enter");
  assert.ok(Math.abs((await shown(page)).time - bounces(restitution, 3)[0].time) < 1e-9);
  const card = (await page.textContent(".tp-card"))!;
  assert.match(card, /Impact 5: ball on ground/);
  assert.match(card, /residual (0|[\d.]+\u00b710\u207b\u00b9[\u2074-\u2079])\./);
}));

test("an impact among others shows its row of the joint equations", () => with_player({}, async (page) => {
  await page.focus(".tp-impacts-table tr[tabindex='0']");
  await press(page, "ArrowDown", "Enter");
  const card = (await page.textContent(".tp-card"))!;
  assert.match(card, /Impact 2: box on ground/);
  assert.match(card, /4 impulses act on these bodies together\. Eq\. 20 holds for one alone/);
  assert.equal(await page.locator(".tp-shares tbody tr").count(), 4);
  assert.equal(await page.locator(".tp-shares .tp-own th").textContent(), "2");
  assert.match(card, /residual (0|[\d.]+\u00b710\u207b\u00b9[\u2074-\u2079])\./);
  assert.doesNotMatch(card, /act on these bodies in the same step/);
  await save_picture(page, "card_of_an_impact_among_others");
}));

test("the vertical axis of a plot has its unit", () => with_player({}, async (page) => {
  assert.deepEqual(await page.locator(".tp-axis-unit").allTextContents(), ["J", "m"]);
}));

test("on paper everything stays within the margins, and plots are there", () => with_player({ width: 1400 }, async (page) => {
  await page.focus(".tp-impacts-table tr[tabindex='0']");
  await press(page, "ArrowDown", "Enter");
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  await page.emulateMedia({ media: "print" });
  await page.setViewportSize({ width: 700, height: 990 });   // A4 between the margins of browsers
  const outside = await page.evaluate(() => [...document.querySelectorAll("main *")]
    .filter((element) => element.checkVisibility() && element.getBoundingClientRect().right > innerWidth + 1)
    .map((element) => `${element.localName}.${element.className}`));
  assert.deepEqual(outside, []);
  assert.ok(await page.locator(".tp-plot canvas").first().isVisible());
  await save_picture(page, "paper");
  await page.emulateMedia({ media: "screen" });
  await page.evaluate(() => dispatchEvent(new Event("afterprint")));
}));

test("space plays to the end and the time stands there; impacts are not spoken meanwhile", () => with_player({}, async (page) => {
  await page.evaluate(() => tumble.player.state.set({ time: 2.5, speed: 4 }));
  await page.focus(".tp-stage");
  await press(page, " ");
  await page.waitForFunction(() => !tumble.player.state.get("playing"));
  assert.equal((await shown(page)).time, 3);
  assert.equal(await live_text(page), "");
}));

test("runs are chosen and compared", () => with_player({}, async (page) => {
  await page.click("text=restitution 0.8");
  assert.equal(await page.evaluate(() => tumble.impacts.filter((impact) => impact.a === "ball" || impact.b === "ball")[0].restitution), 0.8);
  await page.click("text=Ghosts");
  assert.match((await page.locator(".tp-values").nth(1).textContent())!, /restitution 0\.8.*restitution 0\.5/);
  await page.evaluate(() => tumble.select_run(0));
  assert.match((await page.locator(".tp-values").nth(1).textContent())!, /restitution 0\.5.*restitution 0\.8/);
}));

for (const width of [1280, 360]) {
  for (const dark of [false, true]) {
    test(`accessibility at ${width} pixels, ${dark ? "dark" : "light"}`, () => with_player({ width, height: 740, dark }, async (page) => {
      await page.evaluate(() => {
        document.querySelectorAll("details").forEach((each) => { each.open = true; });
        tumble.player.actions.step_impact(1);
      });
      await page.evaluate(readFileSync(join(repository, "web/node_modules/axe-core/axe.min.js"), "utf8"));
      const { violations } = await page.evaluate(() => axe.run(document, { preload: false }));
      const grave = violations.filter((each) => each.impact === "serious" || each.impact === "critical");
      assert.deepEqual(grave.map((each) => `${each.id}: ${each.nodes[0].html.slice(0, 120)}`), []);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "no horizontal overflow");
      await save_picture(page, `player-${width}-${dark ? "dark" : "light"}`);
    }));
  }
}

test("without WebGL the fallback stays, and plots, table and impacts work", () => with_player({ args: no_webgl }, async (page) => {
  assert.equal(await page.getAttribute("html", "data-player"), "no-webgl");
  assert.ok(await page.isVisible(".tp-stage .tp-note"));
  assert.ok(await page.isVisible("text=The film of the clip."));
  await page.focus(".tp-stage");
  await press(page, "Shift+ArrowRight", "Shift+ArrowRight");
  const { time, cursor } = await shown(page);
  assert.ok(Math.abs(time - cursor!) < 1e-6);
  assert.match((await page.textContent(".tp-card"))!, /Impact 5/);
}));

test("with reduced motion nothing plays by itself and nothing glides", () => with_player({ reduced_motion: true }, async (page) => {
  const gliding = await page.evaluate(() => [...document.querySelectorAll("*")]
    .filter((each) => getComputedStyle(each).transitionDuration !== "0s" || getComputedStyle(each).animationName !== "none").length);
  assert.equal(gliding, 0);
  assert.equal(await page.evaluate(() => tumble.player.state.get("playing")), false);
}));

test("equations have the page's own font", () => with_player({}, async (page) => {
  await page.evaluate(() => tumble.player.actions.go_to_impact(4));
  const client = await page.context().newCDPSession(page);
  await client.send("DOM.enable");
  await client.send("CSS.enable");
  const { root } = await client.send("DOM.getDocument");
  const { nodeIds } = await client.send("DOM.querySelectorAll", { nodeId: root.nodeId, selector: "math mi, math mo, math mn, math mtext" });
  assert.ok(nodeIds.length > 50);
  for (const nodeId of nodeIds) {
    const { fonts } = await client.send("CSS.getPlatformFontsForNode", { nodeId });
    const others = fonts.filter((font) => !font.isCustomFont);
    assert.deepEqual(others.map((font) => font.familyName), [], (await client.send("DOM.getOuterHTML", { nodeId })).outerHTML);
  }
}));

test("paper is light, and the page dark again after it", () => with_player({ dark: true }, async (page) => {
  const dark = await picture_number(page);
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  assert.equal(await page.getAttribute("html", "data-theme"), "light");
  assert.notEqual(await picture_number(page), dark);
  await page.evaluate(() => dispatchEvent(new Event("afterprint")));
  assert.equal(await picture_number(page), dark);
}));

test("of many players at most eight have a stage, and the ones in view do", async () => {
  const path = await make_player_page("many", Array.from({ length: 12 }, () => ({ layout: "lesson" })));
  await with_player({ width: 500, height: 400 }, async (page) => {
    const live = () => page.locator(".tp-stage[data-stage=live]").count();
    for (let i = 0; i < 12; i += 1) {
      await page.locator(".tp-stage").nth(i).scrollIntoViewIfNeeded();
      await page.locator(".tp-stage").nth(i).and(page.locator("[data-stage=live]")).waitFor();
      assert.ok((await live()) <= 8);
    }
    await page.locator(".tp-stage").first().scrollIntoViewIfNeeded();
    await page.locator(".tp-stage").first().and(page.locator("[data-stage=live]")).waitFor();
    assert.equal(await page.evaluate(() => tumble.players.length), 12);
  }, path);
});
