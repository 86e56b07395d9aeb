// The stage against the closed forms of the synthetic clip, in a real browser.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import { no_webgl, open_page, type OpenedPage } from "./browser.ts";
import { make_bundled_page } from "./bundled_page.ts";
import { colors, different_pixels, save_picture, variance, type Picture } from "./picture.ts";
import * as closed from "./synthetic_clip.ts";
import type {} from "./stage_page.ts";

type Arrows = Record<string, { from: number[]; to: number[] }[]>;
const body = '<div tabindex="0"><div id="host" style="width: 480px; height: 270px"></div></div>';
let path = "";
before(async () => {
  path = await make_bundled_page("test/stage_page.ts", { body, css: "body { margin: 0 }" });
});

async function open(name: "synthetic" | "hundred" | "thousand" = "synthetic", dark = false): Promise<OpenedPage> {
  const opened = await open_page(path, { dark });
  await opened.page.evaluate(([name, dark]) => open_stage(name, dark ? "dark" : "light"), [name, dark] as const);
  return opened;
}

/** Pixels after a script, which may call members of `stage`. */
async function picture(opened: OpenedPage, script = ""): Promise<Picture> {
  const read = await opened.page.evaluate((script) => {
    new Function(script)();
    const { width, height, data } = stage.pixels();
    return { width, height, text: btoa(Array.from(data, (value) => String.fromCharCode(value)).join("")) };
  }, script);
  return { width: read.width, height: read.height, data: new Uint8Array(Buffer.from(read.text, "base64")) };
}

const arrows = (opened: OpenedPage, script: string): Promise<Arrows> =>
  opened.page.evaluate((script) => {
    new Function(script)();
    return stage.arrows();
  }, script);

const show = (time: number, overlays: string[] = [], rest = "") =>
  `stage.set_overlays(new Set(${JSON.stringify(overlays)})); stage.show([0], ${time}, "single"); ${rest}`;

function assert_near(actual: number[], expected: number[], what: string): void {
  actual.forEach((value, i) => assert.ok(Math.abs(value - expected[i]) < 1e-6, `${what}: ${actual} is not ${expected}`));
}

test("bodies and their shadows, light and dark", async () => {
  for (const dark of [false, true]) {
    const opened = await open("synthetic", dark);
    const seen = await picture(opened, show(0.3));
    assert.deepEqual([seen.width, seen.height], [480, 270]);
    assert.ok(variance(seen) > 100, `${variance(seen)}`);
    assert.ok(colors(seen) > 1000);
    await save_picture(opened.page, `stage_${dark ? "dark" : "light"}`);
    assert.deepEqual(await opened.problems(), []);
    await opened.close();
  }
});

test("seeking there and back, and turning there and back, gives the same pixels", async () => {
  const opened = await open();
  const all = ["contacts", "forces", "velocity", "omega", "momentum", "impulses", "trails", "ghosts", "aabb", "axes", "com"];
  const first = await picture(opened, show(0.7, all));
  const other = await picture(opened, show(1.9, all));
  assert.ok(different_pixels(first, other) > 1000);
  assert.equal(different_pixels(first, await picture(opened, show(0.7, all))), 0);
  const turned = await picture(opened, "stage.orbit(0.5, 0.2); stage.zoom(0.8); stage.pan(0.1, 0);");
  assert.ok(different_pixels(first, turned) > 1000);
  assert.equal(different_pixels(first, await picture(opened, "stage.reset_view()")), 0);
  await opened.close();
});

test("arrows are the vectors of the clip times the scale", async () => {
  const opened = await open();
  const { scale } = closed.make_synthetic_run(0.5).overlays;
  for (const time of [0.1, 0.3, 0.7, 1.234, 2.5]) {
    const drawn = await arrows(opened, show(time, ["velocity", "omega", "momentum", "loads"]));
    const ball = closed.ball_at(0.5, time);
    const at = [-0.6, closed.ball_radius + ball.height, 0];
    if (ball.speed !== 0) {
      assert_near(drawn.velocity[0].from, at, "foot");
      assert_near(drawn.velocity[0].to, [at[0], at[1] + scale.velocity * ball.speed, 0], "tip");
      assert_near(drawn.momentum[0].to, [at[0], at[1] + scale.momentum * closed.ball_mass * ball.speed, 0], "momentum");
    }
    const box = [0.8, closed.box_size[1] / 2 + closed.box_at(time).height, 0];
    assert.equal(drawn.omega.length, 1);
    assert_near(drawn.omega[0].to, [box[0], box[1] + scale.omega * closed.box_spin, 0], "omega");
    assert_near(drawn.loads[1].to, [box[0], box[1] - scale.force * closed.box_mass * closed.gravity, 0], "weight");
  }
  await opened.close();
});

test("before an impact the velocity is that before it", async () => {
  const opened = await open();
  const [impact] = closed.bounces(0.5, 3);
  const { scale } = closed.make_synthetic_run(0.5).overlays;
  const tip = async (before: boolean) =>
    (await arrows(opened, `stage.set_overlays(new Set(["velocity"])); stage.show([0], ${impact.time}, "single", ${before})`))
      .velocity[0].to[1];
  assert_near([await tip(true), await tip(false)],
              [closed.ball_radius - 2 * scale.velocity * impact.speed_after, closed.ball_radius + scale.velocity * impact.speed_after],
              "tips");
  await opened.close();
});

test("contacts, forces and impulses come and go", async () => {
  const opened = await open();
  const count = async (time: number) => {
    const drawn = await arrows(opened, show(time, ["contacts", "forces", "impulses"]));
    return ["contacts", "forces", "impulses"].map((name) => drawn[name]?.length ?? 0);
  };
  assert.deepEqual(await count(0.1), [0, 0, 0]);
  assert.deepEqual(await count(0.3), [4, 4, 4]);       // the box has landed
  assert.deepEqual(await count(0.6), [4, 4, 1]);       // the ball has bounced
  assert.deepEqual(await count(2.9), [5, 5, 0]);       // the ball rests
  assert.deepEqual(await count(0.1), [0, 0, 0]);
  const { run, point } = { run: closed.make_synthetic_run(0.5), point: closed.box_corners(0.3)[0] };
  const drawn = await arrows(opened, show(0.3, ["forces"]));
  assert_near(drawn.forces[0].from, point, "point");
  const force = (closed.box_mass * closed.gravity) / 4;
  assert_near(drawn.forces[0].to, [point[0], point[1] + run.overlays.scale.force * force, point[2]], "force");
  await opened.close();
});

test("symbols of lessons light their arrows", async () => {
  const opened = await open();
  const run = closed.make_synthetic_run(0.5);
  const index = run.impacts.findIndex((impact) => impact.body_b === 2);
  const impact = run.impacts[index];
  const lit = async (name: string) =>
    (await arrows(opened, `${show(1)} stage.highlight({ name: "${name}", impact: clip.runs[0].impacts[${index}] })`)).highlight[0];
  const point = [impact.px, impact.py, impact.pz];
  assert_near((await lit("rb")).from, impact.pose_b.position, "center of B");
  assert_near((await lit("r_b")).to, point, "contact point");
  assert_near((await lit("j")).to, [point[0], run.overlays.scale.impulse * impact.impulse, point[2]], "impulse");
  assert_near((await lit("vrel")).to, [point[0], run.overlays.scale.velocity * impact.v_before, point[2]], "v_rel");
  assert_near((await lit("n")).from, point, "normal");
  const spin = (await arrows(opened, 'stage.highlight({ name: "w", body: 2 })')).highlight[0];
  assert_near(spin.to, [0.8, closed.box_size[1] / 2 + run.overlays.scale.omega * closed.box_spin, 0], "omega");
  await save_picture(opened.page, "stage_symbol");
  assert.equal((await arrows(opened, "stage.highlight(null)")).highlight, undefined);
  await opened.close();
});

test("a lost context comes back with the same picture", async () => {
  const opened = await open();
  const first = await picture(opened, show(0.7, ["velocity", "trails", "contacts"]));
  await opened.page.evaluate(async () => {
    const context = stage.canvas.getContext("webgl2")!;
    const loss = context.getExtension("WEBGL_lose_context")!;
    const happened = (name: string) => new Promise((done) => stage.canvas.addEventListener(name, done, { once: true }));
    const lost = happened("webglcontextlost");
    loss.loseContext();
    await lost;
    stage.show([0], 0.2, "single");
    stage.draw();
    const restored = happened("webglcontextrestored");
    setTimeout(() => loss.restoreContext(), 50);
    await restored;
  });
  assert.equal(different_pixels(first, await picture(opened, show(0.7, ["velocity", "trails", "contacts"]))), 0);
  assert.deepEqual(opened.errors, []);
  await opened.close();
});

test("runs as ghosts and side by side", async () => {
  const opened = await open();
  const at = (mode: string) => `stage.set_overlays(new Set()); stage.show([0, 1], 1.1, "${mode}")`;
  const single = await picture(opened, at("single"));
  const ghost = await picture(opened, at("ghost"));
  assert.ok(different_pixels(single, ghost, 8) > 200);
  await save_picture(opened.page, "stage_ghost");
  const both = await picture(opened, at("side-by-side"));
  await save_picture(opened.page, "stage_side_by_side");
  assert.ok(different_pixels(single, both, 8) > 10_000);
  const titles = await opened.page.locator("#host span:visible").allTextContents();
  assert.deepEqual(titles, ["restitution 0.5", "restitution 0.8"]);
  await opened.close();
});

test("a click chooses a body, a drag turns the view", async () => {
  const opened = await open();
  await opened.page.evaluate(() => {
    Object.assign(window, { picked: [] });
    stage.on_pick((body) => (window as unknown as { picked: (number | null)[] }).picked.push(body));
    stage.show([0], 0, "single");
    stage.draw();
  });
  const first = await picture(opened);
  await opened.page.mouse.click(194, 44);    // the ball
  await opened.page.mouse.click(301, 162);   // the box
  await opened.page.mouse.click(20, 20);     // the sky
  assert.deepEqual(await opened.page.evaluate("picked"), [1, 2, null]);
  assert.equal(different_pixels(first, await picture(opened)), 0);
  assert.ok(different_pixels(first, await picture(opened, "stage.select(1)")) > 50);
  await picture(opened, "stage.select(null)");
  await opened.page.mouse.move(200, 100);
  await opened.page.mouse.down();
  await opened.page.mouse.move(260, 120, { steps: 3 });
  await opened.page.mouse.up();
  assert.ok(different_pixels(first, await picture(opened)) > 1000);
  assert.equal(((await opened.page.evaluate("picked")) as unknown[]).length, 3);
  await opened.close();
});

test("the followed body stays in the middle", async () => {
  const opened = await open();
  const middle = async (time: number) => {
    const { data, width, height } = await picture(opened, show(time));
    return [...data.subarray(4 * (width * (height >> 1) + (width >> 1)), 4 * (width * (height >> 1) + (width >> 1)) + 3)];
  };
  await picture(opened, `${show(0)} stage.follow(1)`);
  for (const time of [0, 0.4, 1.2]) {
    const [red, , blue] = await middle(time);
    assert.ok(red > blue + 40, `the ball is orange: ${await middle(time)}`);
  }
  await opened.close();
});

test("a cord spans from the body to its anchor", async () => {
  const opened = await open();
  const greens = await opened.page.evaluate(() => {
    const { scene, motion } = clip.runs[0];
    const [x, y, z] = motion.state(1, 0).position;
    scene.cords.push({ body: 1, point: [0, 0.2, 0], anchor: [x + 1, y + 1.2, z], radius: 0.02, color: "#00a000" });
    const seen = [0, 0.5, 0.95, 1.05].map((share) => {
      const at: [number, number, number] = [x + share, y + 0.2 + share, z];
      scene.camera = () => ({ eye: [at[0], at[1], at[2] + 3], target: at, up: [0, 1, 0], vertical_fov: 40 });
      stage.show([0], 0, "single");
      const { data, width, height } = stage.pixels();
      const middle = 4 * (width * (height >> 1) + (width >> 1));
      return data[middle + 1] > 1.5 * data[middle];
    });
    return seen;
  });
  assert.deepEqual(greens, [false, true, true, false]);   // the first lies in the ball
  await opened.close();
});

test("the picture of a hidden stage", async () => {
  const opened = await open();
  await opened.page.evaluate(() => {
    document.getElementById("host")!.style.display = "none";
    stage.dispose();
    open_stage("synthetic", "light");
  });
  const seen = await picture(opened, show(0.3));
  assert.deepEqual([seen.width, seen.height], [640, 360]);
  assert.ok(variance(seen) > 100);
  await opened.close();
});

test("a stage draws nothing while nothing changes", async () => {
  const opened = await open("hundred");
  const frames = await opened.page.evaluate(async () => {
    let drawn = 0;
    const draw = stage.draw.bind(stage);
    stage.draw = () => {
      ++drawn;
      draw();
    };
    const pause = () => new Promise((done) => setTimeout(done, 200));
    await pause();
    const idle = drawn;
    for (const time of [0.1, 0.2, 0.3]) stage.show([0], time, "single");
    await pause();
    return [idle, drawn];
  });
  assert.deepEqual(frames, [0, 1]);
  await opened.close();
});

test("a thousand bodies", async () => {
  const opened = await open("thousand");
  const seen = await picture(opened, show(0.3, ["velocity"]));
  assert.ok(colors(seen) > 1000);
  assert.equal((await arrows(opened, "")).velocity.length, 1000);
  assert.deepEqual(await opened.problems(), []);
  await opened.close();
});

test("without WebGL the constructor throws", async () => {
  const opened = await open_page(path, { args: no_webgl });
  const message = await opened.page.evaluate(() => {
    try {
      open_stage("synthetic", "light");
      return "";
    } catch (error) {
      return String(error);
    }
  });
  assert.match(message, /WebGL/);
  assert.equal(await opened.page.locator("canvas").count(), 0);
  await opened.close();
});
