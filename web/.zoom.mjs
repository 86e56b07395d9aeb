import { chromium } from "playwright-core";
const [,, file, selector, out, js, w="1280", scheme="light"] = process.argv;
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", chromiumSandbox: false, args: ["--enable-unsafe-swiftshader"] });
const c = await browser.newContext({ viewport: { width: +w, height: 800 }, deviceScaleFactor: 2, colorScheme: scheme }); const page = await c.newPage();
page.on("console", m => console.log(m.text())); page.on("pageerror", e => console.log(e.stack));
await page.goto(`file://${file}`); await page.waitForSelector('html[data-player]:not([data-player="loading"])');
if (js) console.log(JSON.stringify(await page.evaluate(js)) ?? ""); await page.waitForTimeout(400);
await page.locator(selector).first().screenshot({ path: out }); await browser.close();
