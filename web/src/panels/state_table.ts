// The state X(t) = (x, R, P, L) of the chosen body, and the quantities that follow from it.
import type { BodyState, Mat3, Run, Vec3 } from "../data/clip.ts";
import { h, new_id, set_text } from "../ui/dom.ts";
import { number_text, plain_text, time_text, type Digits } from "../ui/format.ts";
import type { PlayerState } from "../ui/player_state.ts";
import { build_body_select } from "../ui/toolbar.ts";
import { term_of, text_around, text_of } from "../texts/texts.ts";
import { rotation_matrix, turned } from "./linear.ts";
import { kinetic_energy, potential_energy } from "./quantities.ts";

interface Row {
  name: string;
  /** As HTML: bold vectors, italic scalars. */
  symbol: string;
  unit: string;
  /** Numbers in a line of the table. */
  columns: 1 | 3 | 4;
  /** Numbers nearer to 0 are 0, but for 17 digits: the page does not know them. Default: that of number_text(). */
  zero?(run: Run, body: number): number;
  values(run: Run, body: number, state: BodyState): number[];
}

const vector = (name: string, symbol: string, unit: string, of: (state: BodyState) => Vec3, zero?: Row["zero"]): Row =>
  ({ name, symbol: `<b>${symbol}</b>`, unit, columns: 3, zero, values: (_run, _body, state) => of(state) });
const matrix = (name: string, symbol: string, unit: string, of: (run: Run, body: number, state: BodyState) => Mat3): Row =>
  ({ name, symbol: `<b>${symbol}</b>`, unit, columns: 3, values: of });
const number = (name: string, symbol: string, unit: string, of: (run: Run, body: number, state: BodyState) => number): Row =>
  ({ name, symbol, unit, columns: 1, values: (run, body, state) => [of(run, body, state)] });

/** Half of the sixth decimal: entries of rotations are at most 1. */
const rounding = (): number => 5e-7;
const heaviest = (inertia: Mat3): number => Math.max(...inertia.map(Math.abs));
const position = vector("position", "x", "m", (state) => state.position);
const quaternion: Row = { name: "rotation", symbol: "<i>q</i>", unit: "", columns: 4, zero: rounding, values: (_run, _body, state) => state.rotation };
const rotation: Row = { ...matrix("rotation", "R", "", (_run, _body, state) => rotation_matrix(state.rotation)), zero: rounding };
const rest_of_state: Row[] = [
  vector("momentum", "P", "kg m/s", (state) => state.momentum, (run, body) => run.scene.bodies[body].mass * run.motion.error.velocity),
  vector("angular momentum", "L", "kg m\u00b2/s", (state) => state.angular_momentum,
    (run, body) => heaviest(run.scene.bodies[body].inertia) * run.motion.error.angular_velocity),
];
const derived: Row[] = [
  vector("velocity", "v", "m/s", (state) => state.velocity, (run) => run.motion.error.velocity),
  vector("angular velocity", "\u03c9", "rad/s", (state) => state.angular_velocity, (run) => run.motion.error.angular_velocity),
  {
    ...matrix("inertia, world", "I", "kg m\u00b2", (run, body, state) => turned(run.scene.bodies[body].inertia, state.rotation)),
    zero: (run, body) => rounding() * heaviest(run.scene.bodies[body].inertia),
  },
  number("kinetic energy", "<i>E</i><sub>kin</sub>", "J", kinetic_energy),
  number("potential energy", "<i>E</i><sub>pot</sub>", "J", potential_energy),
];

function table_row(row: Row): { element: HTMLTableRowElement; cells: HTMLElement[] } {
  const cells = Array.from({ length: row.symbol === "<b>R</b>" || row.symbol === "<b>I</b>" ? 9 : row.columns }, () => h("span"));
  const symbol = h("span", { class: "tp-symbol" });
  symbol.innerHTML = row.symbol;
  return {
    cells,
    element: h("tr", {}, h("th", { scope: "row" }, symbol, h("span", { class: "tp-name" }, term_of(row.name)), h("span", { class: "tp-unit" }, row.unit)),
      h("td", {}, h("div", { class: `tp-numbers tp-columns-${row.columns}` }, ...cells))),
  };
}

export class StateTable {
  readonly element = h("div", { class: "tp-state" });
  private digits: Digits = 6;
  private as_matrix = false;
  private rows: { row: Row; cells: HTMLElement[] }[] = [];
  private table = h("table", { class: "tp-state-table" });
  private readonly moment = h("span", { class: "tp-moment" });

  constructor(private readonly state: PlayerState) {
    const copied = h("span", { class: "tp-copied", role: "status" });
    const toggle = (label: string, change: (on: boolean) => void): HTMLButtonElement => {
      const button = h("button", {
        type: "button", class: "tp-chip", "aria-pressed": "false",
        onclick: () => {
          const on = button.getAttribute("aria-pressed") !== "true";
          button.setAttribute("aria-pressed", String(on));
          change(on);
          this.build();
        },
      }, label);
      return button;
    };
    const caption = new_id("tp-state");
    this.table.setAttribute("aria-labelledby", caption);
    this.element.append(
      h("div", { class: "tp-row" }, build_body_select(state), h("span", { id: caption, class: "tp-caption" }, ...text_around("state_at", { time: this.moment }))),
      h("div", { class: "tp-scroll", tabindex: 0, role: "group", "aria-label": text_of("state_of_body") }, this.table),
      h("div", { class: "tp-row" },
        toggle(text_of("as_matrix"), (on) => { this.as_matrix = on; }),
        toggle(text_of("digits_17"), (on) => { this.digits = on ? 17 : 6; }),
        h("button", { type: "button", class: "tp-chip", onclick: () => void this.copy(copied) }, text_of("copy")), copied));
    state.on(["time", "run", "body", "before"], () => this.show());
    this.build();
  }

  private get listed(): Row[] {
    return [position, this.as_matrix ? rotation : quaternion, ...rest_of_state, ...derived];
  }

  private build(): void {
    const made = this.listed.map((row) => ({ row, ...table_row(row) }));
    this.rows = made;
    this.table.classList.toggle("tp-long", this.digits === 17);
    this.table.replaceChildren(
      h("tbody", {}, ...made.slice(0, 2 + rest_of_state.length).map((each) => each.element)),
      h("tbody", { class: "tp-derived" }, ...made.slice(2 + rest_of_state.length).map((each) => each.element)));
    this.show();
  }

  private body_state(): { body: number; state: BodyState } | null {
    const body = this.state.get("body");
    if (body === null) return null;
    const motion = this.state.run.motion;
    const time = this.state.get("time");
    return { body, state: this.state.get("before") ? motion.state_before(body, time) : motion.state(body, time) };
  }

  private show(): void {
    const now = this.body_state(), time = time_text(this.state.get("time"));
    set_text(this.moment, this.state.get("before") ? text_of("before_impact", { time }) : time);
    for (const { row, cells } of this.rows) {
      const values = now ? row.values(this.state.run, now.body, now.state) : [];
      const zero = now ? row.zero?.(this.state.run, now.body) : undefined;
      for (const [index, cell] of cells.entries()) {
        set_text(cell, index < values.length ? number_text(values[index], this.digits, zero) : "\u2013");
      }
    }
  }

  /** Name, unit and numbers of each row, separated by tabs. */
  private async copy(copied: HTMLElement): Promise<void> {
    const now = this.body_state();
    if (!now) return;
    const lines = [`${this.state.run.scene.bodies[now.body].name}\tt = ${plain_text(this.state.get("time"))} s`];
    for (const { row } of this.rows) {
      const numbers = row.values(this.state.run, now.body, now.state).map((value) => plain_text(value, this.digits));
      lines.push([term_of(row.name), row.unit, ...numbers].join("\t"));
    }
    try {
      await navigator.clipboard.writeText(lines.join("\n"));
      copied.textContent = text_of("copied");
    } catch {
      copied.textContent = text_of("no_clipboard");
    }
    setTimeout(() => { copied.textContent = ""; }, 2000);
  }
}
