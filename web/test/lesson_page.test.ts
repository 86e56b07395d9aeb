// A lesson in the browser: symbols light arrows, numbers satisfy the equations, questions answer, paper has all of it.
import assert from "node:assert/strict";
import { dirname } from "node:path";
import { before, test } from "node:test";
import { no_webgl, open_page, type OpenedPage } from "./browser.ts";
import { make_lesson } from "./made_lesson.ts";

const lesson = String.raw`+++
title = "A box on the floor"
summary = "One impact."
+++

Text with $\nhat$ and $\ww$.

$$ \vrelp = -\eps\,\vrelm $$ {#eq-law notes=14}

${"```"}tumble
format = 1
title = "A box falls"

[stage]
id = "box"
vary = ["body.box.restitution=0.5,0.9"]
plot = "body.box.y"
body = "box"
alt = "A box falls on its corner."
caption = "Hold $\\jn$."

[simulation]
duration = 1.0
impacts = "exact"
integrator = "exact"

[output]
size = [320, 180]
samples = 1

[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }

[[body]]
name = "box"
shape = { type = "box", size = [0.6, 0.4, 0.3] }
restitution = 0.5
position = [0.0, 1.0, 0.0]
rotation = { axis = [1.0, 0.3, 0.7], angle = 40.0 }
angular_velocity = [0.5, 1.0, 2.0]
${"```"}

${"```"}numbers
stage = "box"
equation = '''\jn = \frac{-(1+\eps)\,\vrel}{\frac1{\ma} + \frac1{\mb} + \nhat\cdot[(\Ia^{-1}(\ra\times\nhat))\times\ra + (\Ib^{-1}(\rb\times\nhat))\times\rb]}'''
value = "j"
expression = "-(1+e)*vrel/(ima+imb+dot(n,cross(iIa*cross(ra,n),ra))+dot(n,cross(iIb*cross(rb,n),rb)))"
${"```"}

${"```"}numbers
stage = "box"
moment = "now"
equation = '''\LL = \II\ww'''
value = "L"
expression = "I*w"
${"```"}

${"```"}numbers
stage = "box"
equation = '''\vbp = \vb + \frac{\jn}{\mb}\nhat'''
value = "vbp"
expression = "vb + j*imb*n"
${"```"}

${"```"}quiz
question = "How fast is the box after its first impact, along the normal, per speed before?"
stage = "box"
answer = 0.5
tolerance = 1e-12
check = { impact = 1, column = "restitution" }
hint = "It is a coefficient."
explanation = "It is $\\eps$."
${"```"}

${"```"}quiz
question = "What does a heavier box change?"
choices = [
  { text = "The height of the bounce", because = "The speed after an impact does not depend on the mass." },
  { text = "The impulse", right = true, because = "It is proportional to the mass." },
]
${"```"}

::: derivation Folded
Text.
:::
`;

let path = "";
before(() => { path = make_lesson("box", lesson); });

const residuals = (opened: OpenedPage): Promise<number[]> => opened.page.evaluate(() =>
  [...document.querySelectorAll<HTMLElement>("[data-residual]")].map((block) => Number(block.dataset.residual)));

test("the numbers of every impact satisfy equation 20 to 1e-12", async () => {
  const opened = await open_page(path);
  const { page } = opened;
  for (const button of await page.locator(".numbers-open").all()) await button.click();
  const impacts = await page.evaluate(() => window.tumble.impacts.length);
  assert.ok(impacts >= 3, `${impacts} impacts`);
  for (const run of [0, 1]) {
    await page.evaluate((index) => window.tumble.select_run(index), run);
    for (let i = 0; i < impacts; ++i) {
      const found = await residuals(opened);
      assert.equal(found.length, 3);
      assert.ok(found.every((residual) => residual < 1e-12), `run ${run}, impact ${i}: ${found}`);
      await page.getByRole("button", { name: "Next impact" }).last().click();
    }
  }
  const shown = await page.locator(".numbers-substituted").first().textContent();
  assert.match(shown!, /\u221e/);   // the mass of the floor
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});

test("blocks of one stage show the same impact, which is also the stage's", async () => {
  const opened = await open_page(path);
  const { page } = opened;
  for (const button of await page.locator(".numbers-open").all()) await button.click();
  await page.locator(".numbers").first().getByRole("button", { name: "Next impact" }).click();
  const texts = await page.locator(".numbers-moment").allTextContents();
  assert.match(texts[0], /^Impact 2 of/);
  assert.equal(texts[2], texts[0]);
  const { time, impact } = await page.evaluate(() => ({ time: window.tumble.time, impact: window.tumble.impacts[1].time }));
  assert.equal(time, impact);
  await opened.close();
});

test("a symbol under the pointer lights its arrow and shows its number", async () => {
  const opened = await open_page(path, { width: 900, height: 700 });
  const { page } = opened;
  const highlight = () => page.evaluate(() => (window.tumble.arrows().highlight ?? []).length);
  await page.evaluate(() => window.tumble.seek(0.3));
  await page.locator("p [data-symbol=w]").hover();
  assert.equal(await highlight(), 1);
  assert.match((await page.locator(".symbol-note").textContent())!, /^angular velocity\([^)]*\) rad\/s$/);
  assert.ok(await page.locator("[data-symbol=w].lit").count() >= 2, "in the text and in the equation");
  await page.locator("p [data-symbol=n]").hover();
  assert.equal(await highlight(), 1);
  assert.match((await page.locator(".symbol-note").textContent())!, /contact normal\(0, 1, 0\)/);
  await page.mouse.move(1, 1);
  await page.locator("h1").hover();
  assert.equal(await highlight(), 0);
  assert.equal(await page.locator(".lit").count(), 0);
  await opened.close();
});

test("arrow keys go through the symbols of an equation", async () => {
  const opened = await open_page(path);
  const { page } = opened;
  await page.locator("#eq-law .equation-body").focus();
  await page.keyboard.press("ArrowRight");
  assert.match((await page.locator(".symbol-note").textContent())!, /after the impact/);
  await page.keyboard.press("ArrowRight");
  assert.match((await page.locator(".symbol-note").textContent())!, /coefficient of restitution0\.5/);
  assert.equal(await page.locator(".symbol-note").getAttribute("role"), "status");
  await page.keyboard.press("Escape");
  assert.ok(await page.locator(".symbol-note").isHidden());
  await opened.close();
});

test("a question tells right from wrong, by keyboard alone", async () => {
  const opened = await open_page(path);
  const { page } = opened;
  const answer = async (text: string) => {
    await page.locator(".quiz-input").fill(text);
    await page.keyboard.press("Enter");
    return page.locator("#quiz-1 .quiz-result").textContent();
  };
  await page.locator(".quiz-input").focus();
  assert.match((await answer("0.6"))!, /too large/);
  assert.equal(await page.locator("#quiz-1 .quiz-answer").getAttribute("open"), null);
  assert.match((await answer("many"))!, /Write a number/);
  assert.match((await answer("0,5"))!, /Right/);
  assert.notEqual(await page.locator("#quiz-1 .quiz-answer").getAttribute("open"), null);
  await opened.close();
});

test("a question with choices says why, by keyboard alone", async () => {
  const opened = await open_page(path);
  const { page } = opened;
  const question = page.locator("#quiz-2");
  const check = async (): Promise<string> => {
    await page.keyboard.press("Enter");
    return (await question.locator(".quiz-result").textContent())!;
  };
  await question.locator("input").first().focus();
  assert.match(await check(), /Choose one/);
  await page.keyboard.press("Space");
  assert.match(await check(), /Not this one/);
  assert.deepEqual(await question.locator(".quiz-because:visible").allTextContents(), ["The speed after an impact does not depend on the mass."]);
  await page.keyboard.press("ArrowDown");
  assert.equal(await question.locator(".quiz-because:visible").count(), 0);
  assert.match(await check(), /Right/);
  assert.notEqual(await question.locator(".quiz-answer").getAttribute("open"), null);
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});

test("the contents know which questions are answered, until they are told to forget", async () => {
  const opened = await open_page(path);
  const { page } = opened;
  await page.locator(".quiz-input").fill("0.5");
  await page.keyboard.press("Enter");
  await page.goto(`file://${dirname(path)}/index.html`);
  assert.equal(await page.locator(".lesson-progress").textContent(), "1 of 2 questions answered");
  await page.reload();
  await page.getByRole("button", { name: "Forget" }).click();
  assert.equal(await page.locator(".lesson-progress").count(), 0);
  await page.reload();
  assert.equal(await page.locator(".course-progress").count(), 0);
  await opened.close();
});

test("on paper there are pictures, lines to write on, and the answers at the end", async () => {
  const opened = await open_page(path);
  const { page } = opened;
  await page.emulateMedia({ media: "print" });
  assert.ok(await page.locator(".tp-fallback img").isVisible());
  assert.ok(await page.locator(".tp-stage-host").isHidden());
  assert.ok(await page.locator(".quiz-blank").isVisible());
  assert.ok(await page.locator("#quiz-1 .quiz-form").isHidden());
  assert.ok(await page.locator("#quiz-2 .quiz-choices").isVisible());
  assert.ok(await page.locator("#quiz-2 .quiz-check").isHidden());
  assert.match((await page.locator(".print-answers").textContent())!, /0\.5/);
  await opened.close();
});

test("without WebGL the picture stays, and numbers and questions work", async () => {
  const opened = await open_page(path, { args: no_webgl });
  const { page } = opened;
  assert.equal(await opened.player_state(), "no-webgl");
  assert.ok(await page.locator(".tp-fallback img").isVisible());
  await page.locator(".numbers-open").first().click();
  assert.ok((await residuals(opened))[0] < 1e-12);
  await opened.close();
});

test("a narrow page has no overflow", async () => {
  const opened = await open_page(path, { width: 360, height: 640 });
  for (const button of await opened.page.locator(".numbers-open").all()) await button.click();
  assert.equal(await opened.page.evaluate(() => document.documentElement.scrollWidth), 360);
  await opened.close();
});
