// The fuzz target of the compiler of lessons: changed lessons must give pages of allowed HTML, or mistakes with their places,
// within a time limit. tests/fuzz/lesson_fuzzer.mjs bundles and starts it.
//   lesson_fuzz.mjs [--seconds N] [--runs N] [--seed N] [--dictionary FILE] [--keep FOLDER] [--findings FOLDER] CORPUS...
// A corpus is a folder of lessons or a lesson. --keep: folder for lessons that led to something new. --findings: for the one that
// failed. Exit code: 0 nothing found, 1 a finding.
import { createHash } from "node:crypto";
import { mkdirSync, readdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { parseArgs } from "node:util";
import { Worker } from "node:worker_threads";
import type { FuzzPlan, FuzzReport } from "./lesson_fuzz_plan.ts";

const most_seconds = 10;   // of the processor, for one lesson
const most_memory = 2048;  // MiB
const look_every = 200;    // ms

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    seconds: { type: "string" }, runs: { type: "string" }, seed: { type: "string", default: "1" }, dictionary: { type: "string" },
    keep: { type: "string" }, findings: { type: "string" },
  },
});

function corpus_of(path: string): Uint8Array[] {
  if (!statSync(path).isDirectory()) return [readFileSync(path)];
  return readdirSync(path).sort().flatMap((name) => corpus_of(join(path, name)));
}

function write(folder: string | undefined, bytes: Uint8Array): string {
  if (folder === undefined) return "";
  mkdirSync(folder, { recursive: true });
  const file = join(folder, createHash("sha1").update(bytes).digest("hex"));
  writeFileSync(file, bytes);
  return file;
}

const plan: FuzzPlan = {
  seed: Number(values.seed),
  runs: Number(values.runs ?? Infinity),
  corpus: positionals.flatMap(corpus_of),
  dictionary: values.dictionary === undefined ? "" : readFileSync(values.dictionary, "utf8"),
  counters: new SharedArrayBuffer(12),
  current: new SharedArrayBuffer(1 << 20),
};
const counters = new Int32Array(plan.counters);
const worker = new Worker(new URL("lesson_fuzz_worker.mjs", import.meta.url), { workerData: plan, resourceLimits: { maxOldGenerationSizeMb: most_memory } });

let found = false;
function finding(what: string, input: Uint8Array): void {
  found = true;
  console.log(`FINDING ${write(values.findings, input)}\n${what}`);
}

worker.on("message", (report: FuzzReport) => {
  if (report.kind === "new") write(values.keep, report.input);
  if (report.kind === "finding") finding(report.what, report.input);
});
const current = () => new Uint8Array(plan.current).slice(0, counters[1]);
worker.on("error", (error) => finding(String(error), current()));

const start = Date.now();
/** Of the process, s: a loaded machine makes no lesson slow. */
const used = (): number => {
  const { user, system } = process.cpuUsage();
  return 1e-6 * (user + system);
};
let last = 0, since = used();
const timer = setInterval(() => {
  if (values.seconds !== undefined && Date.now() - start > 1000 * Number(values.seconds)) Atomics.store(counters, 2, 1);
  const count = Atomics.load(counters, 0);
  if (count !== last) since = used();
  last = count;
  if (used() - since < most_seconds) return;
  clearInterval(timer);
  finding(`a lesson took more than ${most_seconds} s`, current());
  void worker.terminate();
}, look_every);

worker.on("exit", () => {
  clearInterval(timer);
  console.log(`seed ${plan.seed}, ${((Date.now() - start) / 1000).toFixed(0)} s`);
  // As libFuzzer prints it.
  console.log(`stat::number_of_executed_units: ${counters[0]}`);
  process.exitCode = found ? 1 : 0;
});
