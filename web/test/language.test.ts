// The player in other languages: whole tables, nothing left in English, the author's choice before the reader's.
import assert from "node:assert/strict";
import { existsSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import type { Page } from "playwright-core";
import quantity_texts from "../../src/quantities/quantity_texts.json";
import { symbols } from "../lesson/symbols.ts";
import { features } from "../src/data/clip.ts";
import * as de from "../src/texts/de.ts";
import * as en from "../src/texts/en.ts";
import * as es from "../src/texts/es.ts";
import * as fr from "../src/texts/fr.ts";
import { filled, first_known } from "../src/texts/language.ts";
import { accessibility_faults } from "./accessibility.ts";
import { open_page } from "./browser.ts";
import { make_lesson } from "./made_lesson.ts";
import { make_page } from "./made_page.ts";
import { player_folder } from "./paths.mjs";
import { save_picture } from "./picture.ts";
import { scenes_folder, temporary_folder, tumble } from "./program.ts";

const translations = { de, es, fr };
const groups = ["loader", "shell", "contents", "player"] as const;
const forms = (text: string): string[] => text.split("|");
const places = (form: string): string[] => (form.match(/\{\w+\}/g) ?? []).sort();

test("a translation has the keys, the places and the forms of the English texts", () => {
  for (const [language, table] of Object.entries(translations)) {
    for (const group of groups) {
      const english: Record<string, string> = en[group], other: Record<string, string> = table[group];
      assert.deepEqual(Object.keys(other).sort(), Object.keys(english).sort(), `${language}: ${group}`);
      for (const [key, text] of Object.entries(english)) {
        assert.notEqual(other[key].trim(), "", `${language}: ${key}`);
        assert.deepEqual(forms(other[key]).map(places), forms(text).map(places), `${language}: ${key}`);
      }
    }
    assert.deepEqual(Object.keys(table.terms).sort(), [...en.terms].sort(), language);
  }
});

test("the program's names of quantities, and meanings of symbols, are terms", () => {
  const names = [
    ...[...quantity_texts.scene_quantities, ...quantity_texts.body_quantities, ...quantity_texts.page_body_quantities].map(({ title }) => title),
    ...quantity_texts.joint_quantities.map(({ axis }) => axis).filter((axis) => !axis.includes("_")), ...features];
  const meanings = symbols.map(({ meaning }) => meaning.replace(/ (before|after) the impact$/, "").replace(/ of [AB]$/, ""));
  const known = new Set<string>(en.terms);
  assert.deepEqual([...names.map((name) => (known.has(name) ? name : name.replace(/ [xyz]$/, ""))), ...meanings].filter((name) => !known.has(name)), []);
});

test("codes name languages, and counts choose forms", () => {
  assert.equal(first_known(["", "de-AT", "en"]), "de");
  assert.equal(first_known(["it", "FR", "en"]), "fr");
  assert.equal(first_known(["", "it"]), "en");
  assert.equal(filled("{count} frame|{count} frames", { count: 1 }), "1 frame");
  assert.equal(filled("{count} frame|{count} frames", { count: 3 }), "3 frames");
});

/** Texts, labels and tooltips of the page, but for texts of authors and of the program. */
function shown_texts(page: Page): Promise<string[]> {
  return page.evaluate(() => {
    const foreign = "script, style, pre, code, textarea, figcaption, math, header h1, .lesson-summary, .tp-fallback, .masthead, .tp-live-row > label, .quiz-question, .without-player, noscript";
    const texts: string[] = [];
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_ELEMENT | NodeFilter.SHOW_TEXT);
    for (let node = walker.nextNode(); node; node = walker.nextNode()) {
      const element = node instanceof Element ? node : node.parentElement!;
      if (element.closest(foreign)) continue;
      // Its label has the program's summary.
      if (element.matches(".tp-stage")) continue;
      if (node instanceof Text) texts.push(node.data.trim());
      else for (const name of ["aria-label", "title", "aria-valuetext", "aria-roledescription", "label"]) texts.push(element.getAttribute(name) ?? "");
    }
    return texts.filter((text) => text !== "");
  });
}

/** Texts that are English ones of the table, where the translation has another one. */
function english_left(texts: string[], table: typeof de): string[] {
  const quoted = (text: string): string => text.replace(/[.*+?^$()[\]\\/|]/g, "\\$&");
  const patterns: RegExp[] = [];
  for (const group of groups) {
    const other: Record<string, string> = table[group];
    for (const [key, text] of Object.entries(en[group] as Record<string, string>)) {
      if (other[key] === text || !/[a-z]{2}/.test(text.replace(/\{\w+\}/g, ""))) continue;
      for (const form of forms(text)) patterns.push(new RegExp(`^${quoted(form).replace(/\{\w+\}/g, ".+")}( \\(.*\\))?$`));
    }
  }
  for (const term of en.terms) if (table.terms[term] !== term) patterns.push(new RegExp(`^${quoted(term)}( [xyz])?( of .+)?$`));
  return texts.filter((text) => patterns.some((pattern) => pattern.test(text)));
}

let page_path = "";
before(() => {
  page_path = make_page("language-page", join(scenes_folder, "newtons_cradle.toml"), "--set", "simulation.duration=1", "--set", "output.fps=30",
    "--vary", "body.ball 5.restitution=0.5,0.9", "--no-film");
});

for (const [language, table] of Object.entries(translations)) {
  test(`a page speaks ${language} to its reader, and fits a telephone`, async () => {
    const opened = await open_page(page_path, { language: `${language}-${language.toUpperCase()}`, width: 360, height: 740 });
    const { page } = opened;
    await page.locator(".tp-impacts-table tbody tr[data-index]").first().click();
    assert.deepEqual(english_left(await shown_texts(page), table), []);
    assert.equal(await page.getAttribute(".tp-play", "aria-label"), table.player.play);
    assert.equal(await page.getAttribute("html", "lang"), "en", "the title is the author's");
    assert.equal(await page.getAttribute("figure.tumble-player", "lang"), language);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing is wider than the window");
    assert.deepEqual(await accessibility_faults(page), []);
    await save_picture(page, `language-${language}-360`);
    assert.deepEqual(await opened.problems(), []);
    await opened.close();
  });
}

test("the author's language wins over the reader's", async () => {
  const scene = join(scenes_folder, "newtons_cradle.toml");
  for (const [given, reader, shown, lang] of [["fr", "de-DE", fr.player.play, "fr"], ["en", "de-DE", en.player.play, "en"], ["it", "es-ES", es.player.play, "it"]]) {
    const path = make_page(`language-${given}`, scene, "--set", "simulation.duration=0.2", "--no-film", "--language", given);
    const opened = await open_page(path, { language: reader });
    assert.equal(await opened.page.getAttribute(".tp-play", "aria-label"), shown, given);
    assert.equal(await opened.page.getAttribute("html", "lang"), lang);
    await opened.close();
  }
});

const ball = `format = 1
[simulation]
duration = 0.3
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.1 }
position = [0.0, 1.0, 0.0]
`;

const lesson = `+++
title = "A fall"
summary = "One question."
+++

${"```"}tumble
format = 1
title = "A ball"

[stage]
id = "ball"
alt = "A ball falls."

[simulation]
duration = 0.3

[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.1 }
position = [0.0, 1.0, 0.0]
${"```"}

${"```"}quiz
question = "How much is two and two?"
answer = 4
tolerance = 0.1
hint = "Count."
${"```"}
`;

test("a lesson's questions and the contents of its course speak German", async () => {
  writeFileSync(join(temporary_folder, "fall.md"), lesson);
  make_lesson("other", lesson.replace("A fall", "Another fall"), "--no-pictures", "fall.md");
  const site = join(temporary_folder, "other-site");
  const opened = await open_page(join(site, "fall.html"), { language: "de-DE" });
  const { page } = opened;
  await page.fill(".quiz-input", "5");
  await page.click(".quiz-check");
  assert.equal(await page.textContent(".quiz-result"), `\u2717 ${de.player.too_large} ${de.player.hint_below}`);
  assert.equal(await page.textContent(".lesson-place"), "Lektion 1 von 2");
  assert.equal(await page.textContent(".quiz-title"), "Frage 1");
  await page.fill(".quiz-input", "4");
  await page.click(".quiz-check");
  assert.deepEqual(english_left(await shown_texts(page), de), []);
  assert.deepEqual(await opened.problems(), []);
  await page.goto(`file://${join(site, "index.html")}`);
  assert.equal(await page.textContent(".lesson-progress"), "\u2713 Die Frage beantwortet");
  assert.match(await page.textContent(".course-progress") ?? "", /1 von 2 Lektionen geöffnet/);
  assert.equal(await page.textContent(".skip"), de.shell.skip);
  assert.deepEqual(english_left(await shown_texts(page), de), []);
  assert.deepEqual(await accessibility_faults(page), []);
  await opened.close();
});

test("lessons have the language that --language names", async () => {
  writeFileSync(join(temporary_folder, "fall.md"), lesson);
  tumble("lesson", "fall.md", "-o", "named-site", "--no-pictures", "--quiet", "--language", "es");
  const opened = await open_page(join(temporary_folder, "named-site/fall.html"));
  assert.equal(await opened.page.getAttribute("html", "lang"), "es");
  assert.equal(await opened.page.textContent(".quiz-check"), es.shell.check);
  await opened.page.goto(`file://${join(temporary_folder, "named-site/index.html")}`);
  assert.equal(await opened.page.getAttribute("html", "lang"), "es");
  assert.equal(await opened.page.textContent(".skip"), es.shell.skip);
  await opened.close();
});

test("a live page speaks German", { skip: existsSync(join(player_folder, "live-page.html")) ? false : "there is no live player" }, async () => {
  writeFileSync(join(temporary_folder, "ball.toml"), ball);
  const path = make_page("language-live", "ball.toml", "--no-film", "--live", "body.ball.restitution=0:1:0.1");
  const opened = await open_page(path, { language: "de-DE", wait_for: '.tp-live[data-live="ready"]' });
  assert.deepEqual(english_left(await shown_texts(opened.page), de), []);
  assert.deepEqual(await accessibility_faults(opened.page), []);
  await save_picture(opened.page, "language-live");
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});
