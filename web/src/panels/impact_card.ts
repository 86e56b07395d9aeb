// The chosen impact: eq. 20, the same with its numbers, and how well they fit.
import type { Run } from "../data/clip.ts";
import equations from "../equations.json";
import { h, mathml } from "../ui/dom.ts";
import { number_text, trimmed_text } from "../ui/format.ts";
import { moment_at, moments_of, pair_text } from "../ui/moments.ts";
import type { PlayerState } from "../ui/player_state.ts";
import { norm } from "./linear.ts";
import { impulse_terms, solve_impulse } from "./impulse_equation.ts";

const mi = (text: string): MathMLElement => mathml("mi", {}, text);
const mo = (text: string, props = {}): MathMLElement => mathml("mo", props, text);
/** Negative numbers in parentheses. */
const mn = (value: number, plain = false): MathMLElement => {
  const text = trimmed_text(value);
  return mathml("mn", {}, value < 0 && !plain ? `(${text})` : text);
};

function with_numbers(state: PlayerState, index: number): { math: MathMLElement; recorded: number; residual: number; friction: number } {
  const terms = impulse_terms(state.run, state.run.impacts[index]);
  const solved = solve_impulse(terms);
  const { mass_a, mass_b, turn_a, turn_b } = solved.denominator;
  const sum = [mass_a, mass_b, turn_a, turn_b].flatMap((value, i) => (i > 0 ? [mo("+"), mn(value)] : [mn(value)]));
  // Friction acts together with the impulse and changes the velocity along the normal too.
  const friction = Math.abs(solved.friction) > 1e-12 ? [mo("\u2212"), mn(solved.friction)] : [];
  const math = mathml("math", { display: "block", class: "tp-with-numbers" },
    mathml("mrow", {}, mi("j"), mo("="), mathml("mfrac", {},
      mathml("mrow", {}, mo("\u2212", { form: "prefix" }), mo("(", { stretchy: "false" }), mathml("mn", {}, "1"), mo("+"), mathml("mn", {}, trimmed_text(terms.e)), mo(")", { stretchy: "false" }), mo("\u00b7"), mn(terms.vrel), ...friction),
      mathml("mrow", {}, ...sum)),
    mo("="), mn(solved.j, true), mathml("mspace", { width: "0.25em" }), mathml("mtext", {}, "N\u2009s")));
  return { math, recorded: terms.j, residual: solved.residual, friction: solved.friction };
}

/** Other impulses of the same moment and pass of the law that act on one of its dynamic bodies. */
function coupled_impulses(run: Run, index: number): number {
  const impact = run.impacts[index];
  const moment = moments_of(run).find((each) => each.first <= index && index <= each.last)!;
  const dynamic = [impact.body_a, impact.body_b].filter((body) => run.scene.bodies[body]?.type === "dynamic");
  return run.impacts.slice(moment.first, moment.last + 1).filter((other) => other !== impact && other.pass === impact.pass &&
    dynamic.some((body) => other.body_a === body || other.body_b === body)).length;
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
      this.element.replaceChildren(h("p", { class: "tp-hint" }, "Choose an impact to see its impulse computed."));
      return;
    }
    const impact = run.impacts[index];
    const { math, recorded, residual, friction } = with_numbers(this.state, index);
    const equation = h("div", { class: "tp-equation", tabindex: 0, role: "group", "aria-label": "Equation of the impulse" });
    equation.innerHTML = equations.impulse;
    equation.append(math);
    const together = coupled_impulses(run, index);
    const remarks: string[] = [];
    if (friction !== 0 && Math.abs(friction) > 1e-12) remarks.push("The last term of the numerator is the share of the friction impulse.");
    if (together > 0) {
      remarks.push(`${together + 1} impulses act on these bodies together; eq. 20 holds for one alone and gives another number.`);
    }
    const side = (label: string, before: boolean): HTMLButtonElement => h("button", {
      type: "button", class: "tp-segment", "data-before": String(before),
      onclick: () => this.state.set({ time: impact.time, playing: false, before }),
    }, label);
    this.side_buttons = [side("before", true), side("after", false)];
    this.element.replaceChildren(
      h("header", {},
        h(this.heading, { class: "tp-title" }, `Impact ${index + 1}: ${pair_text(run, impact)}`),
        h("div", { class: "tp-segments", role: "group", "aria-label": "State shown" }, ...this.side_buttons)),
      h("p", { class: "tp-facts" }, `t = ${number_text(impact.time, 6)} s, ${impact.feature}, ` +
        `${impact.exact ? "at its own time" : "at the time of the step"}` +
        (norm([impact.fx, impact.fy, impact.fz]) > 0 ? `, friction impulse ${number_text(norm([impact.fx, impact.fy, impact.fz]), 4)} N s` : "")),
      equation,
      h("p", { class: "tp-facts" }, "Recorded: ", h("b", {}, `${number_text(recorded, 6)} N s`),
        ...(together > 0 ? ["."] : ["; residual ", h("b", {}, number_text(residual, 3, 0)), "."])),
      ...remarks.map((text) => h("p", { class: "tp-hint" }, text)));
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
