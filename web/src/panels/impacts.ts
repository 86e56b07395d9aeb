// The panel of impacts: the list and the chosen one.
import type { Actions } from "../ui/actions.ts";
import { h, set_text } from "../ui/dom.ts";
import { count_text, trimmed_text } from "../ui/format.ts";
import type { PlayerState } from "../ui/player_state.ts";
import { ImpactCard } from "./impact_card.ts";
import { ImpactList } from "./impact_list.ts";

export function build_impacts(state: PlayerState, actions: Actions, heading: "h3" | "h4"): HTMLElement {
  const summary = h("p", { class: "tp-facts" });
  const list = new ImpactList(state, actions);
  const card = new ImpactCard(state, heading);
  const show = (): void => {
    const run = state.run;
    const total = run.impacts.reduce((sum, impact) => sum + impact.impulse, 0);
    const kept = run.impacts.length < run.all_impacts ? `The ${run.impacts.length} strongest of ${run.all_impacts} impacts` :
      count_text(run.impacts.length, "impact");
    const own = run.impacts.filter((impact) => impact.exact).length;
    const times = own === run.impacts.length ? "each at its own time" :
      own === 0 ? "at the times of the steps" : `${own} at their own times, the others at the times of the steps`;
    set_text(summary, run.impacts.length === 0 ? "No impacts in this run." :
      `${kept}, ${times}; ` +
      `impulses of ${trimmed_text(total, 4)} N s in all.`);
    list.element.hidden = card.element.hidden = run.impacts.length === 0;
  };
  state.on(["run"], show);
  show();
  return h("div", { class: "tp-impacts" }, summary, list.element, card.element);
}
