import { chromium } from "playwright-core";
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", chromiumSandbox: false, args: ["--enable-unsafe-swiftshader"] });
const page = await (await browser.newContext({ viewport: { width: 1280, height: 720 } })).newPage();
await page.goto("file:///work/tmp/panels/page.html"); await page.waitForSelector('html[data-player="ready"]');
await page.evaluate("tumble.seek(0.8)"); await page.focus(".tp-stage"); await page.keyboard.press("Shift+F"); await page.waitForTimeout(1500);
await page.screenshot({ path: "/work/tmp/panels/fs.png" });
await browser.close();
