// The panels beside or below the stage, each a section that opens and closes.
import { h } from "../ui/dom.ts";
import { panel_names, type PanelName } from "../ui/options.ts";
import type { Player } from "../ui/player.ts";
import { build_about } from "./about.ts";
import { build_impacts } from "./impacts.ts";
import { Plots } from "./plots.ts";
import { build_source } from "./source.ts";
import { StateTable } from "./state_table.ts";
import { text_of } from "../texts/texts.ts";

export interface Panels {
  element: HTMLElement;
  plots: Plots;
}

export function build_panels(player: Pick<Player, "clip" | "state" | "actions" | "options">): Panels {
  const { clip, state, actions, options } = player;
  const plots = new Plots(state, actions, options.plot);
  const lesson = options.layout === "lesson";
  const wanted: readonly PanelName[] = options.panels ?? (lesson ? (options.plot ? ["plots"] : []) : panel_names);
  const has_impacts = clip.runs.some((run) => run.impacts.length > 0);
  const content: Record<PanelName, () => HTMLElement> = {
    plots: () => plots.element,
    state: () => new StateTable(state).element,
    impacts: () => build_impacts(state, actions, lesson ? "h4" : "h3"),
    source: () => build_source(clip),
    about: () => build_about(state),
  };
  const counts: Partial<Record<PanelName, string>> = { impacts: has_impacts ? String(state.run.impacts.length) : "" };
  const sections = panel_names
    .filter((name) => wanted.includes(name) && (name !== "impacts" || has_impacts) && (name !== "source" || clip.sources.length > 0))
    .map((name, index) => {
      const count = h("span", { class: "tp-count" }, counts[name]);
      if (name === "impacts") state.on(["run"], () => { count.textContent = String(state.run.impacts.length); });
      // Sources and facts are for later; in lessons only the first panel is open.
      const open = lesson ? index === 0 : name !== "source" && name !== "about";
      return h("details", { class: `tp-panel tp-panel-${name}`, open }, h("summary", {}, h(lesson ? "h3" : "h2", { class: "tp-title" }, text_of(`panel_${name}`), count)), content[name]());
    });
  return { element: h("div", { class: "tp-panels", hidden: sections.length === 0 }, ...sections), plots };
}
