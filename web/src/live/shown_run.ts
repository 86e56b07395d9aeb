// Puts a new run into a mounted player, in the place of the one that it shows. The player's parts follow the run that is
// chosen: they are told that it changed.
import type { Clip, Run } from "../data/clip.ts";
import type { Player } from "../ui/player.ts";
import { stage_pool } from "../ui/stage_pool.ts";

/** Whether everything that the player built from one run holds for the other: names, light and joints. */
export function looks_alike(a: Run, b: Run): boolean {
  const fixed_parts = (run: Run): string => JSON.stringify([
    run.scene.bodies.map(({ name, type }) => [name, type]), run.scene.light, run.scene.exposure, run.scene.tone,
    run.scene.environment?.background, [...run.joints.keys()], run.scene.meshes.length,
  ]);
  return fixed_parts(a) === fixed_parts(b);
}

export class ShownRun {
  private readonly recorded_camera: Pick<Run["scene"], "camera" | "camera_moves">;

  constructor(private readonly player: Player) {
    const { camera, camera_moves } = this.stage_clip.runs[0].scene;
    this.recorded_camera = { camera, camera_moves };
  }

  private get stage_clip(): Clip {
    return this.player.view["clip"];
  }

  /** The run at the index of the clip, or one more. */
  put(index: number, run: Run): void {
    const { state } = this.player;
    // A camera that fits the motion would jump at every step of a slider.
    const seen: Run = { ...run, scene: { ...run.scene, ...this.recorded_camera } };
    state.clip.runs[index] = seen;
    this.stage_clip.runs[index] = seen;
    this.forget(index);
    this.tell();
  }

  /** All runs from that index on. */
  drop(first: number): void {
    const { state } = this.player;
    for (let index = first; index < state.clip.runs.length; ++index) this.forget(index);
    state.clip.runs.length = first;
    this.stage_clip.runs.length = first;
    state.set({ run: Math.min(state.get("run"), first - 1), compare: "single" });
    this.tell();
  }

  private forget(index: number): void {
    const stage = this.player.view["stage"] as unknown as { run_views: Map<number, { dispose(): void }> } | null;
    stage?.run_views.get(index)?.dispose();
    stage?.run_views.delete(index);
  }

  private tell(): void {
    const { state } = this.player;
    const time = Math.min(state.get("time"), state.duration);
    if (time !== state.get("time")) state.set({ time });
    const changed = new Set(["run"] as const);
    for (const { keys, call } of [...state["listeners"]]) if (keys.includes("run")) call(changed);
    if (state.get("impact") !== null) state.set({ impact: null });
  }
}

/** The player with another clip: of an edited scene with other bodies. The figure is a new one. */
export function remounted(player: Player, make: (figure: HTMLElement) => Player): Player {
  const { element, state, view } = player;
  const fresh = element.cloneNode(false) as HTMLElement;
  const caption = element.querySelector("figcaption");
  fresh.append(...view.element.querySelector(".tp-fallback")!.childNodes);
  if (caption) fresh.append(caption);
  view.sleep();
  const views = stage_pool()["views"];
  views.splice(views.indexOf(view), 1);
  element.replaceWith(fresh);
  const made = make(fresh);
  made.state.set({ time: state.get("time"), speed: state.get("speed"), loop: state.get("loop"), overlays: state.get("overlays") });
  made.view.enter_pool();
  return made;
}
