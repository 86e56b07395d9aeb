// Finds the figures of the page, reads their clips and mounts the players.
import type { Clip } from "../data/clip.ts";
import { publish } from "./api.ts";
import { h } from "./dom.ts";
import { icon_button } from "./transport.ts";
import { read_options } from "./options.ts";
import { Player } from "./player.ts";
import { toggle_theme } from "./theme.ts";
import { in_language } from "../texts/language.ts";
import { text_of } from "../texts/texts.ts";

/** Reads the clip with this id from the page. */
export type ClipReader = (id: string) => Promise<Clip>;

export type PageStatus = "loading" | "ready" | "no-webgl" | "failed";

function set_status(status: PageStatus): void {
  document.documentElement.dataset.player = status;
}

function add_theme_button(): void {
  const place = document.querySelector<HTMLElement>("[data-tumble-theme]") ?? document.body;
  const button = in_language(icon_button("theme", text_of("theme"), "", toggle_theme));
  button.classList.add("tumble-theme");
  place.prepend(button);
}

function show_failure(figure: HTMLElement, error: unknown): void {
  const reason = error instanceof Error ? error.message : String(error);
  figure.prepend(in_language(h("p", { class: "tp-note", role: "alert" }, text_of("cannot_show", { reason }))));
}

export async function mount_players(read_clip: ClipReader): Promise<Player[]> {
  set_status("loading");
  add_theme_button();
  let no_webgl = false;
  let failed = false;
  const on_no_webgl = (): void => {
    no_webgl = true;
    if (document.documentElement.dataset.player === "ready") set_status("no-webgl");
  };
  const clips = new Map<string, Promise<Clip>>();
  const mounted = [...document.querySelectorAll<HTMLElement>("figure.tumble-player[data-clip]")].map(async (figure) => {
    const id = figure.dataset.clip!;
    if (!clips.has(id)) clips.set(id, read_clip(id));
    try {
      const player = new Player(figure, await clips.get(id)!, read_options(figure), on_no_webgl);
      return player;
    } catch (error) {
      failed = true;
      show_failure(figure, error);
      return null;
    }
  });
  const ready = Promise.all(mounted).then((players) => {
    const whole = players.filter((player): player is Player => player !== null);
    for (const player of whole) player.view.enter_pool();
    set_status(failed ? "failed" : no_webgl ? "no-webgl" : "ready");
    return whole;
  });
  publish(ready);
  return ready;
}
