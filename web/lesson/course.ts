// All lessons of a site, in their order, with the parts of pages that the program does not make.
import { escape_html } from "./html.ts";
import { Lesson } from "./lesson.ts";
import { Problems, type Problem } from "./problems.ts";
import { References } from "./references.ts";
import { Source } from "./source.ts";

/** What the program needs of a lesson. In `body` these comments stand for what it makes: stage:ID, convergence:N,
 * measured:N:ROW, deviation:N:ROW. */
export interface LessonOutput {
  file: string;
  name: string;
  title: string;
  summary: string;
  /** Content of the page. */
  body: string;
  stages: Lesson["stages"];
  quizzes: Lesson["quizzes"];
  measures: Lesson["measures"];
  convergences: Lesson["convergences"];
}

export interface CourseOutput {
  lessons: LessonOutput[];
  /** Content of index.html below its title. */
  index: string;
  errors: Problem[];
}

function contents(lesson: Lesson): string {
  const sections = lesson.sections.filter((section) => section.level === 2);
  if (sections.length < 2) return "";
  const items = sections.map((section) => `<li><a href="#${section.id}">${section.html}</a></li>`).join("\n");
  return `<nav class="contents" aria-label="Contents"><h2>Contents</h2>\n<ol>\n${items}\n</ol></nav>\n`;
}

function minutes(lesson: Lesson): string {
  return lesson.front.duration ? `${lesson.front.duration} min` : "";
}

function body_of(lessons: Lesson[], i: number): string {
  const lesson = lessons[i];
  const place = lessons.length > 1 ? `<p class="lesson-place">Lesson ${i + 1} of ${lessons.length}</p>\n` : "";
  const duration = minutes(lesson) ? `<p class="lesson-duration">${minutes(lesson)}</p>\n` : "";
  const answers = lesson.answers.length > 0
    ? `<section class="print-answers" aria-hidden="true"><h2>Answers</h2><ol>${lesson.answers.join("\n")}</ol></section>\n` : "";
  return `<header class="lesson-header">
${place}<h1>${escape_html(lesson.front.title)}</h1>
<p class="lesson-summary">${escape_html(lesson.front.summary)}</p>
${duration}</header>
${contents(lesson)}<article class="lesson-text">
${lesson.html}</article>
${answers}`;
}

function index_of(lessons: Lesson[]): string {
  const items = lessons.map((lesson) => {
    const duration = minutes(lesson) ? `<p class="lesson-duration">${minutes(lesson)}</p>` : "";
    return `<li><h2><a href="${encodeURI(lesson.name)}.html">${escape_html(lesson.front.title)}</a></h2>
<p>${escape_html(lesson.front.summary)}</p>${duration}</li>`;
  });
  return `<ol class="lesson-list">
${items.join("\n")}
</ol>
`;
}

/** `read`: throws if a file cannot be read. */
export function compile_course(files: string[], read: (file: string) => string): CourseOutput {
  const problems = new Problems();
  const references = new References();
  const lessons: Lesson[] = [];
  for (const file of files) {
    let text = "";
    try {
      text = read(file);
    } catch (error) {
      problems.add(file, { line: 1, column: 1 }, `cannot read the file: ${(error as Error).message}`);
      continue;
    }
    const lesson = new Lesson(new Source(file, text.replace(/\r\n/g, "\n").replace(/^\uFEFF/, ""), problems), references);
    const twin = lessons.find((other) => other.name === lesson.name);
    if (twin || lesson.name === "index")
      problems.add(file, { line: 1, column: 1 }, twin ? `two lessons have the name '${lesson.name}': ${twin.source.file}` : "the name 'index' is taken by the list of lessons");
    lessons.push(lesson);
  }
  lessons.sort((a, b) => a.front.order - b.front.order || (a.name < b.name ? -1 : 1));
  for (const lesson of lessons) lesson.read();
  const names = new Map(lessons.map((lesson) => [lesson.source, lesson.name]));
  const fill_in = references.resolve_all((source) => names.get(source)!);
  return {
    lessons: lessons.map((lesson, i) => ({
      file: lesson.source.file,
      name: lesson.name,
      title: lesson.front.title,
      summary: lesson.front.summary,
      body: fill_in(body_of(lessons, i)),
      stages: lesson.stages.map((stage) => ({ ...stage, caption: fill_in(stage.caption) })),
      quizzes: lesson.quizzes,
      measures: lesson.measures,
      convergences: lesson.convergences.map((block) => ({ ...block, caption: fill_in(block.caption) })),
    })),
    index: index_of(lessons),
    errors: problems.sorted(),
  };
}
