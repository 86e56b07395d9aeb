// The laboratory below a player: values to change, the scene's text, and the run that they give.
import type { Clip, Run } from "../data/clip.ts";
import { h, set_text } from "../ui/dom.ts";
import { text_of } from "../texts/texts.ts";
import type { Player } from "../ui/player.ts";
import { build_run_bar } from "../ui/toolbar.ts";
import { setting_words, simulate_command } from "./command.ts";
import { build_control, type ControlView } from "./controls.ts";
import { Editor } from "./editor.ts";
import type { LiveError } from "./module.ts";
import type { LiveOptions } from "./options.ts";
import type { PristinePage } from "./save_page.ts";
import { looks_alike, remounted, ShownRun } from "./shown_run.ts";
import { Simulation, time_limit } from "./simulation.ts";

/** A run that takes longer shows its progress, ms. */
const quiet_time = 300;

export class LivePanel {
  readonly element: HTMLElement;
  private readonly controls: ControlView[];
  private readonly editor: Editor | null;
  private readonly status = h("p", { class: "tp-live-status", role: "status" });
  private readonly command = h("code", { class: "tp-live-command", tabindex: 0 });
  private readonly stop = this.button(text_of("stop"), () => this.simulation.stop());
  private readonly reset = this.button(text_of("reset"), () => this.go_back());
  private readonly pin = this.button(text_of("keep"), () => this.keep());
  private readonly clear = this.button(text_of("clear_kept"), () => this.clear_kept());
  private readonly runs = h("div");
  private readonly recorded: Run;
  private readonly simulation: Simulation;
  private shown: ShownRun;
  /** Index of the live run: the recorded one's if there is a single one, else behind them. */
  private slot: number;
  private start_time = 0;
  private running = false;

  constructor(private player: Player, private readonly options: LiveOptions, private readonly make: (figure: HTMLElement, clip: Clip) => Player,
      private readonly page: PristinePage) {
    this.recorded = player.clip.runs[0];
    this.shown = new ShownRun(player);
    this.slot = player.clip.runs.length > 1 ? player.clip.runs.length : 0;
    const changed = (): void => this.run();
    this.controls = options.controls.map((control) => build_control(control, changed));
    const text = player.clip.sources[options.source].text;
    this.editor = options.editor ? new Editor(options.name, text, changed) : null;
    this.simulation = new Simulation({
      ready: () => this.be_ready(),
      failed: (reason) => this.give_up(reason),
      progress: (share) => this.show_progress(share),
      data: (clip, whole, error) => this.show_clip(clip, whole, error),
      error: (error) => this.show_error(error),
      stopped: () => { this.end(); set_text(this.status, text_of("stopped")); },
    });
    this.stop.hidden = true;
    this.clear.hidden = true;
    this.element = h("section", { class: "tp-live", "aria-label": text_of("change_and_run") },
      h("div", { class: "tp-live-rows" }, ...this.controls.map(({ element }) => element)),
      h("div", { class: "tp-live-buttons" }, this.reset, this.pin, this.clear, this.stop,
        this.button(text_of("save_page"), () => this.save_page())),
      this.runs, this.status,
      this.editor?.element,
      h("details", { class: "tp-live-check" }, h("summary", {}, text_of("show_command")),
        h("p", {}, text_of("same_run")), this.command));
    set_text(this.status, text_of("unpacking"));
    this.show_command();
    this.attach();
    void this.simulation.start();
  }

  private button(text: string, onclick: () => void): HTMLButtonElement {
    return h("button", { type: "button", class: "tp-live-button", disabled: true, onclick }, text);
  }

  private attach(): void {
    this.player.element.querySelector(".tp-main")!.append(this.element);
  }

  private enable(enabled: boolean): void {
    for (const control of this.controls) control.enable(enabled);
    this.editor?.enable(enabled);
    for (const button of this.element.querySelectorAll<HTMLButtonElement>(".tp-live-button")) button.disabled = !enabled;
  }

  private be_ready(): void {
    this.enable(true);
    this.element.dataset.live = "ready";
    if (this.running) return;
    set_text(this.status, "");
    const { saved } = this.options;
    if (!saved || this.element.dataset.saved) return;
    this.element.dataset.saved = "shown";
    for (const control of this.controls) if (control.key in saved.values) control.set(saved.values[control.key]);
    if (saved.text !== undefined) this.editor?.set(saved.text);
    this.run();
  }

  private give_up(reason: string): void {
    this.end();
    this.enable(false);
    this.element.dataset.live = "refused";
    set_text(this.status, `${reason} ${text_of("recorded_shown")}`);
  }

  /** Of the controls that the reader has moved. */
  private get moved(): string[] {
    return this.controls.flatMap((control, index) => {
      const value = control.value();
      return value === null || value === this.options.controls[index].value ? [] : [`${control.key}=${value}`];
    });
  }

  private get settings(): string[] {
    return [...this.options.settings, ...this.moved];
  }

  private get text(): string {
    return this.editor?.text ?? this.player.clip.sources[this.options.source].text;
  }

  private show_command(): void {
    const { name } = this.options;
    set_text(this.command, `${simulate_command(name, this.settings)}${this.editor?.edited ? `   # ${text_of("command_scene", { name })}` : ""}`);
  }

  private run(): void {
    this.show_command();
    this.start_time = performance.now();
    this.running = true;
    this.element.dataset.live = "running";
    this.simulation.run({ name: this.options.name, text: this.text, settings: this.settings });
  }

  private end(): void {
    this.running = false;
    this.stop.hidden = true;
    this.element.dataset.live = "ready";
  }

  private show_progress(share: number): void {
    const passed = performance.now() - this.start_time;
    if (passed < quiet_time) return;
    this.stop.hidden = false;
    const percent = Math.floor(100 * share);
    set_text(this.status, text_of(passed < time_limit ? "simulating" : "takes_long", { percent }));
  }

  private show_error(error: LiveError): void {
    this.end();
    this.editor?.show(error);
    // An open editor has the mistake below it.
    const below = this.editor?.open && error.line > 0;
    set_text(this.status, `${below ? text_of("mistake") : this.message_of(error)} ${text_of("before_shown")}`);
  }

  private message_of({ message, line }: LiveError): string {
    const text = message.replace(/^(?:[^\n]*?:\d+:\d+: )?error: /, "");
    return line > 0 ? text_of("line", { line, message: text }) : `${text}.`;
  }

  private show_clip(clip: Clip, whole: boolean, error: LiveError | null): void {
    const run = { ...clip.runs[0], label: this.label() };
    const { state } = this.player;
    if (looks_alike(state.clip.runs[0], run)) {
      const first = state.clip.runs.length === this.slot;
      this.shown.put(this.slot, run);
      if (first) {
        this.show_runs();
        state.set({ run: this.slot });
      }
      this.show_name(run.label);
    } else {
      this.mount({ ...clip, runs: [run] });
    }
    if (!whole) return;
    this.end();
    this.editor?.show(null);
    set_text(this.status, error ? `${this.message_of(error)} ${text_of("until_then")}` : "");
    this.element.dataset.runs = String(Number(this.element.dataset.runs ?? 0) + 1);
  }

  /** A scene of other bodies has a player of its own. */
  private mount(clip: Clip): void {
    this.clear_kept();
    this.player = remounted(this.player, (figure) => this.make(figure, clip));
    this.shown = new ShownRun(this.player);
    this.slot = 0;
    this.attach();
  }

  private label(): string {
    return this.moved.map(setting_words).join(", ") || text_of("as_recorded");
  }

  private go_back(): void {
    for (const [index, control] of this.controls.entries()) control.set(this.options.controls[index].value ?? null);
    this.editor?.set(null);
    this.show_command();
    if (!looks_alike(this.player.state.clip.runs[0], this.recorded)) return this.run();
    this.simulation.cancel();
    if (this.slot > 0) this.shown.drop(this.slot);
    else this.shown.put(0, { ...this.recorded, label: text_of("as_recorded") });
    this.show_runs();
    this.end();
    set_text(this.status, "");
  }

  /** The shown run stays, as a ghost and a second curve. */
  private keep(): void {
    const { state } = this.player;
    const current = state.run;
    this.shown.put(state.clip.runs.length, { ...current, label: text_of("kept", { label: current.label || text_of("as_recorded") }) });
    this.show_runs();
    state.set({ run: this.slot, compare: "ghost" });
  }

  private clear_kept(): void {
    if (this.player.state.clip.runs.length > this.slot + 1) this.shown.drop(this.slot + 1);
    this.show_runs();
  }

  private show_runs(): void {
    const { state, element } = this.player;
    const more = state.clip.runs.length > Math.max(this.slot, 1);
    const bar = more ? build_run_bar(state) : null;
    this.runs.replaceChildren(...(bar ? [bar] : []));
    // The player's own bar has the recorded runs alone.
    const own = element.querySelector<HTMLElement>(".tp-main > .tp-runs");
    if (own) own.hidden = more;
    this.clear.hidden = state.clip.runs.length <= this.slot + 1;
  }

  /** Of the live run, in the choice of runs. */
  private show_name(name: string): void {
    const place = this.runs.querySelectorAll(".tp-segments:first-child > .tp-segment, option")[this.slot];
    if (place) place.lastChild!.textContent = name;
  }

  private save_page(): void {
    const values: Record<string, string> = {};
    for (const control of this.controls) {
      const value = control.value();
      if (value !== null) values[control.key] = value;
    }
    const saved = { values, ...(this.editor?.edited ? { text: this.editor.text } : {}) };
    this.page.save(this.options.name.replace(/\.toml$/, "") + ".html", this.player.element.dataset.clip!, { ...this.options, saved });
  }
}
