// The players of a lesson, and the one that a part of the text speaks of.
import type { Impact } from "../data/clip.ts";
import type { Player } from "../ui/player.ts";
import { symbol_types } from "../../lesson/symbols.ts";
import type { Values } from "./evaluate.ts";
import { impact_values, moment_values } from "./symbol_values.ts";

export class LessonStages {
  constructor(private readonly players: Player[]) {}

  by_id(id: string): Player | undefined {
    return this.players.find((player) => player.element.id === id);
  }

  /** The last one before the element, else the first after it. */
  near(element: Element): Player | undefined {
    const named = element.closest<HTMLElement>("[data-stage]")?.dataset.stage;
    if (named) return this.by_id(named);
    let above: Player | undefined;
    for (const player of this.players) {
      const order = element.compareDocumentPosition(player.element);
      if (order & (Node.DOCUMENT_POSITION_PRECEDING | Node.DOCUMENT_POSITION_CONTAINS)) above = player;
    }
    return above ?? this.players[0];
  }
}

/** Index of the chosen impact, else of the one nearest to the shown time; null if there is none. */
export function impact_of(player: Player): number | null {
  const { state } = player;
  const { impacts } = state.run;
  const chosen = state.get("impact");
  if (chosen !== null && impacts[chosen]) return chosen;
  const distance = (impact: Impact): number => Math.abs(impact.time - state.get("time"));
  const nearest = impacts.reduce((best, impact, i) => (best < 0 || distance(impact) < distance(impacts[best]) ? i : best), -1);
  return nearest < 0 ? null : nearest;
}

/** Values that a symbol of that name belongs to, and the request that lights its arrow; null if there are none. */
export function meaning_of(player: Player, name: string): { values: Values; impact?: Impact; body?: number } | null {
  const { state } = player;
  if (symbol_types.now.has(name)) {
    const body = state.get("body");
    return body === null ? null : { values: moment_values(state.run, state.get("time"), body, state.get("before")), body };
  }
  const index = impact_of(player);
  return index === null ? null : { values: impact_values(state.run, index), impact: state.run.impacts[index] };
}
