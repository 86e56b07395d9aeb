// The slider of the time, with a mark at each moment of impact.
import type { Actions } from "./actions.ts";
import { h } from "./dom.ts";
import { impact_marks } from "./impact_marks.ts";
import type { PlayerState } from "./player_state.ts";
import { on_theme } from "./theme.ts";
import { text_of } from "../texts/texts.ts";

const marks_height = 14;

export class ScrubBar {
  private readonly marks = h("canvas", { class: "tp-marks", "aria-hidden": "true" });
  private readonly fill = h("div", { class: "tp-track-fill" });
  private readonly thumb = h("div", { class: "tp-thumb" });
  private readonly track = h("div", { class: "tp-track" }, this.fill, this.thumb);
  readonly element = h("div", { class: "tp-scrub", role: "slider", tabindex: 0, "aria-label": text_of("time"), "aria-valuemin": "0" },
    this.marks, this.track);

  constructor(private readonly state: PlayerState, private readonly actions: Actions) {
    this.element.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      this.element.setPointerCapture(event.pointerId);
      this.seek_to(event);
    });
    this.element.addEventListener("pointermove", (event) => {
      if (this.element.hasPointerCapture(event.pointerId)) this.seek_to(event);
    });
    state.on(["time"], () => this.show_time());
    state.on(["run", "compare"], () => { this.show_time(); this.draw_marks(); });
    on_theme(() => this.draw_marks());
    new ResizeObserver(() => this.draw_marks()).observe(this.element);
    this.show_time();
  }

  private seek_to(event: PointerEvent): void {
    const box = this.track.getBoundingClientRect();
    const fraction = Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1);
    this.actions.seek(fraction * this.state.duration);
  }

  private show_time(): void {
    const time = this.state.get("time");
    const percent = `${((100 * time) / this.state.duration || 0).toFixed(3)}%`;
    this.fill.style.width = percent;
    this.thumb.style.left = percent;
    this.element.setAttribute("aria-valuemax", this.state.duration.toFixed(3));
    this.element.setAttribute("aria-valuenow", time.toFixed(3));
    this.element.setAttribute("aria-valuetext", text_of("time_value", { time: Number(time.toFixed(3)), frame: this.state.frame }));
  }

  private draw_marks(): void {
    const width = this.track.clientWidth;
    const ratio = devicePixelRatio || 1;
    this.marks.width = width * ratio;
    this.marks.height = marks_height * ratio;
    const context = this.marks.getContext("2d");
    if (!context || width === 0) return;
    context.scale(ratio, ratio);
    context.fillStyle = getComputedStyle(this.element).getPropertyValue("--mark");
    const marks = impact_marks(this.state.run, null, (time) => (time / this.state.duration) * width);
    for (const [column, height] of marks) context.fillRect(column - 0.5, marks_height * (1 - height), 1, marks_height * height);
  }
}
