// The module of live pages in Chromium: the data of each run equals the data in Node, which live_module.test.ts compares
// with the native library.
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { existsSync, readFileSync } from "node:fs";
import { basename } from "node:path";
import { after, before, test } from "node:test";
import { LiveModule } from "../src/live/module.ts";
import { open_page, type OpenedPage } from "./browser.ts";
import { make_source_page } from "./bundled_page.ts";
import { live_scenes, module_file, short_name, short_run } from "./live_scenes.ts";

const skip = existsSync(module_file) ? false : "there is no build/live/live.wasm (scripts/build-web --live)";

/** Of a page that has the module: the SHA-256 of a run's data. */
const source = `
import { LiveModule } from "../src/live/module.ts";
Object.assign(window, {
  load: async (base64: string) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    Object.assign(window, { module: await LiveModule.of(await WebAssembly.compile(bytes)) });
  },
  hash: async (name: string, text: string, settings: string[]) => {
    const run = (window as unknown as { module: LiveModule }).module.open(name, text, settings);
    run.advance(run.all_frames);
    const digest = await crypto.subtle.digest("SHA-256", run.data()!.slice());
    run.close();
    return Array.from(new Uint8Array(digest), (byte) => byte.toString(16).padStart(2, "0")).join("");
  },
});
document.documentElement.dataset.player = "ready";
`;

interface PageWithModule {
  load(base64: string): Promise<void>;
  hash(name: string, text: string, settings: string[]): Promise<string>;
}

let opened: OpenedPage, module: LiveModule;
before(async () => {
  if (skip) return;
  const bytes = readFileSync(module_file);
  module = await LiveModule.of(await WebAssembly.compile(bytes));
  opened = await open_page(await make_source_page(source));
  await opened.page.evaluate((base64) => (window as unknown as PageWithModule).load(base64), bytes.toString("base64"));
});
after(() => opened?.close());

for (const file of live_scenes()) {
  test(`${short_name(file)} has the bytes of Node`, { skip }, async () => {
    const run = module.open(basename(file), readFileSync(file, "utf8"), [short_run]);
    run.advance(run.all_frames);
    const expected = createHash("sha256").update(run.data()!).digest("hex");
    run.close();
    const found = await opened.page.evaluate(([name, text, setting]) =>
      (window as unknown as PageWithModule).hash(name, text, [setting]), [basename(file), readFileSync(file, "utf8"), short_run]);
    assert.equal(found, expected);
  });
}
