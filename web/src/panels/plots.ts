// The panel of plots: any number of them, each with its subject to choose.
import type { Actions } from "../ui/actions.ts";
import { h } from "../ui/dom.ts";
import { icon } from "../ui/icons.ts";
import type { PlayerState } from "../ui/player_state.ts";
import { on_theme } from "../ui/theme.ts";
import { Plot } from "./plot.ts";
import { body_quantities, joint_column, read_subjects, scene_quantities, type PlotSubject } from "./quantities.ts";
import { text_of } from "../texts/texts.ts";

interface Row {
  plot: Plot;
  element: HTMLElement;
}

function subject_key(subject: PlotSubject): string {
  return subject.kind === "energy" ? "energy" : `${subject.kind}.${subject.quantity}`;
}

export class Plots {
  readonly element = h("div", { class: "tp-plots" });
  private rows: Row[] = [];
  private list = h("div");

  constructor(private readonly state: PlayerState, private readonly actions: Actions, text: string | undefined) {
    this.element.append(this.list,
      h("button", { type: "button", class: "tp-link", onclick: () => this.add(this.another_subject()).querySelector("select")?.focus() }, text_of("add_plot")));
    for (const subject of this.first_subjects(text)) this.add(subject);
    state.on(["time", "before", "playing"], () => { for (const row of this.rows) row.plot.show_time(); });
    state.on(["run", "compare"], () => this.rebuild());
    on_theme(() => this.rebuild());
  }

  /** Time at the line of the first plot that is drawn, s. */
  cursor(): number | null {
    for (const row of this.rows) {
      const time = row.plot.cursor();
      if (time !== null) return time;
    }
    return null;
  }

  private rebuild(): void {
    for (const row of this.rows) row.plot.rebuild();
  }

  private first_subjects(text: string | undefined): PlotSubject[] {
    const run = this.state.run;
    const asked = read_subjects(text ?? run.overlays.plot ?? "", run);
    if (asked.length > 0) return asked;
    const body = this.state.get("body");
    return body === null ? [{ kind: "energy" }] : [{ kind: "energy" }, { kind: "body", quantity: "y", body }];
  }

  private another_subject(): PlotSubject {
    const body = this.state.get("body");
    return body === null ? { kind: "scene", quantity: "kinetic" } : { kind: "body", quantity: "speed", body };
  }

  private add(first: PlotSubject): HTMLElement {
    let subject = first;
    const bodies = this.state.run.scene.bodies, joints = [...this.state.run.joints.keys()];
    const quantity = h("select", { class: "tp-select tp-quiet", "aria-label": text_of("quantity") },
      h("optgroup", { label: text_of("scene") }, h("option", { value: "energy" }, text_of("energies_stacked")),
        ...[...scene_quantities].map(([key, each]) => h("option", { value: `scene.${key}` }, each.label))),
      joints.length > 0 && h("optgroup", { label: text_of("joint") },
        ...joints.map((name) => h("option", { value: `joint.${name}` }, joint_column(name).label))),
      bodies.length > 0 && h("optgroup", { label: text_of("body") },
        ...[...body_quantities].map(([key, each]) => h("option", { value: `body.${key}` }, each.label))));
    const body = h("select", { class: "tp-select tp-quiet", "aria-label": text_of("body_of_plot") },
      ...bodies.map((each, index) => h("option", { value: index }, each.name)));
    const of = h("span", { class: "tp-of" }, text_of("of"));
    const name = (): string => (subject.kind === "body" ? text_of("quantity_of", { quantity: body_quantities.get(subject.quantity)!.label, whose: bodies[subject.body].name }) :
      subject.kind === "scene" ? scene_quantities.get(subject.quantity)!.label :
      subject.kind === "joint" ? joint_column(subject.quantity).label : text_of("energies"));
    const plot = new Plot(this.state, this.actions, first, name);
    const show = (): void => {
      quantity.value = subject_key(subject);
      const of_body = subject.kind === "body";
      if (subject.kind === "body") body.value = String(subject.body);
      body.hidden = of.hidden = !of_body;
    };
    const choose = (): void => {
      const [, kind, key] = /^([a-z]+)\.(.+)$/.exec(quantity.value) ?? ["", "energy", ""];
      subject = kind === "body" ? { kind, quantity: key, body: Number(body.value) } :
        kind === "scene" || kind === "joint" ? { kind, quantity: key } : { kind: "energy" };
      show();
      plot.rebuild(subject);
    };
    quantity.addEventListener("change", choose);
    body.addEventListener("change", choose);
    if (this.state.get("body") !== null) body.value = String(this.state.get("body"));
    show();
    const row: Row = { plot, element: h("section", { class: "tp-plot" }) };
    row.element.append(
      h("header", {}, quantity, of, body, h("button", {
        type: "button", class: "tp-icon tp-remove", "aria-label": text_of("remove_plot"), title: text_of("remove_plot"),
        onclick: () => this.remove(row),
      }, icon("close"))),
      plot.canvas_box, plot.legend, plot.note);
    this.rows.push(row);
    this.list.append(row.element);
    plot.rebuild();
    return row.element;
  }

  private remove(row: Row): void {
    row.plot.destroy();
    row.element.remove();
    this.rows = this.rows.filter((each) => each !== row);
    this.element.querySelector<HTMLElement>(":scope > button")?.focus();
  }
}
