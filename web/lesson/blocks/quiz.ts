// The block `quiz`: a question whose answer is a number, which the run itself must give, or one of several choices.
import type { Place } from "../problems.ts";
import { escape_html, json_attribute, number_html } from "../html.ts";
import { block_table, places_of, type BlockContext, type BlockText } from "./block.ts";
import { read_check, type Check } from "./check.ts";
import { choices_data, choices_html, read_choices } from "./choices.ts";

export interface QuizBlock {
  stage: string;
  answer: number;
  tolerance: number;
  unit: string;
  check?: Check;
  place: Place;
  places: Record<string, Place>;
}

/** `number`: from 1 in the lesson. */
export function read_quiz(block: BlockText, context: BlockContext, number: number): { quiz: QuizBlock; html: string; answer: string } | null {
  const table = block_table(block);
  if (!table) return null;
  table.require("question", "Markdown");
  const choices = table.has("choices") ? read_choices(table, context) : null;
  if (choices) {
    for (const key of ["answer", "tolerance", "unit", "stage", "check"])
      if (table.has(key)) table.problem(key, `${key}: is of questions with a number, not of choices`);
  } else {
    table.require("answer", "a number");
    table.require("tolerance", "the largest deviation that counts as right, in the unit of the answer");
  }
  const stage = table.has("stage") ? context.use_stage(table) : "";
  const quiz: QuizBlock = {
    stage,
    answer: table.number("answer") ?? 0,
    tolerance: table.number("tolerance", 0) ?? 0,
    unit: table.text("unit") ?? "",
    check: read_check(table, "check"),
    place: block.place,
    places: places_of(table, ["answer", "check"]),
  };
  if (quiz.check && !stage) table.problem("check", "check: needs stage = \"...\": the stage whose run gives the number");
  const text = (key: string) => {
    table.text(key);
    return table.has(key) ? context.markdown(table, key, false) : "";
  };
  const question = text("question");
  const hint = text("hint");
  const explanation = text("explanation");
  table.finish();

  const unit = escape_html(quiz.unit);
  const id = `quiz-${number}`;
  const answer = choices ? choices.texts[choices.right] : `${number_html(quiz.answer)}${unit ? `&nbsp;${unit}` : ""}`;
  const reason = choices?.reasons[choices.right] ? `<p>${choices.reasons[choices.right]}</p>` : "";
  const entry = choices ? choices_html(id, choices) : number_entry(id, unit);
  const data = choices ? choices_data(choices) : json_attribute({ answer: quiz.answer, tolerance: quiz.tolerance });
  const html = `<section class="quiz" id="${id}" aria-labelledby="${id}-title" data-quiz="${data}">
<h3 class="quiz-title" id="${id}-title">Question ${number}</h3>
<div class="quiz-question" id="${id}-question">${question}</div>
<form class="quiz-form" novalidate>
${entry}
</form>${choices ? "" : `\n<p class="quiz-blank" aria-hidden="true"></p>`}${
    hint ? `\n<details class="quiz-hint"><summary>Hint</summary>${hint}</details>` : ""}
<details class="quiz-answer"><summary>Answer</summary><p>${answer}</p>${reason}${explanation}</details>
</section>
`;
  return { quiz, html, answer: `<li value="${number}"><p>${answer}</p>${reason}${explanation}</li>` };
}

function number_entry(id: string, unit: string): string {
  return `<label class="quiz-label" for="${id}-input">Your answer</label>
<input class="quiz-input" id="${id}-input" inputmode="decimal" autocomplete="off" aria-describedby="${id}-question">${
    unit ? `\n<span class="quiz-unit">${unit}</span>` : ""}
<button class="quiz-check" type="submit">Check</button>
<output class="quiz-result" for="${id}-input" role="status" aria-live="polite"></output>`;
}
