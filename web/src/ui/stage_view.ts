// The place of a stage: makes it when it comes into view, and keeps it at the player's state. Without WebGL the fallback
// film stays and follows the time.
import { Stage as WebglStage } from "../stage/stage.ts";
import type { Clip } from "../data/clip.ts";
import { h } from "./dom.ts";
import type { PlayerState, Stage, SymbolHighlight } from "./player_state.ts";
import { stage_pool, type PooledView } from "./stage_pool.ts";
import { on_theme, theme } from "./theme.ts";
import { text_of } from "../texts/texts.ts";

export class StageView implements PooledView {
  readonly host = h("div", { class: "tp-stage-host" });
  readonly note = h("p", { class: "tp-note", hidden: true },
    text_of("no_webgl"));
  readonly element: HTMLElement;
  /** Whether a stage could not be made. */
  failed = false;
  private stage: Stage | null = null;
  private film: HTMLVideoElement | null;
  /** The body chosen at first has no outline: the picture is the scene's own. */
  private marked = false;
  private highlighted: SymbolHighlight | null = null;

  /** `clip`: the state's, or a copy with another camera. */
  constructor(private readonly state: PlayerState, private readonly clip: Clip, fallback: Node[], label: string, private readonly on_failure: () => void) {
    this.element = h("div", { class: "tp-stage", tabindex: 0, role: "application", "aria-label": label, "aria-roledescription": text_of("stage") },
      h("div", { class: "tp-fallback" }, ...fallback), this.host, this.note);
    this.film = this.element.querySelector("video");
    state.on(["time", "run", "compare", "before"], () => this.show());
    state.on(["overlays"], () => this.stage?.set_overlays(new Set(state.get("overlays"))));
    state.on(["body", "follow"], (changed) => {
      this.marked ||= changed.has("body");
      this.choose();
    });
    on_theme(() => this.stage?.set_theme(theme()));
    // The printed page has the last picture, and no animation frame comes before it.
    addEventListener("beforeprint", () => this.stage?.draw());
    new ResizeObserver(() => this.stage?.resize()).observe(this.host);
  }

  /** From then on the stage lives while it is near the part of the page in view. */
  enter_pool(): void {
    stage_pool().add(this);
  }

  get live(): boolean {
    return this.stage !== null;
  }

  /** The stage, made if it sleeps; null without WebGL. */
  get awake(): Stage | null {
    if (!this.stage) stage_pool().wake(this);
    return this.stage;
  }

  wake(): void {
    if (this.stage || this.failed) return;
    try {
      this.stage = new WebglStage(this.host, this.clip, theme());
    } catch {
      this.failed = true;
      this.note.hidden = false;
      this.element.dataset.stage = "none";
      this.on_failure();
      this.show();
      return;
    }
    const stage: Stage = this.stage;
    this.element.dataset.stage = "live";
    // The tables keep their body when the ground behind it is clicked.
    stage.on_pick((body) => {
      if (body === null) return;
      this.marked = true;
      this.state.set({ body });
      this.choose();
    });
    stage.set_overlays(new Set(this.state.get("overlays")));
    this.choose();
    if (this.highlighted) stage.highlight(this.highlighted);
    this.show();
  }

  sleep(): void {
    this.stage?.dispose();
    this.stage = null;
    this.host.replaceChildren();
    delete this.element.dataset.stage;
  }

  highlight(symbol: SymbolHighlight | null): void {
    this.highlighted = symbol;
    this.stage?.highlight(symbol);
  }

  private show(): void {
    const state = this.state;
    this.stage?.show(state.runs_shown, state.get("time"), state.get("compare"), state.get("before"));
    if (this.failed && this.film && this.film.readyState > 0) this.film.currentTime = state.get("time");
  }

  private choose(): void {
    this.stage?.select(this.marked ? this.state.get("body") : null);
    this.stage?.follow(this.state.get("follow") ? this.state.get("body") : null);
  }
}
