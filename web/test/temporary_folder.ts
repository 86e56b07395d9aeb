import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

/** A folder of this test file's own. */
export const temporary_folder = mkdtempSync(join(tmpdir(), "tumble-web-"));
process.on("exit", () => rmSync(temporary_folder, { recursive: true, force: true }));
