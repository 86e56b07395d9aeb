// Pages of `tumble lesson`.
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { temporary_folder, tumble } from "./program.ts";

/** Makes the page of a lesson in the temporary folder, and returns its path. */
export function make_lesson(name: string, markdown: string, ...options: string[]): string {
  writeFileSync(join(temporary_folder, `${name}.md`), markdown);
  tumble("lesson", `${name}.md`, "-o", `${name}-site`, "--quiet", ...options);
  return join(temporary_folder, `${name}-site`, `${name}.html`);
}
