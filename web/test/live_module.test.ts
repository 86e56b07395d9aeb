// The simulation as WebAssembly: the data of each run equals that of the native library, byte by byte. The program
// live_data, in C, makes the native data.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";
import { before, test } from "node:test";
import type { LiveControlText } from "../lesson/blocks/stage.ts";
import { compile_course } from "../lesson/course.ts";
import { files_on_disk } from "../lesson/files.ts";
import { DecimalSteps } from "../src/live/decimal.ts";
import { setting_words, simulate_command } from "../src/live/command.ts";
import { LiveModule } from "../src/live/module.ts";
import { read_clip } from "../src/data/decode_clip.ts";
import { live_scenes, module_file, scalar_module_file, short_name, short_run } from "./live_scenes.ts";
import { repository, temporary_folder } from "./program.ts";
import { encode91 } from "../build/text91.mjs";
import { decode91 } from "../src/live/text91.ts";
import { tumble_path } from "./paths.mjs";

const live_data = join(dirname(tumble_path()), "tests/live/live_data");
const skip = !existsSync(module_file) ? "there is no build/live/live.wasm (scripts/build-web --live)" :
  !existsSync(live_data) ? `there is no ${live_data}` : false;

let module: LiveModule;
before(async () => {
  if (!skip) module = await LiveModule.of(await WebAssembly.compile(readFileSync(module_file)));
});

function whole(name: string, text: string, settings: string[], by = module): { bytes: Uint8Array | null; error: string } {
  const run = by.open(name, text, settings);
  run.advance(run.all_frames);
  const bytes = run.data(), error = run.error?.message ?? "";
  run.close();
  return { bytes, error };
}

/** Fails where the module's run is not the native one, bytes or message. */
function assert_native(name: string, file: string, settings: string[]): void {
  const out = join(temporary_folder, "native.bin");
  const native = spawnSync(live_data, [out, name, file, ...settings], { encoding: "utf8" });
  const { bytes, error } = whole(name, readFileSync(file, "utf8"), settings);
  const what = `${name} ${settings.join(" ")}: native: ${native.stderr}; module: ${error}`;
  assert.equal(native.status === 0, bytes !== null, what);
  if (bytes) assert.ok(Buffer.from(bytes).equals(readFileSync(out)), `the bytes differ: ${what}`);
  else assert.ok(native.stderr.includes(error.slice(0, 40)), what);
}

for (const file of live_scenes())
  test(`${short_name(file)} has the native bytes`, { skip }, () => assert_native(basename(file), file, [short_run]));

test("without vector instructions the bytes are the same", {
  skip: skip || (existsSync(scalar_module_file) ? false : "there is no build/live/scalar/live.wasm (scripts/build-live-module --scalar)"),
}, async () => {
  const scalar = await LiveModule.of(await WebAssembly.compile(readFileSync(scalar_module_file)));
  for (const file of live_scenes()) {
    const text = readFileSync(file, "utf8");
    const found = whole(basename(file), text, [short_run], scalar).bytes;
    assert.deepEqual(found, whole(basename(file), text, [short_run]).bytes, short_name(file));
  }
});

const lessons = readdirSync(join(repository, "course")).filter((name) => /^\d.*\.md$/.test(name)).map((name) => join(repository, "course", name));
const course = compile_course(lessons, files_on_disk);

/** The ends and the middle of a slider, or all choices, as settings. */
function tried({ key, min, max, step, choices }: LiveControlText): string[] {
  if (choices.length > 0) return choices.map((each) => `${key}=${each}`);
  const steps = new DecimalSteps(min, max, step);
  return [0, Math.floor(steps.last / 2), steps.last].map((index) => `${key}=${steps.text(index)}`);
}

for (const lesson of course.lessons) {
  for (const stage of lesson.stages.filter(({ live }) => live.length > 0)) {
    test(`${lesson.name}, stage ${stage.id}: all sliders have the native bytes`, { skip }, () => {
      const file = join(temporary_folder, `${stage.id}.toml`);
      writeFileSync(file, stage.text ?? readFileSync(join(dirname(lesson.file), stage.scene!), "utf8"));
      for (const setting of [[], ...stage.live.flatMap(tried).map((each) => [each])])
        assert_native(`${stage.id}.toml`, file, [...stage.set, ...setting]);
    });
  }
}

const ball = `format = 1
[simulation]
duration = 1.0
impacts = "exact"
[[body]]
name = "floor"
type = "fixed"
shape = { type = "plane" }
[[body]]
name = "ball"
shape = { type = "sphere", radius = 0.1 }
position = [0, 1.1, 0]
restitution = 0.5
`;

test("a setting changes the run, and frames come in pieces", { skip }, () => {
  const run = module.open("ball.toml", ball, ["body.ball.restitution=0.65"]);
  assert.equal(run.all_frames, 61);
  assert.equal(run.advance(20), 20);
  assert.equal(read_clip(run.data()!).runs[0].frames, 20);
  run.advance(100);
  const { runs } = read_clip(run.data()!);
  assert.equal(runs[0].frames, 61);
  const [first] = runs[0].impacts;
  assert.ok(Math.abs(first.time - Math.sqrt(2 / 9.81)) < 1e-3, `${first.time}`);
  run.close();
});

test("mistakes have line and column", { skip }, () => {
  const run = module.open("ball.toml", ball.replace("duration = 1.0", "duration = -1"), []);
  assert.equal(run.all_frames, 0);
  assert.equal(run.data(), null);
  assert.deepEqual([run.error!.line, run.error!.column], [3, 12]);
  run.close();
});

test("files are refused in words", { skip }, () => {
  const run = module.open("mesh.toml", `${ball}[[body]]\nname = "mesh"\nshape = { type = "mesh", file = "a.obj" }\nposition = [0, 3, 0]\n`, []);
  assert.match(run.error!.message, /a\.obj/);
  run.close();
});

test("500 runs take no more memory than 50", { skip }, () => {
  const once = (): void => {
    const run = module.open("ball.toml", ball, []);
    run.advance(61);
    run.data();
    run.close();
  };
  for (let i = 0; i < 50; ++i) once();
  const { memory } = module;
  for (let i = 0; i < 500; ++i) once();
  assert.equal(module.memory, memory);
});

test("the module's text gives its bytes again, and is safe in a page", () => {
  for (const size of [0, 1, 2, 3, 100, 5000]) {
    const bytes = Uint8Array.from({ length: size }, (_, i) => i % 3 === 0 ? 0 : (i * i * 31) & 255);
    const text = encode91(bytes);
    assert.deepEqual(decode91(text), bytes);
    assert.doesNotMatch(text, /[<[{\s]/);
  }
  assert.equal(decode91("<<"), null);
});

test("sliders give decimal text", () => {
  const steps = new DecimalSteps("0", "1", "0.05");
  assert.equal(steps.last, 20);
  assert.deepEqual([0, 3, 13, 20].map((index) => steps.text(index)), ["0.00", "0.15", "0.65", "1.00"]);
  assert.equal(steps.index("0.65"), 13);
  const down = new DecimalSteps("-20", "0", "0.01");
  assert.deepEqual([down.text(1019), down.text(0), down.text(down.last)], ["-9.81", "-20.00", "0.00"]);
  assert.equal(new DecimalSteps("-0.5", "0.5", "0.25").text(1), "-0.25");
});

test("the command quotes what a shell would read", () => {
  assert.equal(simulate_command("ball.toml", ["body.ball.restitution=0.65"]), "tumble simulate ball.toml --set body.ball.restitution=0.65");
  assert.equal(simulate_command("it's.toml", ['body."a b".mass=1']), `tumble simulate 'it'\\''s.toml' --set 'body."a b".mass=1'`);
});

test("a run is named by its settings", () => {
  assert.equal(setting_words("body.ball.restitution=0.65"), "restitution 0.65");
  assert.equal(setting_words("body.lower.angular_velocity.2=-0.003"), "angular velocity z -0.003");
  assert.equal(setting_words("simulation.integrator=exact"), "integrator exact");
});
