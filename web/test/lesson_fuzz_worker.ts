// Compiles changed lessons one after the other, in a thread that its owner can end.
import { Buffer } from "node:buffer";
import { parentPort, workerData } from "node:worker_threads";
import { faults_of_course } from "./lesson_contract.ts";
import type { FuzzPlan, FuzzReport } from "./lesson_fuzz_plan.ts";
import { compile_texts } from "./lesson_texts.ts";
import { Mutator, read_dictionary } from "./lesson_mutator.ts";
import { random_numbers } from "./random.ts";

const plan = workerData as FuzzPlan;
const counters = new Int32Array(plan.counters);
const current = new Uint8Array(plan.current);
const pool: Buffer[] = plan.corpus.map((bytes) => Buffer.from(bytes));
const mutator = new Mutator(random_numbers(plan.seed), read_dictionary(plan.dictionary));
const seen = new Set<string>();

const other = `+++\ntitle = "Other"\nsummary = "S"\n+++\n\n## One\n\n$$ a $$ {#eq-a}\n\n[](lesson.md)\n`;

function tell(report: FuzzReport): void {
  parentPort!.postMessage(report);
}

/** Kinds of messages and of elements that a lesson led to: an input that leads to new ones is worth more changes. */
function traces(errors: { message: string }[], body: string): string[] {
  const kinds = errors.slice(0, 50).map(({ message }) => message.replace(/'[^']*'|"[^"]*"|\d+|\([^)]*\)/g, "").slice(0, 80));
  return [...kinds, ...[...body.matchAll(/<[a-z][a-z0-9]*( [a-z-]+)?( class="[^"]*")?/g)].slice(0, 500).map(([tag]) => tag)];
}

/** False after a finding. */
function run(bytes: Buffer): boolean {
  current.set(bytes);
  Atomics.store(counters, 1, bytes.length);
  Atomics.add(counters, 0, 1);
  try {
    const course = compile_texts({ "lesson.md": bytes, "other.md": other });
    const lines = new Map([["lesson.md", bytes.toString("latin1").split(/\r\n?|\n/).length], ["other.md", other.split("\n").length]]);
    const faults = faults_of_course(course, lines);
    if (faults.length > 0) {
      tell({ kind: "finding", what: faults.slice(0, 5).join("\n"), input: bytes });
      return false;
    }
    const found = traces(course.errors, course.lessons[0]?.body ?? "").filter((trace) => !seen.has(trace));
    for (const trace of found) seen.add(trace);
    if (found.length > 0) {
      pool.push(bytes);
      tell({ kind: "new", what: found[0], input: bytes });
    }
    return true;
  } catch (error) {
    tell({ kind: "finding", what: ((error as Error).stack ?? String(error)).replace(/(.{300}).*/g, "$1"), input: bytes });
    return false;
  }
}

let good = true;
for (const bytes of [...pool]) good = good && run(bytes);
for (let i = 0; good && i < plan.runs && Atomics.load(counters, 2) === 0; ++i) good = run(mutator.change(mutator.pick(pool), pool));
tell({ kind: "end" });
