// The program `tumble`, its scenes and its tables.
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { repository, tumble_path } from "./paths.mjs";
import { temporary_folder } from "./temporary_folder.ts";

export { repository, temporary_folder };
export const scenes_folder = join(repository, "assets/scenes");

export interface ProgramRun {
  status: number | null;
  stdout: string;
  stderr: string;
}

/** Runs the program in the temporary folder. */
export function run_tumble(...args: (string | number)[]): ProgramRun {
  const run = spawnSync(tumble_path(), args.map(String), { cwd: temporary_folder, encoding: "utf8", maxBuffer: 1 << 28 });
  if (run.error) throw run.error;
  return { status: run.status, stdout: run.stdout, stderr: run.stderr };
}

/** Runs the program and fails if it does. */
export function tumble(...args: (string | number)[]): ProgramRun {
  const run = run_tumble(...args);
  if (run.status !== 0) throw new Error(`tumble ${args.join(" ")}: exit code ${run.status}\n${run.stderr}`);
  return run;
}

export type Row = Record<string, string>;

/** The rows of a table of the program: a file of the temporary folder. */
export function table(name: string): Row[] {
  const [head, ...lines] = readFileSync(join(temporary_folder, name), "utf8").trimEnd().split("\n");
  const columns = head.split(",");
  return lines.map((line) => {
    const values = line.split(",");
    return Object.fromEntries(columns.map((column, i) => [column, values[i]]));
  });
}

/** Numbers of a row. */
export function numbers(row: Row, ...columns: string[]): number[] {
  return columns.map((column) => Number(row[column]));
}
