// A page with a stage alone, for its tests and to look at: open_stage() shows one of the clips below.
import type { Clip } from "../src/data/clip.ts";
import { Stage } from "../src/stage/stage.ts";
import { make_synthetic_clip } from "./synthetic_clip.ts";
import { make_many } from "./synthetic_many.ts";

const clips = { synthetic: make_synthetic_clip, hundred: () => make_many(100), thousand: () => make_many(1000) };

declare global {
  var stage: Stage;
  var clip: Clip;
  var open_stage: (name: keyof typeof clips, theme: "light" | "dark") => void;
}

globalThis.open_stage = (name, theme) => {
  globalThis.stage?.dispose();
  document.body.style.background = theme === "dark" ? "#111418" : "#ffffff";
  globalThis.clip = clips[name]();
  globalThis.stage = new Stage(document.getElementById("host")!, globalThis.clip, theme);
};
document.documentElement.dataset.player = "ready";
