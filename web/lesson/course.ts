// All lessons of a site, in their order, with the parts of pages that the program does not make.
import type { LessonFiles } from "./files.ts";
import { escape_html } from "./html.ts";
import { Lesson } from "./lesson.ts";
import { Problems, type Problem } from "./problems.ts";
import { page_address, References, Targets } from "./references.ts";
import { decode_lesson, Source } from "./source.ts";

/** What the program needs of a lesson. In `body` these comments stand for what it makes: stage:ID, convergence:N,
 * measured:N:ROW, deviation:N:ROW; in the index, picture:N of the lesson N. */
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
  numbers: Lesson["numbers"];
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
  const items = lessons.map((lesson, i) => {
    const duration = minutes(lesson) ? `<p class="lesson-duration">${minutes(lesson)}</p>` : "";
    return `<li><!--picture:${i}--><h2><a href="${escape_html(page_address(lesson.name))}">${escape_html(lesson.front.title)}</a></h2>
<p>${escape_html(lesson.front.summary)}</p>${duration}</li>`;
  });
  return `<ol class="lesson-list">
${items.join("\n")}
</ol>
`;
}

function read_sources(names: string[], files: LessonFiles, problems: Problems): Source[] {
  const sources: Source[] = [];
  for (const name of names) {
    try {
      const text = decode_lesson(name, files.read_lesson(name), problems);
      if (text !== null) sources.push(new Source(name, text, problems));
    } catch (error) {
      problems.add(name, { line: 1, column: 1 }, `cannot read the file: ${(error as Error).message}`);
    }
  }
  return sources;
}

/** Reads all lessons with the targets of references, or without them to collect these. */
function read_lessons(sources: Source[], files: LessonFiles, known: Targets | null): { lessons: Lesson[]; targets: Targets } {
  const targets = new Targets();
  const references = new References(known, files.lies_beside);
  const lessons: Lesson[] = [];
  for (const source of sources) {
    const lesson = new Lesson(source, { targets, references, files });
    const twin = lessons.find((other) => other.name === lesson.name);
    if (twin || lesson.name === "index")
      source.problem({ line: 1, column: 1 }, twin ? `two lessons have the name '${lesson.name}': ${twin.source.file}` : "the name 'index' is taken by the list of lessons");
    lessons.push(lesson);
  }
  lessons.sort((a, b) => a.front.order - b.front.order || (a.name < b.name ? -1 : 1));
  for (const lesson of lessons) lesson.read();
  return { lessons, targets };
}

export function compile_course(names: string[], files: LessonFiles): CourseOutput {
  const problems = new Problems();
  const sources = read_sources(names, files, problems);
  const survey = sources.map((source) => new Source(source.file, source.text, new Problems()));
  const { lessons } = read_lessons(sources, files, read_lessons(survey, files, null).targets);
  return {
    lessons: lessons.map((lesson, i) => ({
      file: lesson.source.file,
      name: lesson.name,
      title: lesson.front.title,
      summary: lesson.front.summary,
      body: body_of(lessons, i),
      stages: lesson.stages,
      quizzes: lesson.quizzes,
      measures: lesson.measures,
      numbers: lesson.numbers,
      convergences: lesson.convergences,
    })),
    index: index_of(lessons),
    errors: problems.sorted(),
  };
}
