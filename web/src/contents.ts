// The contents of a course: what the reader has done of each lesson.
import { forget_progress, page_file, read_progress, type LessonProgress } from "./lesson/progress.ts";
import * as de from "./texts/de.ts";
import * as en from "./texts/en.ts";
import * as es from "./texts/es.ts";
import * as fr from "./texts/fr.ts";
import { filled, in_force, in_language } from "./texts/language.ts";
import { translate_shell } from "./texts/shell_texts.ts";
import { h } from "./ui/dom.ts";

const texts = in_force<Record<keyof typeof en.contents, string>>({ en: en.contents, de: de.contents, es: es.contents, fr: fr.contents });

function line_of({ questions, answered }: LessonProgress): string {
  if (questions === 0) return texts.opened;
  return answered.length < questions ? filled(texts.answered_some, { answered: answered.length, questions }) :
    filled(texts.answered_all, { count: questions });
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
    const line = in_language(h("p", { class: "lesson-progress" }, line_of(lesson)));
    line.dataset.done = String(lesson.answered.length >= lesson.questions);
    item.append(line);
  }
  if (opened === 0) return;
  const summary = in_language(h("p", { class: "course-progress" },
    h("progress", { max: lessons, value: opened, "aria-label": texts.lessons_opened }), ` ${filled(texts.opened_of, { opened, lessons })} `,
    h("button", { type: "button", class: "course-forget", onclick: () => {
      forget_progress();
      summary.remove();
      for (const line of list.querySelectorAll(".lesson-progress")) line.remove();
    } }, texts.forget)));
  list.before(summary);
}

translate_shell();
const list = document.querySelector<HTMLElement>(".lesson-list");
if (list) show_progress(list);
