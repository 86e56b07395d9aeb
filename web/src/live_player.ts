// The entry of the player of live pages: as player.ts, with the simulation.
import { start_lesson } from "./lesson/lesson.ts";
import { start_live } from "./live/live.ts";
import { PristinePage } from "./live/save_page.ts";
import { read_embedded_clip } from "./ui/embedded_clip.ts";
import { mount_players } from "./ui/mount.ts";
import { fit_to_paper } from "./ui/paper.ts";
import { translate_shell } from "./texts/shell_texts.ts";

const page = new PristinePage();
translate_shell();
fit_to_paper();
void mount_players(read_embedded_clip).then((players) => {
  start_lesson(players);
  start_live(players, page);
});
