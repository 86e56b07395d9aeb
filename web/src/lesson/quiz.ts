// Questions with a number as the answer, or with choices.
import { h } from "../ui/dom.ts";
import { in_language } from "../texts/language.ts";
import { text_of } from "../texts/texts.ts";

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

type Verdict = "right" | "wrong" | "unread";

/** What a question shows after a try. */
class Answer {
  private readonly result: HTMLOutputElement;
  private readonly solution: HTMLDetailsElement | null;
  private readonly hint: boolean;

  constructor(private readonly element: HTMLElement) {
    this.result = in_language(element.querySelector<HTMLOutputElement>(".quiz-result")!);
    this.solution = element.querySelector<HTMLDetailsElement>(".quiz-answer");
    this.hint = element.querySelector(".quiz-hint") !== null;
  }

  show(verdict: Verdict, text: string): void {
    this.element.dataset.verdict = verdict;
    const sign = verdict === "right" ? "\u2713 " : verdict === "wrong" ? "\u2717 " : "";
    this.result.replaceChildren(...(sign ? [h("span", { "aria-hidden": "true" }, sign)] : []), text);
    if (verdict !== "right") return;
    if (this.solution) this.solution.open = true;
    this.element.dispatchEvent(new CustomEvent("tumble-answered", { bubbles: true }));
  }

  with_hint(text: string): string {
    return this.hint ? `${text} ${text_of("hint_below")}` : text;
  }

  clear(): void {
    delete this.element.dataset.verdict;
    this.result.replaceChildren();
  }
}

function start_number(form: HTMLFormElement, shown: Answer, answer: number, tolerance: number): void {
  const input = form.querySelector<HTMLInputElement>(".quiz-input")!;
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const given = read_answer(input.value);
    const verdict = given === null ? "unread" : is_right(given, answer, tolerance) ? "right" : "wrong";
    input.toggleAttribute("aria-invalid", verdict !== "right");
    shown.show(verdict, verdict === "unread" ? text_of("write_number") : verdict === "right" ? text_of("right") :
      shown.with_hint(text_of(given! > answer ? "too_large" : "too_small")));
  });
  input.addEventListener("input", () => {
    input.removeAttribute("aria-invalid");
    shown.clear();
  });
}

function start_choices(form: HTMLFormElement, shown: Answer, right: number): void {
  const inputs = [...form.querySelectorAll<HTMLInputElement>("input")];
  const reason_of = (input: HTMLInputElement): HTMLElement | null => {
    const next = input.closest(".quiz-choice")!.nextElementSibling;
    return next?.classList.contains("quiz-because") ? next as HTMLElement : null;
  };
  const show_reason = (chosen: HTMLInputElement | null): void => {
    for (const input of inputs) {
      const reason = reason_of(input);
      if (reason) reason.hidden = input !== chosen;
    }
  };
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const chosen = inputs.find((input) => input.checked) ?? null;
    show_reason(chosen);
    if (!chosen) shown.show("unread", text_of("choose_answer"));
    else if (Number(chosen.value) === right) shown.show("right", text_of("right"));
    else shown.show("wrong", shown.with_hint(text_of("not_this")));
  });
  form.addEventListener("change", () => {
    show_reason(null);
    shown.clear();
  });
}

export function start_quiz(element: HTMLElement): void {
  const data = JSON.parse(element.dataset.quiz!) as { answer: number; tolerance: number } | { right: number };
  const form = element.querySelector<HTMLFormElement>(".quiz-form")!;
  const shown = new Answer(element);
  if ("right" in data) start_choices(form, shown, data.right);
  else start_number(form, shown, data.answer, data.tolerance);
}
