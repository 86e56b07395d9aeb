// What a reader has done of a course, in the storage of the browser. Without storage (it may be refused) nothing is kept.

export interface LessonProgress {
  /** Number of questions of the lesson. */
  questions: number;
  /** Names of those answered right. */
  answered: string[];
}

/** By the file name of the page. */
export type CourseProgress = Record<string, LessonProgress>;

/** Pages of one folder are a course. */
function storage_key(): string {
  return `tumble-course ${location.pathname.replace(/[^/]*$/, "")}`;
}

/** As in links of the contents. */
export function page_file(address: string): string {
  return decodeURIComponent(address.replace(/[?#].*$/, "").replace(/^.*\//, ""));
}

export function read_progress(): CourseProgress {
  try {
    const stored: unknown = JSON.parse(localStorage.getItem(storage_key()) ?? "{}");
    return stored && typeof stored === "object" ? stored as CourseProgress : {};
  } catch {
    return {};
  }
}

function write_progress(progress: CourseProgress): void {
  try {
    localStorage.setItem(storage_key(), JSON.stringify(progress));
  } catch {
    // Refused, or full.
  }
}

export function forget_progress(): void {
  try {
    localStorage.removeItem(storage_key());
  } catch {
    // Refused.
  }
}

/** Notes that the lesson was opened, and its questions as they are answered. */
export function keep_progress(root: HTMLElement): void {
  const file = page_file(location.pathname);
  const names = [...root.querySelectorAll<HTMLElement>("[data-quiz]")].map(({ id }) => id);
  const note = (answered: string | null): void => {
    // Another page of the course may have written meanwhile.
    const progress = read_progress();
    const known = (Array.isArray(progress[file]?.answered) ? progress[file].answered : []).filter((name) => names.includes(name));
    if (answered !== null && !known.includes(answered)) known.push(answered);
    write_progress({ ...progress, [file]: { questions: names.length, answered: known } });
  };
  note(null);
  root.addEventListener("tumble-answered", ({ target }) => note((target as HTMLElement).id));
}
