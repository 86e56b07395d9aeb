// What holds of a compiled course, whatever its lessons have in them.
import type { CourseOutput } from "../lesson/course.ts";
import { forbidden_html } from "./allowed_html.ts";

const control = /[\u0000-\u001f\u007f]/;
const lone_surrogate = /[\ud800-\udbff](?![\udc00-\udfff])|(?<![\ud800-\udbff])[\udc00-\udfff]/;
const whole_numbers = new Set(["run", "impact", "line", "column", "steps_per_frame"]);

/** The program reads the output as JSON: texts are Unicode, numbers are finite, and whole where it counts. */
function faults_of_value(value: unknown, key: string, path: string, faults: string[]): void {
  if (typeof value === "string" && lone_surrogate.test(value)) faults.push(`${path}: half a character`);
  if (typeof value === "number" && !Number.isFinite(value)) faults.push(`${path}: ${value}`);
  if (typeof value === "number" && whole_numbers.has(key) && (!Number.isInteger(value) || Math.abs(value) > 2 ** 31)) faults.push(`${path}: ${value}`);
  if (typeof value !== "object" || value === null) return;
  for (const [name, inner] of Object.entries(value)) faults_of_value(inner, Array.isArray(value) ? key : name, `${path}.${name}`, faults);
}

/** `lines`: of each lesson, by the name of its file. */
export function faults_of_course(course: CourseOutput, lines: Map<string, number>): string[] {
  const faults: string[] = [];
  for (const error of course.errors) {
    const { file, line, column, message } = error;
    if (!(line >= 1 && line <= (lines.get(file) ?? 0) + 1 && column >= 1)) faults.push(`no place: ${JSON.stringify(error)}`);
    if (control.test(message) || message.length > 700) faults.push(`not a line: ${JSON.stringify(message)}`);
    if (/undefined|\[object|is not a function|Cannot read/.test(message)) faults.push(`words of the interpreter: ${message}`);
  }
  // Without mistakes the pages are written.
  if (course.errors.length > 0) return faults;
  faults_of_value(course, "", "course", faults);
  const html = (text: string, of: string) => faults.push(...forbidden_html(text).map((fault) => `${of}: ${fault}`));
  html(course.index, "index");
  for (const lesson of course.lessons) {
    html(lesson.body, lesson.name);
    for (const { caption } of [...lesson.stages, ...lesson.convergences]) html(caption, `caption in ${lesson.name}`);
  }
  return faults;
}
