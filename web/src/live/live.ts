// Makes the players of a page live, where their figures say so.
import { Player } from "../ui/player.ts";
import { LivePanel } from "./live_panel.ts";
import { read_live_options } from "./options.ts";
import type { PristinePage } from "./save_page.ts";

export function start_live(players: Player[], page: PristinePage): void {
  for (const player of players) {
    const options = read_live_options(player.element);
    if (!options) continue;
    new LivePanel(player, options, (figure, clip) => new Player(figure, clip, player.options, () => {}), page);
  }
}
