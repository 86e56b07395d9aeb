import { chromium } from "playwright-core";
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", chromiumSandbox: false, args: ["--enable-unsafe-swiftshader"] });
const page = await (await browser.newContext({ viewport: { width: 720, height: 1000 }, colorScheme: "dark" })).newPage();
await page.goto("file:///work/tmp/panels/page.html"); await page.waitForSelector('html[data-player="ready"]');
await page.evaluate("tumble.player.actions.go_to_impact(4)"); await page.emulateMedia({ media: "print" }); await page.waitForTimeout(500);
await page.screenshot({ path: "/work/tmp/panels/print.png", fullPage: true });
await browser.close();
