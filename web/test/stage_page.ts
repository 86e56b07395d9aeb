// A page with a stage alone, for its tests and to look at: the clip of the synthetic scene, or one that a test puts there.
import type { Clip } from "../src/data/clip.ts";
import { Stage } from "../src/stage/stage.ts";
import { make_synthetic_clip } from "./synthetic_clip.ts";
import { make_many } from "./synthetic_many.ts";

const clips: Record<string, () => Clip> = {
  synthetic: make_synthetic_clip,
  "100": () => make_many(100),
  "1000": () => make_many(1000),
};

declare global {
  var stage: Stage;
  var clip: Clip;
  var open_stage: (name: string, theme: "light" | "dark") => void;
}

globalThis.open_stage = (name, theme) => {
  globalThis.stage?.dispose();
  document.body.style.background = theme === "dark" ? "#111418" : "#ffffff";
  globalThis.clip = clips[name]();
  globalThis.stage = new Stage(document.getElementById("host")!, globalThis.clip, theme);
};
