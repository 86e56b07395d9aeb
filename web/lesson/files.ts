// Files that lessons name. Only regular files are read: a pipe without a writer would hold the compiler for ever.
import { closeSync, constants, existsSync, fstatSync, openSync, readFileSync, realpathSync } from "node:fs";
import { dirname, join, sep } from "node:path";

/** What the compiler reads. Both `read` functions throw an Error whose message completes "cannot read ...: ". */
export interface LessonFiles {
  read_lesson(file: string): Uint8Array;
  /** `address`: relative to the folder of the lesson `file`, which it must not leave. */
  read_picture(file: string, address: string): Uint8Array;
  /** True if `name` lies beside the lesson `file`. */
  lies_beside(file: string, name: string): boolean;
}

const most_bytes = 64 << 20;  // as much as a page can hold

function read_regular(path: string): Uint8Array {
  // Without O_NONBLOCK the open itself waits for a pipe's writer.
  const descriptor = openSync(path, constants.O_RDONLY | constants.O_NONBLOCK);
  try {
    const status = fstatSync(descriptor);
    if (!status.isFile()) throw new Error("it is not a regular file");
    if (status.size > most_bytes) throw new Error(`it has more than ${most_bytes >> 20} MiB`);
    return readFileSync(descriptor);
  } finally {
    closeSync(descriptor);
  }
}

/** Words for people in place of "ENOENT: no such file or directory, open '...'". */
function in_words(error: unknown): Error {
  const { code, message } = error as NodeJS.ErrnoException;
  const words: Record<string, string> = {
    ENOENT: "there is no such file", EACCES: "permission denied", ELOOP: "its links form a circle",
    ENOTDIR: "a part of its path is no folder", ENAMETOOLONG: "its name is too long", ENXIO: "it is not a regular file",
  };
  return new Error(words[code ?? ""] ?? message.replace(/^[A-Z]+: /, "").replace(/, [a-z]+( '.*)?$/, ""));
}

export const files_on_disk: LessonFiles = {
  read_lesson(file) {
    try {
      return read_regular(file);
    } catch (error) {
      throw in_words(error);
    }
  },
  read_picture(file, address) {
    try {
      const folder = realpathSync(dirname(file));
      const path = realpathSync(join(folder, address));
      if (!path.startsWith(folder.endsWith(sep) ? folder : folder + sep))
        throw new Error("it lies outside of the lesson's folder, and pages hold pictures of that folder only");
      return read_regular(path);
    } catch (error) {
      throw in_words(error);
    }
  },
  lies_beside: (file, name) => existsSync(join(dirname(file), name)),
};
