// Questions with a number as the answer.
import { h } from "../ui/dom.ts";

/** With a decimal point or comma, and any minus; null if it is no number. */
export function read_answer(text: string): number | null {
  const plain = text.trim().replace(/[\u2212\u2013]/g, "-").replace(/\s+/g, "").replace(/^([-+]?\d*),(\d+)/, "$1.$2").replace(/[\u00b7\u00d7*]10\^?/, "e");
  if (!/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(plain)) return null;
  return Number(plain);
}

/** Numbers that a reader writes with few digits are near enough at their last one's half. */
export function is_right(given: number, answer: number, tolerance: number): boolean {
  return Math.abs(given - answer) <= tolerance * (1 + 1e-9);
}

export function start_quiz(element: HTMLElement): void {
  const { answer, tolerance } = JSON.parse(element.dataset.quiz!) as { answer: number; tolerance: number };
  const form = element.querySelector<HTMLFormElement>(".quiz-form")!;
  const input = form.querySelector<HTMLInputElement>(".quiz-input")!;
  const result = form.querySelector<HTMLOutputElement>(".quiz-result")!;
  const solution = element.querySelector<HTMLDetailsElement>(".quiz-answer");
  const hint = element.querySelector<HTMLDetailsElement>(".quiz-hint");
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const given = read_answer(input.value);
    const verdict = given === null ? "unread" : is_right(given, answer, tolerance) ? "right" : "wrong";
    element.dataset.verdict = verdict;
    input.toggleAttribute("aria-invalid", verdict !== "right");
    if (verdict === "unread") result.replaceChildren("Write a number, such as 0.25 or 3e-4.");
    else if (verdict === "right") result.replaceChildren(h("span", { "aria-hidden": "true" }, "\u2713 "), "Right.");
    else result.replaceChildren(h("span", { "aria-hidden": "true" }, "\u2717 "), `Not yet: the number is too ${given! > answer ? "large" : "small"}.${hint ? " There is a hint below." : ""}`);
    if (verdict === "right" && solution) solution.open = true;
  });
  input.addEventListener("input", () => {
    delete element.dataset.verdict;
    input.removeAttribute("aria-invalid");
    result.replaceChildren();
  });
}
