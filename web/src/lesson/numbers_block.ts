// "Put in the numbers": the equation with the values of an impact, or of the shown moment, and how well both sides agree.
import type { NumbersData } from "../../lesson/blocks/numbers.ts";
import { unit_of } from "../../lesson/symbols.ts";
import { h, new_id, set_text } from "../ui/dom.ts";
import { number_text } from "../ui/format.ts";
import { pair_text } from "../ui/moments.ts";
import type { Player } from "../ui/player.ts";
import { evaluate, residual, type Values } from "./evaluate.ts";
import { impact_of } from "./stages.ts";
import { moment_values, impact_values } from "./symbol_values.ts";
import { value_text, with_values } from "./value_math.ts";
import { in_language } from "../texts/language.ts";
import { text_of } from "../texts/texts.ts";

export class NumbersBlock {
  private readonly data: NumbersData;
  private readonly equation: Element | null;
  private readonly result = h("div", { class: "numbers-result", id: new_id("numbers"), hidden: true });
  private readonly substituted = h("div", { class: "numbers-equation numbers-substituted", tabindex: 0, role: "group", "aria-label": text_of("with_numbers") });
  private readonly sides = h("dl", { class: "numbers-sides" });
  private readonly moment = h("p", { class: "numbers-moment", "aria-live": "polite" });
  private readonly open: HTMLButtonElement;
  private readonly exact: HTMLButtonElement;
  /** Impact of this block, until the stage's own choice changes. */
  private impact: number;
  private all_digits = false;

  constructor(private readonly element: HTMLElement, private readonly player: Player) {
    this.data = JSON.parse(element.dataset.numbers!) as NumbersData;
    this.impact = this.data.impact - 1;
    this.equation = element.querySelector("math");
    this.open = h("button", { type: "button", class: "lesson-button numbers-open", "aria-expanded": "false", "aria-controls": this.result.id, onclick: () => this.toggle() }, text_of("put_in_numbers"));
    this.exact = h("button", { type: "button", class: "lesson-link", "aria-pressed": "false", onclick: () => this.toggle_digits() }, text_of("digits_17"));
    const bar = in_language(h("div", { class: "numbers-bar" }, this.open));
    in_language(this.result);
    if (this.data.moment === "impact") bar.append(this.impact_buttons());
    this.result.append(this.moment, this.substituted, this.sides, this.exact);
    element.append(bar, this.result);
    player.state.on(["impact", "run"], () => this.follow_choice());
    if (this.data.moment === "now") player.state.on(["time", "body", "before", "run"], () => this.show());
  }

  private impact_buttons(): HTMLElement {
    const step = (label: string, text: string, way: 1 | -1): HTMLButtonElement =>
      h("button", { type: "button", class: "lesson-button", "aria-label": label, onclick: () => this.choose(this.impact + way) }, text);
    return h("span", { class: "numbers-choice", role: "group", "aria-label": text_of("impact") },
      step(text_of("previous_impact"), "\u2190", -1), step(text_of("next_impact"), "\u2192", 1));
  }

  private choose(index: number): void {
    const count = this.player.state.run.impacts.length;
    if (count === 0) return;
    this.impact = (index + count) % count;
    const { time } = this.player.state.run.impacts[this.impact];
    this.player.state.set({ time, playing: false, impact: this.impact });
    if (this.result.hidden) this.toggle();
    else this.show();
  }

  private follow_choice(): void {
    const chosen = this.player.state.get("impact");
    if (chosen !== null) this.impact = chosen;
    this.show();
  }

  private toggle(): void {
    this.result.hidden = !this.result.hidden;
    this.open.setAttribute("aria-expanded", String(!this.result.hidden));
    set_text(this.open, text_of(this.result.hidden ? "put_in_numbers" : "hide_numbers"));
    this.show();
  }

  private toggle_digits(): void {
    this.all_digits = !this.all_digits;
    this.exact.setAttribute("aria-pressed", String(this.all_digits));
    this.show();
  }

  /** Null if the run has no impact. */
  private values(): Values | null {
    const { state } = this.player;
    if (this.data.moment === "now") {
      const body = state.get("body");
      return body === null ? null : moment_values(state.run, state.get("time"), body, state.get("before"));
    }
    if (!state.run.impacts[this.impact]) this.impact = impact_of(this.player) ?? 0;
    return state.run.impacts[this.impact] ? impact_values(state.run, this.impact) : null;
  }

  private moment_text(): string {
    const { state } = this.player;
    const run = state.clip.runs.length > 1 && state.run.label ? `, ${state.run.label}` : "";
    if (this.data.moment === "now") {
      const body = state.get("body");
      const name = body === null ? text_of("no_body") : state.run.scene.bodies[body].name;
      return text_of("body_at", { body: name, time: number_text(state.get("time"), 4) }) + run;
    }
    const impact = state.run.impacts[this.impact];
    return text_of("impact_of", {
      number: this.impact + 1, count: state.run.impacts.length, time: number_text(impact.time, 6), pair: pair_text(state.run, impact),
    }) + run;
  }

  private show(): void {
    if (this.result.hidden || !this.equation) return;
    const values = this.values();
    if (!values) {
      set_text(this.moment, text_of("run_without_impact"));
      this.substituted.replaceChildren();
      this.sides.replaceChildren();
      return;
    }
    set_text(this.moment, this.moment_text());
    this.substituted.replaceChildren(with_values(this.equation, values));
    const left = evaluate(this.data.value, values);
    const right = evaluate(this.data.expression, values);
    const unit = typeof this.data.value === "string" ? unit_of(this.data.value) : "";
    const digits = this.all_digits ? 17 : 6;
    const row = (term: string, text: string, kind: string): HTMLElement => h("div", {}, h("dt", {}, term), h("dd", { class: kind }, text));
    const difference = residual(left, right);
    this.element.dataset.residual = String(difference);
    this.sides.replaceChildren(
      row(text_of("left_side"), `${value_text(left, digits)} ${unit}`.trim(), "left"),
      row(text_of("right_side"), `${value_text(right, digits)} ${unit}`.trim(), "right"),
      row(text_of("residual"), number_text(difference, 3, 0), "residual"));
  }
}
