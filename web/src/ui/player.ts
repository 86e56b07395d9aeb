// One player: the stage, its controls and its panels, in a figure of the page.
import type { Clip, Vec3 } from "../data/clip.ts";
import { build_panels } from "../panels/panels.ts";
import type { Plots } from "../panels/plots.ts";
import { Actions } from "./actions.ts";
import { run_clock } from "./clock.ts";
import { h } from "./dom.ts";
import { build_help } from "./help_dialog.ts";
import { listen_to_keys } from "./keyboard.ts";
import { Announcer } from "./live_region.ts";
import type { PlayerOptions } from "./options.ts";
import { build_overlay_chips } from "./overlay_chips.ts";
import { PlayerState, type PlayerValues } from "./player_state.ts";
import { StageView } from "./stage_view.ts";
import { build_run_bar, build_view_buttons } from "./toolbar.ts";
import { build_transport } from "./transport.ts";
import { in_language } from "../texts/language.ts";
import { text_of } from "../texts/texts.ts";

function initial_values(clip: Clip, options: PlayerOptions): Partial<PlayerValues> {
  const values: Partial<PlayerValues> = {};
  const index_of = (name: string): number => clip.runs[0].scene.bodies.findIndex((body) => body.name === name);
  if (options.time !== undefined) values.time = options.time;
  if (options.run !== undefined) values.run = options.run;
  if (options.compare !== undefined && clip.runs.length > 1) values.compare = options.compare;
  if (options.overlay) values.overlays = new Set(options.overlay);
  if (options.body !== undefined && index_of(options.body) >= 0) values.body = index_of(options.body);
  if (options.follow !== undefined && index_of(options.follow) >= 0) {
    values.body = index_of(options.follow);
    values.follow = true;
  }
  return values;
}

/** The clip with a still camera instead of the scene's. */
function seen_from(clip: Clip, view: { eye: Vec3; target: Vec3 }): Clip {
  const runs = clip.runs.map((run) => {
    const camera = { ...run.scene.camera(0), up: [0, 1, 0] as Vec3, ...view };
    return { ...run, scene: { ...run.scene, camera_moves: false, camera: () => camera } };
  });
  return { ...clip, runs };
}

export class Player {
  readonly state: PlayerState;
  readonly actions: Actions;
  readonly view: StageView;
  readonly plots: Plots;
  readonly announcer = new Announcer();

  constructor(readonly element: HTMLElement, readonly clip: Clip, readonly options: PlayerOptions, on_no_webgl: () => void) {
    this.state = new PlayerState(clip, initial_values(clip, options));
    this.actions = new Actions(this.state, this.announcer);
    const caption = element.querySelector<HTMLElement>(":scope > figcaption");
    const fallback = [...element.childNodes].filter((node) => node !== caption);
    const label = options.alt ? `${clip.title}: ${options.alt}` : clip.title || text_of("clip");
    this.view = new StageView(this.state, options.view ? seen_from(clip, options.view) : clip, fallback,
      text_of("stage_label", { label }), on_no_webgl);

    const help = build_help();
    const main = h("div", { class: "tp-main" });
    const full_screen = (): void => {
      if (document.fullscreenElement) void document.exitFullscreen();
      else void main.requestFullscreen();
    };
    const overlays = build_overlay_chips(this.state);
    const panels = build_panels(this);
    this.plots = panels.plots;
    main.append(
      h("div", { class: "tp-frame-box" }, this.view.element, build_view_buttons(this.state, this.view, full_screen)),
      build_transport(this.state, this.actions, help.show),
      ...[build_run_bar(this.state)].filter((bar): bar is HTMLElement => bar !== null),
      overlays);
    if (caption) {
      main.append(caption);
      caption.lang = document.documentElement.lang;
    }
    in_language(element);
    element.replaceChildren(h("div", { class: "tp-body" }, main, panels.element), this.announcer.element, help.element);
    element.classList.add(options.layout === "lesson" ? "tp-lesson" : "tp-page");
    element.dataset.mounted = "";

    listen_to_keys(element, {
      state: this.state, actions: this.actions, view: this.view, full_screen, show_help: help.show,
      focus: (part) => {
        const root = part === "overlays" ? overlays : panels.element;
        root.querySelector<HTMLElement>("summary, button, select, [tabindex='0']")?.focus();
      },
    });
    // A click on the stage gives the player the keyboard.
    this.view.element.addEventListener("pointerdown", () => this.view.element.focus({ preventScroll: true }));
    run_clock(this.state);
  }
}
