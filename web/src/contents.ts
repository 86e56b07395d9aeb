// The contents of a course: what the reader has done of each lesson.
import { forget_progress, page_file, read_progress, type LessonProgress } from "./lesson/progress.ts";
import { h } from "./ui/dom.ts";

function line_of({ questions, answered }: LessonProgress): string {
  if (questions === 0) return "Opened";
  return answered.length < questions ? `${answered.length} of ${questions} questions answered` : `\u2713 All ${questions} questions answered`;
}

function show_progress(list: HTMLElement): void {
  const progress = read_progress();
  let opened = 0, lessons = 0;
  for (const item of list.querySelectorAll("li")) {
    ++lessons;
    const link = item.querySelector("a");
    const lesson = link && progress[page_file(link.getAttribute("href")!)];
    if (!lesson || !Array.isArray(lesson.answered)) continue;
    ++opened;
    const line = h("p", { class: "lesson-progress" }, line_of(lesson));
    line.dataset.done = String(lesson.answered.length >= lesson.questions);
    item.append(line);
  }
  if (opened === 0) return;
  const summary = h("p", { class: "course-progress" },
    h("progress", { max: lessons, value: opened, "aria-label": "Lessons opened" }), ` ${opened} of ${lessons} lessons opened. `,
    h("button", { type: "button", class: "course-forget", onclick: () => {
      forget_progress();
      summary.remove();
      for (const line of list.querySelectorAll(".lesson-progress")) line.remove();
    } }, "Forget"));
  list.before(summary);
}

const list = document.querySelector<HTMLElement>(".lesson-list");
if (list) show_progress(list);
