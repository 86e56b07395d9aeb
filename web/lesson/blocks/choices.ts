// The choices of a question: one of them is right, and each may say why.
import type { Table } from "../table.ts";
import { json_attribute } from "../html.ts";
import type { BlockContext } from "./block.ts";

const least = 2, most = 8;

export interface Choices {
  /** Index of the right one. */
  right: number;
  /** Markdown as HTML. */
  texts: string[];
  reasons: string[];
}

export function read_choices(quiz: Table, context: BlockContext): Choices {
  const tables = quiz.tables("choices") ?? [];
  const choices: Choices = { right: 0, texts: [], reasons: [] };
  let count = 0;
  for (const [i, table] of tables.entries()) {
    const text = (key: string): string => {
      table.text(key);
      return table.has(key) ? context.markdown(table, key, true) : "";
    };
    table.require("text", "Markdown");
    if (table.boolean("right")) {
      choices.right = i;
      ++count;
    }
    choices.texts.push(text("text"));
    choices.reasons.push(text("because"));
    table.finish();
  }
  if (tables.length < least || tables.length > most)
    quiz.problem("choices", `choices: must be ${least} to ${most} tables (given ${tables.length})`);
  else if (count !== 1) quiz.problem("choices", `choices: one of them must have right = true (given ${count})`);
  return choices;
}

/** `id`: of the question. */
export function choices_html(id: string, { texts, reasons }: Choices): string {
  const options = texts.map((text, i) => `<label class="quiz-choice"><input type="radio" name="${id}" value="${i}"><span>${text}</span></label>${
    reasons[i] ? `\n<p class="quiz-because" hidden>${reasons[i]}</p>` : ""}`);
  return `<fieldset class="quiz-choices" aria-labelledby="${id}-question">
${options.join("\n")}
</fieldset>
<button class="quiz-check" type="submit">Check</button>
<output class="quiz-result" role="status" aria-live="polite"></output>`;
}

export function choices_data({ right }: Choices): string {
  return json_attribute({ right });
}
