// Programs and folders that the tests use.
import { accessSync, constants } from "node:fs";
import { delimiter, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

/** Also from the bundles: build/web-test lies as deep as web/test. */
export const repository = resolve(fileURLToPath(import.meta.url), "../../..");

/** The built player. */
export const player_folder = join(repository, "build/web");

export function tumble_path() {
  return resolve(process.env.TUMBLE || join(repository, "build/release/tumble"));
}

/** The path of a Chromium, or "" if there is none. */
export function chromium_path() {
  if (process.env.CHROMIUM) return process.env.CHROMIUM;
  for (const name of ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"]) {
    for (const folder of (process.env.PATH ?? "").split(delimiter)) {
      try {
        accessSync(join(folder, name), constants.X_OK);
        return join(folder, name);
      } catch {
        // Not in this folder.
      }
    }
  }
  return "";
}
