// What a lesson adds to its players: symbols that light arrows, equations with numbers, questions, print.
import type { Player } from "../ui/player.ts";
import { NumbersBlock } from "./numbers_block.ts";
import { keep_progress } from "./progress.ts";
import { start_quiz } from "./quiz.ts";
import { LessonStages } from "./stages.ts";
import { SymbolLight } from "./symbol_light.ts";

/** Everything folded is printed, but for the answers: they have a page at the end. */
function unfold_for_print(root: HTMLElement): void {
  let folded: HTMLDetailsElement[] = [];
  addEventListener("beforeprint", () => {
    folded = [...root.querySelectorAll<HTMLDetailsElement>("details:not([open]):not(.quiz-answer, .quiz-hint)")];
    for (const details of folded) details.open = true;
  });
  addEventListener("afterprint", () => {
    for (const details of folded) details.open = false;
  });
}

export function start_lesson(players: Player[]): void {
  const root = document.querySelector<HTMLElement>(".lesson-text");
  if (!root) return;
  const stages = new LessonStages(players);
  for (const element of root.querySelectorAll<HTMLElement>("[data-numbers]")) {
    const { stage } = JSON.parse(element.dataset.numbers!) as { stage: string };
    element.dataset.stage = stage;
    const player = stages.by_id(stage);
    if (player) new NumbersBlock(element, player);
  }
  for (const element of root.querySelectorAll<HTMLElement>("[data-quiz]")) start_quiz(element);
  keep_progress(root);
  new SymbolLight(stages, root);
  unfold_for_print(root);
}
