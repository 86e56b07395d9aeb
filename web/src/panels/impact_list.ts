// The table of impacts. Only the rows in view exist: a clip may have thousands.
import type { Impact } from "../data/clip.ts";
import type { Actions } from "../ui/actions.ts";
import { h } from "../ui/dom.ts";
import { number_text, trimmed_text } from "../ui/format.ts";
import type { PlayerState } from "../ui/player_state.ts";
import { norm } from "./linear.ts";
import { text_of } from "../texts/texts.ts";

/** Pixels; page.css has the same. */
const row_height = 30;
const rows_beyond = 6;

interface Column {
  title: string;
  hint: string;
  class?: string;
  text(impact: Impact, index: number): string;
}

const columns: Column[] = [
  { title: "#", hint: text_of("hint_number"), text: (_impact, index) => String(index + 1) },
  { title: "t", hint: text_of("hint_time"), text: (impact) => impact.time.toFixed(4) },
  { title: text_of("column_bodies"), hint: text_of("hint_bodies"), class: "tp-left", text: (impact) => `${impact.a}, ${impact.b}` },
  { title: "v\u207b", hint: text_of("hint_before"), text: (impact) => number_text(impact.v_before, 4) },
  { title: "v\u207a", hint: text_of("hint_after"), text: (impact) => number_text(impact.v_after, 4) },
  { title: "\u03b5", hint: text_of("hint_restitution"), class: "tp-wide-only", text: (impact) => trimmed_text(impact.restitution, 3) },
  { title: "j", hint: text_of("hint_impulse"), text: (impact) => number_text(impact.impulse, 4) },
  { title: "|f|", hint: text_of("hint_friction"), class: "tp-wide-only", text: (impact) => number_text(norm([impact.fx, impact.fy, impact.fz]), 3) },
];

export class ImpactList {
  private readonly body = h("tbody");
  private readonly table = h("table", { class: "tp-impacts-table" },
    h("thead", {}, h("tr", {}, ...columns.map((column) => h("th", { scope: "col", title: column.hint, class: column.class }, column.title)))),
    this.body);
  readonly element = h("div", { class: "tp-scroll tp-impacts-scroll", role: "group", "aria-label": text_of("panel_impacts"), tabindex: -1 }, this.table);
  private first = -1;
  private last = -1;
  /** The row that the tab key reaches. */
  private at = 0;

  constructor(private readonly state: PlayerState, private readonly actions: Actions) {
    this.element.addEventListener("scroll", () => this.fill());
    this.element.addEventListener("keydown", (event) => this.on_key(event));
    this.body.addEventListener("click", (event) => {
      const row = (event.target as HTMLElement).closest<HTMLElement>("tr[data-index]");
      if (row) this.choose(Number(row.dataset.index));
    });
    new ResizeObserver(() => this.fill()).observe(this.element);
    state.on(["run"], () => { this.at = 0; this.element.scrollTop = 0; this.fill(true); });
    state.on(["impact"], () => {
      const chosen = state.get("impact");
      if (chosen !== null) this.move_to(chosen);
      this.fill(true);
    });
    this.fill(true);
  }

  private get impacts(): Impact[] {
    return this.state.run.impacts;
  }

  private choose(index: number): void {
    this.at = index;
    this.actions.go_to_impact(index);
  }

  private move_to(index: number): void {
    this.at = Math.min(Math.max(index, 0), this.impacts.length - 1);
    const top = this.at * row_height;
    const head = row_height;
    const box = this.element;
    if (top < box.scrollTop) box.scrollTop = top;
    else if (top + row_height + head > box.scrollTop + box.clientHeight) box.scrollTop = top + row_height + head - box.clientHeight;
  }

  private on_key(event: KeyboardEvent): void {
    const step: Record<string, number> = { ArrowUp: -1, ArrowDown: 1, PageUp: -8, PageDown: 8 };
    if (event.altKey || event.shiftKey || event.ctrlKey || event.metaKey) return;
    if (event.key === "Enter") this.choose(this.at);
    else if (event.key in step) this.move_to(this.at + step[event.key]);
    else return;
    event.preventDefault();
    event.stopPropagation();
    this.fill(true);
    this.body.querySelector<HTMLElement>(`tr[data-index="${this.at}"]`)?.focus({ preventScroll: true });
  }

  /** Makes the rows in view and two spacers for the others. */
  private fill(again = false): void {
    const count = this.impacts.length;
    const height = this.element.clientHeight || 300;
    const first = Math.max(0, Math.floor(this.element.scrollTop / row_height) - rows_beyond);
    const last = Math.min(count, Math.ceil((this.element.scrollTop + height) / row_height) + rows_beyond);
    if (!again && first === this.first && last === this.last) return;
    this.first = first;
    this.last = last;
    const had_focus = this.body.contains(document.activeElement);
    this.table.setAttribute("aria-rowcount", String(count + 1));
    const spacer = (rows: number): HTMLElement =>
      h("tr", { "aria-hidden": "true" }, h("td", { colspan: columns.length, style: `height: ${rows * row_height}px; padding: 0; border: 0` }));
    const rows: HTMLElement[] = [];
    for (let index = first; index < last; index += 1) rows.push(this.row(index));
    if (first > 0) rows.unshift(spacer(first));
    if (last < count) rows.push(spacer(count - last));
    this.body.replaceChildren(...rows);
    if (had_focus) this.body.querySelector<HTMLElement>(`tr[data-index="${this.at}"]`)?.focus({ preventScroll: true });
  }

  private row(index: number): HTMLElement {
    const impact = this.impacts[index];
    const reachable = index === this.at || (index === this.first && (this.at < this.first || this.at >= this.last));
    return h("tr", {
      "data-index": index, tabindex: reachable ? 0 : -1, "aria-rowindex": index + 2, "aria-current": index === this.state.get("impact") && "true",
    }, ...columns.map((column) => h("td", { class: column.class }, column.text(impact, index))));
  }
}
