// The compiler of lessons as a program.
//   node lesson.cjs --check LESSON.md...        prints mistakes; exit code 2 if there are any
//   node lesson.cjs [--for PID] < FILES.json    a JSON list of files in, CourseOutput as JSON out
//   node lesson.cjs --numbers [--for PID] < TASK.json    a NumbersTask in, a list of NumbersResult out
// --for: ends with the process PID, which must be its parent.
import { readFileSync } from "node:fs";
import { Worker } from "node:worker_threads";
import { check_numbers, type NumbersTask } from "./check_numbers.ts";
import { compile_course } from "./course.ts";
import { files_on_disk } from "./files.ts";
import { problem_text } from "./problems.ts";

/** Lessons are compiled in one go, so the parent is watched by another thread. */
function end_with_parent(id: number): void {
  const watch = `
    const { workerData } = require("node:worker_threads");
    setInterval(() => { if (process.ppid !== workerData) process.kill(process.pid, "SIGKILL"); }, 100);`;
  new Worker(watch, { eval: true, workerData: id }).unref();
}

function check(files: string[]): void {
  const { errors, lessons } = compile_course(files, files_on_disk);
  for (const error of errors) console.error(problem_text(error));
  if (errors.length === 0) {
    const count = (word: string, number: number) => `${number} ${word}${number === 1 ? "" : "s"}`;
    for (const lesson of lessons)
      console.log(`${lesson.file}: no errors; ${count("stage", lesson.stages.length)}, ${count("question", lesson.quizzes.length)}, ` +
        `${count("table", lesson.measures.length)} of measures, ${count("convergence plot", lesson.convergences.length)}`);
  }
  process.exitCode = errors.length > 0 ? 2 : 0;
}

const input = (): unknown => JSON.parse(readFileSync(0, "utf8"));

const [command, ...rest] = process.argv.slice(2);
if (command === "--check") {
  check(rest);
} else {
  const parent = process.argv.indexOf("--for");
  if (parent >= 0) end_with_parent(Number(process.argv[parent + 1]));
  const output = command === "--numbers" ? check_numbers(input() as NumbersTask) : compile_course(input() as string[], files_on_disk);
  process.stdout.write(JSON.stringify(output));
}
