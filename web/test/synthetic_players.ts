// Runs in a page: players of the clip by closed forms.
import { mount_players } from "../src/ui/mount.ts";
import { make_synthetic_clip } from "./synthetic_clip.ts";

void mount_players(async () => make_synthetic_clip());
