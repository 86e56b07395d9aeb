// The chosen impact: eq. 20, or its row among impulses that act together, with numbers, and how well they fit.
import type { Run } from "../data/clip.ts";
import equations from "../equations.json";
import { h, mathml } from "../ui/dom.ts";
import { number_text, trimmed_text } from "../ui/format.ts";
import { moment_at, pair_text } from "../ui/moments.ts";
import type { PlayerState } from "../ui/player_state.ts";
import { impulse_terms, solve_impulse } from "./impulse_equation.ts";
import { impulses_together, joint_row } from "./joint_impulses.ts";
import { norm } from "./linear.ts";
import { term_of, text_around, text_of } from "../texts/texts.ts";

const most_terms = 6;  // of a sum on one line

const mi = (text: string): MathMLElement => mathml("mi", {}, text);
const mo = (text: string, props = {}): MathMLElement => mathml("mo", props, text);
/** Negative numbers in parentheses. */
const mn = (value: number, plain = false): MathMLElement => {
  const text = trimmed_text(value);
  return mathml("mn", {}, value < 0 && !plain ? `(${text})` : text);
};

const equation_element = (markup: string, ...numbers: MathMLElement[]): HTMLElement => {
  const element = h("div", { class: "tp-equation", tabindex: 0, role: "group", "aria-label": text_of("equation_of_impulse") });
  element.innerHTML = markup;
  element.append(...numbers);
  return element;
};
const with_unit = (unit: string): MathMLElement[] => [mathml("mspace", { width: "0.25em" }), mathml("mtext", {}, unit)];
const line_of = (...parts: MathMLElement[]): MathMLElement => mathml("math", { display: "block", class: "tp-with-numbers" }, ...parts);

/** Larger residuals than rounding: something else takes part. */
const largest_rounding = 1e-6;
const bold = (text: string): HTMLElement => h("b", {}, text);

/** Eq. 20 with the numbers of the impact. */
function impulse_alone(run: Run, index: number): HTMLElement[] {
  const terms = impulse_terms(run, run.impacts[index]);
  const solved = solve_impulse(terms);
  const { mass_a, mass_b, turn_a, turn_b } = solved.denominator;
  const sum = [mass_a, mass_b, turn_a, turn_b].flatMap((value, i) => (i > 0 ? [mo("+"), mn(value)] : [mn(value)]));
  // Friction acts together with the impulse and changes the velocity along the normal too.
  const has_friction = Math.abs(solved.friction) > 1e-12;
  const friction = has_friction ? [mo("\u2212"), mn(solved.friction)] : [];
  const numbers = line_of(
    mathml("mrow", {}, mi("j"), mo("="), mathml("mfrac", {},
      mathml("mrow", {}, mo("\u2212", { form: "prefix" }), mo("(", { stretchy: "false" }), mathml("mn", {}, "1"), mo("+"), mathml("mn", {}, trimmed_text(terms.e)), mo(")", { stretchy: "false" }), mo("\u00b7"), mn(terms.vrel), ...friction),
      mathml("mrow", {}, ...sum)),
    mo("="), mn(solved.j, true), ...with_unit("N\u2009s")));
  const remarks: string[] = [];
  if (has_friction) remarks.push(text_of("friction_share"));
  if (solved.residual > largest_rounding) remarks.push(text_of("others_act"));
  return [
    equation_element(equations.impulse, numbers),
    h("p", { class: "tp-facts" }, ...text_around("recorded", {
      impulse: bold(`${number_text(terms.j, 6)} N s`), residual: bold(number_text(solved.residual, 3, 0)),
    })),
    ...remarks.map((text) => h("p", { class: "tp-hint" }, text))];
}

/** The row of the impact among those that act together. */
function impulse_among_others(run: Run, index: number): HTMLElement[] {
  const { before, after, shares, residual } = joint_row(run, index);
  const terms = shares.slice(0, most_terms).flatMap(({ share }) => [mo("+"), mn(share)]);
  const rest = shares.length > most_terms ? [mo("+"), mo("\u2026")] : [];
  const numbers = line_of(mathml("mrow", {}, mn(before), ...terms, ...rest, mo("="), mn(shares.reduce((sum, { share }) => sum + share, before), true), ...with_unit("m/s")));
  const rows = shares.map(({ index: i, share }) => h("tr", i === index ? { class: "tp-own" } : {},
    h("th", { scope: "row" }, String(i + 1)), h("td", {}, pair_text(run, run.impacts[i])),
    h("td", { class: "tp-number" }, number_text(run.impacts[i].impulse, 6)), h("td", { class: "tp-number" }, number_text(share, 6))));
  return [
    h("p", { class: "tp-hint" }, text_of("act_together", { count: shares.length, impact: index + 1 })),
    equation_element(equations.joint, numbers),
    h("div", { class: "tp-shares", tabindex: 0, role: "group", "aria-label": text_of("impulses_together") }, h("table", {},
      h("thead", {}, h("tr", {}, ...[text_of("column_impact"), text_of("column_pair"), "j (N s)", text_of("column_share")].map((text) => h("th", { scope: "col" }, text)))),
      h("tbody", {}, ...rows))),
    h("p", { class: "tp-facts" }, ...text_around("recorded_row", {
      impulse: bold(`${number_text(run.impacts[index].impulse, 6)} N s`), velocity: bold(`${number_text(after, 6)} m/s`),
      residual: bold(number_text(residual, 3, 0)),
    })),
    ...(residual > largest_rounding ? [h("p", { class: "tp-hint" }, text_of("others_act"))] : [])];
}

export class ImpactCard {
  readonly element = h("div", { class: "tp-card" });
  private side_buttons: HTMLButtonElement[] = [];

  constructor(private readonly state: PlayerState, private readonly heading: "h3" | "h4") {
    state.on(["impact", "run", "before"], () => this.show());
    state.on(["time"], () => this.show_side());
    this.show();
  }

  private show(): void {
    const index = this.state.get("impact");
    const run = this.state.run;
    if (index === null || !run.impacts[index]) {
      this.element.replaceChildren(h("p", { class: "tp-hint" }, text_of("choose_impact")));
      return;
    }
    const impact = run.impacts[index];
    const side = (label: string, before: boolean): HTMLButtonElement => h("button", {
      type: "button", class: "tp-segment", "data-before": String(before),
      onclick: () => this.state.set({ time: impact.time, playing: false, before }),
    }, label);
    this.side_buttons = [side(text_of("before"), true), side(text_of("after"), false)];
    this.element.replaceChildren(
      h("header", {},
        h(this.heading, { class: "tp-title" }, text_of("impact_title", { number: index + 1, pair: pair_text(run, impact) })),
        h("div", { class: "tp-segments", role: "group", "aria-label": text_of("state_shown") }, ...this.side_buttons)),
      h("p", { class: "tp-facts" }, `t = ${number_text(impact.time, 6)} s, ${term_of(impact.feature)}, ` +
        text_of(impact.exact ? "at_own_time" : "at_step_time") +
        (norm([impact.fx, impact.fy, impact.fz]) > 0 ? `, ${text_of("friction_impulse", { impulse: number_text(norm([impact.fx, impact.fy, impact.fz]), 4) })}` : "")),
      ...(impulses_together(run, index).length > 1 ? impulse_among_others(run, index) : impulse_alone(run, index)));
    this.show_side();
  }

  private show_side(): void {
    const index = this.state.get("impact");
    if (index === null) return;
    const here = moment_at(this.state.run, this.state.get("time"));
    const shown = here !== null && here.first <= index && index <= here.last;
    for (const button of this.side_buttons) {
      button.setAttribute("aria-pressed", String(shown && (button.dataset.before === "true") === this.state.get("before")));
    }
  }
}
