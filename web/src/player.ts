// The entry of the player: finds the clips of the page and mounts a player on each.
import { start_lesson } from "./lesson/lesson.ts";
import { read_embedded_clip } from "./ui/embedded_clip.ts";
import { mount_players } from "./ui/mount.ts";
import { fit_to_paper } from "./ui/paper.ts";
import { translate_shell } from "./texts/shell_texts.ts";

translate_shell();
fit_to_paper();
void mount_players(read_embedded_clip).then(start_lesson);
