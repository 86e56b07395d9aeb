// The harness itself: it sees requests, messages, errors, violations and blank canvases.
import assert from "node:assert/strict";
import { test } from "node:test";
import { no_webgl, open_page } from "./browser.ts";
import { make_source_page } from "./bundled_page.ts";
import { colors, different_pixels, save_picture, take_picture, variance } from "./picture.ts";

const cube_page = `
  import * as three from "three";
  const state = document.documentElement.dataset;
  try {
    const renderer = new three.WebGLRenderer({ antialias: true });
    renderer.setSize(320, 180);
    document.body.append(renderer.domElement);
    const scene = new three.Scene(), camera = new three.PerspectiveCamera(40, 16 / 9);
    camera.position.z = 4;
    scene.add(new three.Mesh(new three.BoxGeometry(), new three.MeshNormalMaterial()));
    scene.rotation.set(0.5, 0.5, 0);
    renderer.render(scene, camera);
    state.player = "ready";
  } catch { state.player = "no-webgl"; }`;

test("a quiet page with a cube", async () => {
  const opened = await open_page(await make_source_page(cube_page));
  assert.equal(await opened.player_state(), "ready");
  assert.deepEqual(await opened.problems(), []);
  const picture = await take_picture(opened.page.locator("canvas"));
  assert.deepEqual([picture.width, picture.height], [320, 180]);
  assert.ok(variance(picture) > 1000, `${variance(picture)}`);
  assert.ok(colors(picture) > 3);
  assert.equal(different_pixels(picture, await take_picture(opened.page.locator("canvas"))), 0);
  await save_picture(opened.page, "cube");
  await opened.close();
});

test("without WebGL", async () => {
  const opened = await open_page(await make_source_page(cube_page), { args: no_webgl });
  assert.equal(await opened.player_state(), "no-webgl");
  await opened.close();
});

test("a blank page has no variance", async () => {
  const opened = await open_page(await make_source_page(""), { wait_for: "" });
  const picture = await take_picture(opened.page);
  assert.deepEqual([picture.width, picture.height, variance(picture), colors(picture)], [640, 360, 0, 1]);
  await opened.close();
});

test("requests, messages, errors and violations are seen", async () => {
  const head = '<meta http-equiv="Content-Security-Policy" content="img-src data:">';
  const opened = await open_page(await make_source_page(`
    console.log("hello");
    fetch("http://example.org/data").catch(() => { document.documentElement.dataset.player = "ready"; });
    document.body.append(Object.assign(new Image(), { src: "http://example.org/picture.png" }));
    throw new Error("thrown");`, { head }));
  // The browser reports them in any order, and perhaps after the page is ready.
  for (let turn = 0; turn < 100 && opened.requests.length < 2; ++turn) await opened.page.waitForTimeout(20);
  assert.deepEqual([...opened.requests].sort(), ["http://example.org/data", "http://example.org/picture.png"]);
  assert.ok(opened.messages.includes("log: hello"));
  assert.equal(opened.errors.length, 1);
  assert.match(opened.errors[0], /thrown/);
  assert.match((await opened.violations())[0], /^img-src refuses http:\/\/example.org/);
  assert.ok((await opened.problems()).length >= 4);
  await opened.close();
});

test("color scheme, reduced motion, width, no script", async () => {
  const path = await make_source_page(`document.documentElement.dataset.player = ["(prefers-color-scheme: dark)",
    "(prefers-reduced-motion: reduce)", "(max-width: 360px)"].map((query) => matchMedia(query).matches).join();`);
  for (const [options, expected] of [[{}, "false,false,false"],
                                     [{ dark: true, reduced_motion: true, width: 360 }, "true,true,true"]] as const) {
    const opened = await open_page(path, options);
    assert.equal(await opened.player_state(), expected);
    await opened.close();
  }
  const opened = await open_page(path, { java_script: false, wait_for: "" });
  assert.equal(await opened.page.getAttribute("html", "data-player"), null);
  await opened.close();
});
