// The compiler of lessons as a program.
//   node lesson.cjs --check LESSON.md...    prints mistakes; exit code 2 if there are any
//   node lesson.cjs < FILES.json            a JSON list of files in, CourseOutput as JSON out
import { readFileSync } from "node:fs";
import { compile_course } from "./course.ts";
import { files_on_disk } from "./files.ts";
import { problem_text } from "./problems.ts";

if (process.argv[2] === "--check") {
  const files = process.argv.slice(3);
  const { errors, lessons } = compile_course(files, files_on_disk);
  for (const error of errors) console.error(problem_text(error));
  if (errors.length === 0) {
    const count = (word: string, number: number) => `${number} ${word}${number === 1 ? "" : "s"}`;
    for (const lesson of lessons)
      console.log(`${lesson.file}: no errors; ${count("stage", lesson.stages.length)}, ${count("question", lesson.quizzes.length)}, ` +
        `${count("table", lesson.measures.length)} of measures, ${count("convergence plot", lesson.convergences.length)}`);
  }
  process.exitCode = errors.length > 0 ? 2 : 0;
} else {
  process.stdout.write(JSON.stringify(compile_course(JSON.parse(readFileSync(0, "utf8")) as string[], files_on_disk)));
}
