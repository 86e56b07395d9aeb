// One plot: curves over time with a line at the shown time. Dragging in it sets the time.
import uPlot from "uplot";
import type { Actions } from "../ui/actions.ts";
import { h, set_text } from "../ui/dom.ts";
import { number_text, tick_text } from "../ui/format.ts";
import { impact_marks } from "../ui/impact_marks.ts";
import type { PlayerState } from "../ui/player_state.ts";
import { theme } from "../ui/theme.ts";
import { energy_colors_dark, energy_colors_light, run_colors_dark, run_colors_light, run_dashes } from "./plot_style.ts";
import type { PlotSubject } from "./quantities.ts";
import { energy_stack, plot_series } from "./series.ts";
import { text_of } from "../texts/texts.ts";

interface Curve {
  label: string;
  color: string;
  dash: number[];
  filled: boolean;
  /** Null where the curve ends before the others. */
  values: ArrayLike<number | null>;
  at(time: number, before: boolean): number;
}

interface Curves {
  times: Float64Array;
  unit: string;
  /** In the order of drawing. */
  drawn: Curve[];
  note: string;
}

function energy_curves(state: PlayerState): Curves {
  const stack = energy_stack(state.run);
  const dark = theme() === "dark";
  const colors = dark ? energy_colors_dark : energy_colors_light;
  // The upper layers first: each paints over the part below its lower neighbor's edge.
  const drawn: Curve[] = stack.layers.map((layer) => ({
    label: layer.label, color: colors[layer.key], dash: [], filled: true, values: layer.edge, at: layer.at,
  })).reverse();
  drawn.push({
    label: text_of("at_start_and_work"), color: dark ? "#f2f0ec" : "#222222", dash: [4, 3], filled: false,
    values: stack.supply.values, at: stack.supply.at,
  });
  return { times: stack.times, unit: "J", drawn, note: stack.shift > 0 ? text_of("potential_shift") : "" };
}

function quantity_curves(state: PlayerState, subject: Exclude<PlotSubject, { kind: "energy" }>): Curves {
  const shown = state.runs_shown;
  const data = plot_series(shown.map((index) => state.clip.runs[index]), subject);
  const colors = theme() === "dark" ? run_colors_dark : run_colors_light;
  const drawn = data.series.map((series, order): Curve => ({
    label: series.label, color: colors[shown[order] % colors.length], dash: run_dashes[shown[order] % run_dashes.length],
    filled: false, values: series.values, at: series.at,
  }));
  return { times: data.times, unit: data.unit, drawn, note: "" };
}

/** CSS pixels. */
const plot_height = 150;
const marks_height = 9;

export class Plot {
  readonly legend = h("ul", { class: "tp-values" });
  readonly canvas_box = h("div", { class: "tp-plot-canvas", role: "img" });
  readonly note = h("p", { class: "tp-plot-note", hidden: true });
  private chart: uPlot | null = null;
  private curves: Curves | null = null;
  private line = h("div", { class: "tp-cursor" });
  private value_cells: HTMLElement[] = [];
  private observer: ResizeObserver;

  constructor(private readonly state: PlayerState, private readonly actions: Actions, private subject: PlotSubject,
      private readonly name: () => string) {
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.canvas_box);
  }

  /** Draws the curves of a subject, the same if none is given. */
  rebuild(subject: PlotSubject = this.subject): void {
    this.subject = subject;
    this.chart?.destroy();
    this.chart = null;
    const width = this.canvas_box.clientWidth;
    // Hidden: resize() comes when it has a width.
    if (width === 0) return;
    this.curves = subject.kind === "energy" ? energy_curves(this.state) : quantity_curves(this.state, subject);
    this.chart = new uPlot(this.options(width, this.curves),
      [this.curves.times, ...this.curves.drawn.map((curve) => curve.values)] as unknown as uPlot.AlignedData, this.canvas_box);
    this.chart.over.append(this.line);
    if (this.curves.unit) this.chart.root.append(h("span", { class: "tp-axis-unit", "aria-hidden": "true" }, this.curves.unit));
    this.listen(this.chart.over);
    this.note.hidden = this.curves.note === "";
    set_text(this.note, this.curves.note);
    this.build_legend(this.curves);
    this.show_time();
    // uPlot lays out its first scales in a microtask.
    queueMicrotask(() => this.show_time());
  }

  /** The time at which the line stands, from its place on the screen; null where nothing is drawn. */
  cursor(): number | null {
    if (!this.chart || this.line.style.transform === "") return null;
    return this.chart.posToVal(Number.parseFloat(this.line.style.transform.slice("translateX(".length)), "x");
  }

  show_time(): void {
    if (!this.chart || !this.curves) return;
    const time = this.state.get("time");
    this.line.style.transform = `translateX(${this.chart.valToPos(time, "x")}px)`;
    const texts = this.curves.drawn.map((curve, index) => {
      const text = number_text(curve.at(time, this.state.get("before")), 4);
      set_text(this.value_cells[index], `${text} ${this.curves!.unit}`.trim());
      return `${curve.label} ${text}`.trim();
    });
    if (!this.state.get("playing")) {
      this.canvas_box.setAttribute("aria-label", text_of("plot_at", {
        name: this.name(), time: time.toFixed(3), values: `${texts.join(", ")} ${this.curves.unit}`,
      }));
    }
  }

  destroy(): void {
    this.observer.disconnect();
    this.chart?.destroy();
    this.chart = null;
  }

  private resize(): void {
    const width = this.canvas_box.clientWidth;
    if (width === 0) return;
    if (!this.chart) this.rebuild();
    else if (this.chart.width !== width) {
      this.chart.setSize({ width, height: plot_height });
      this.show_time();
    }
  }

  /** Energies from the top of the stack down, as they stand in the plot. */
  private build_legend(curves: Curves): void {
    const alone = curves.drawn.length === 1;
    this.value_cells = curves.drawn.map(() => h("b", {}));
    this.legend.replaceChildren(...curves.drawn.map((curve, index) => h("li", {},
      alone ? null : h("span", {
        class: curve.filled ? "tp-key tp-key-filled" : "tp-key",
        style: `--swatch: ${curve.color}; --dash: ${curve.dash.length ? "dashed" : "solid"}`,
      }), curve.label ? `${curve.label} ` : "", this.value_cells[index])));
  }

  private listen(over: HTMLElement): void {
    const seek = (event: PointerEvent): void => {
      const box = over.getBoundingClientRect();
      this.actions.seek(this.chart!.posToVal(event.clientX - box.left, "x"));
    };
    over.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      over.setPointerCapture(event.pointerId);
      seek(event);
    });
    over.addEventListener("pointermove", (event) => { if (over.hasPointerCapture(event.pointerId)) seek(event); });
  }

  private options(width: number, curves: Curves): uPlot.Options {
    const style = getComputedStyle(this.canvas_box);
    const ink = style.getPropertyValue("--ink-soft");
    const grid = style.getPropertyValue("--line-soft");
    const font = `11px ${style.getPropertyValue("--sans")}`;
    const axis = { stroke: ink, font, grid: { stroke: grid, width: 1 }, ticks: { show: false }, border: { show: false } };
    return {
      width, height: plot_height,
      legend: { show: false },
      cursor: { show: false },
      padding: [curves.unit ? 18 : 8, 8, 0, 0],
      scales: {
        x: { time: false, range: () => [0, this.state.duration || 1] },
        // Areas stand on zero.
        y: curves.drawn.some((curve) => curve.filled) ? { range: (_chart, _least, most) => [0, (most || 1) * 1.06] } : {},
      },
      axes: [
        { ...axis, size: 26, gap: 4, values: (_chart, ticks) => ticks.map((tick, i) => (i === ticks.length - 1 ? `${tick_text(tick)} s` : tick_text(tick))) },
        { ...axis, size: 46, gap: 4, space: 34, values: (_chart, ticks) => ticks.map(tick_text) },
      ],
      series: [{}, ...curves.drawn.map((curve): uPlot.Series => ({
        stroke: curve.color, width: curve.filled ? 0 : 1.75, dash: curve.dash, fill: curve.filled ? curve.color : undefined,
        points: { show: false }, spanGaps: false, pxAlign: 0,
      }))],
      hooks: { draw: [(chart) => this.draw_impacts(chart, style.getPropertyValue("--mark"))] },
    };
  }

  /** At the lower edge; many small ones do not cover the curve. */
  private draw_impacts(chart: uPlot, color: string): void {
    const { ctx, bbox } = chart;
    const body = this.subject.kind === "body" ? this.subject.body : null;
    ctx.save();
    ctx.fillStyle = color;
    ctx.globalAlpha = 0.8;
    for (const [column, share] of impact_marks(this.state.run, body, (time) => chart.valToPos(time, "x", true))) {
      const height = share * marks_height * devicePixelRatio;
      ctx.fillRect(column, bbox.top + bbox.height - height, Math.max(1, Math.round(devicePixelRatio)), height);
    }
    ctx.restore();
  }
}
