// The panel of impacts: the list and the chosen one.
import type { Actions } from "../ui/actions.ts";
import { h, set_text } from "../ui/dom.ts";
import { trimmed_text } from "../ui/format.ts";
import type { PlayerState } from "../ui/player_state.ts";
import { ImpactCard } from "./impact_card.ts";
import { ImpactList } from "./impact_list.ts";
import { text_of } from "../texts/texts.ts";

export function build_impacts(state: PlayerState, actions: Actions, heading: "h3" | "h4"): HTMLElement {
  const summary = h("p", { class: "tp-facts" });
  const list = new ImpactList(state, actions);
  const card = new ImpactCard(state, heading);
  const show = (): void => {
    const run = state.run;
    const total = run.impacts.reduce((sum, impact) => sum + impact.impulse, 0);
    const kept = run.impacts.length < run.all_impacts ? text_of("impacts_strongest", { kept: run.impacts.length, all: run.all_impacts }) :
      text_of("impacts_counted", { count: run.impacts.length });
    const own = run.impacts.filter((impact) => impact.exact).length;
    const times = own === run.impacts.length ? text_of("own_times") :
      own === 0 ? text_of("step_times") : text_of("some_own_times", { own });
    set_text(summary, run.impacts.length === 0 ? text_of("no_impacts") :
      text_of("impacts_summary", { kept, times, total: trimmed_text(total, 4) }));
    list.element.hidden = card.element.hidden = run.impacts.length === 0;
  };
  state.on(["run"], show);
  show();
  return h("div", { class: "tp-impacts" }, summary, list.element, card.element);
}
