import { chromium } from "playwright-core"; import { readFileSync } from "fs";
const [,, page_name, ...specs] = process.argv;
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", chromiumSandbox: false, args: ["--enable-unsafe-swiftshader", "--no-first-run"] });
for (const spec of specs) { // name:width:height:scheme:js
  const [name, width, height, scheme, ...js] = spec.split(":");
  const context = await browser.newContext({ viewport: { width: +width, height: +height }, colorScheme: scheme, offline: true });
  const page = await context.newPage();
  page.on("console", m => { if (!/GPU stall/.test(m.text())) console.log(name, m.type(), m.text()); }); page.on("pageerror", e => console.log(name, "ERR", e.stack));
  await page.goto(`file://${page_name}`);
  await page.waitForSelector('html[data-player]:not([data-player="loading"])');
  await page.waitForTimeout(300);
  const code = js.join(":"); if (code) { await page.evaluate(code); await page.waitForTimeout(400); }
  const over = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth); if (over > 0) console.log(name, "overflow", over);
  await page.screenshot({ path: `/work/tmp/panels/${name}.png`, fullPage: name.endsWith("full") });
  await page.evaluate(readFileSync("node_modules/axe-core/axe.min.js", "utf8"));
  const r = await page.evaluate(() => axe.run(document, { preload: false }));
  for (const v of r.violations) console.log(name, "axe", v.impact, v.id, v.nodes.slice(0,3).map(n => n.html.slice(0,140) + " | " + n.failureSummary.split("\n").slice(1).join(";").slice(0,200)).join("\n    "));
  await context.close();
}
await browser.close();
