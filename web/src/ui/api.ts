// `window.tumble`: the page for tests, lessons and the curious.
import type { BodyState, Impact, Quat, Vec3 } from "../data/clip.ts";
import type { SymbolHighlight } from "./player_state.ts";
import type { Player } from "./player.ts";

export interface PlayerApi {
  /** Id of the clip's data element. */
  readonly id: string;
  readonly element: HTMLElement;
  readonly player: Player;
  /** s. */
  readonly duration: number;
  readonly bodies: string[];
  /** Of the chosen run. */
  readonly impacts: Impact[];
  /** Labels. */
  readonly runs: string[];
  readonly time: number;
  readonly frame: number;
  seek(time: number): void;
  select_run(index: number): void;
  /** Of the center of mass, as shown at the shown time. */
  pose(name: string): { position: Vec3; rotation: Quat };
  state(name: string): BodyState;
  /** Draws and reads the picture; null without WebGL. */
  pixels(): { width: number; height: number; data: Uint8Array } | null;
  /** Time at which the first plot's line stands; null if none is open. */
  cursor(): number | null;
  arrows(): Record<string, { from: Vec3; to: Vec3 }[]>;
  highlight(symbol: SymbolHighlight | null): void;
}

export interface TumbleApi extends PlayerApi {
  readonly ready: Promise<void>;
  readonly players: PlayerApi[];
}

declare global {
  interface Window { tumble: TumbleApi }
}

function api_of(player: Player): PlayerApi {
  const { state, view, element } = player;
  const body_index = (name: string): number => {
    const index = state.run.scene.bodies.findIndex((body) => body.name === name);
    if (index < 0) throw new Error(`no body "${name}"`);
    return index;
  };
  const body_state = (name: string): BodyState => (state.get("before") ?
    state.run.motion.state_before(body_index(name), state.get("time")) : state.run.motion.state(body_index(name), state.get("time")));
  return {
    id: element.dataset.clip ?? "",
    element,
    player,
    get duration() { return state.run.duration; },
    get bodies() { return state.run.scene.bodies.map((body) => body.name); },
    get impacts() { return state.run.impacts; },
    get runs() { return state.clip.runs.map((run) => run.label); },
    get time() { return state.get("time"); },
    get frame() { return state.frame; },
    seek: (time) => player.actions.seek(time),
    select_run: (run) => state.set({ run }),
    pose: (name) => {
      const pose = { position: [0, 0, 0] as Vec3, origin: [0, 0, 0] as Vec3, rotation: [1, 0, 0, 0] as Quat };
      state.run.motion.pose(body_index(name), state.get("time"), pose);
      return { position: pose.position, rotation: pose.rotation };
    },
    state: body_state,
    pixels: () => {
      const stage = view.awake;
      stage?.draw();
      return stage?.pixels() ?? null;
    },
    cursor: () => player.plots.cursor(),
    arrows: () => view.awake?.arrows() ?? {},
    highlight: (symbol) => view.highlight(symbol),
  };
}

/** Before the clips are read only `ready` and `players` are there. The page's own members are those of its first player. */
export function publish(mounted: Promise<Player[]>): void {
  const players: PlayerApi[] = [];
  const page = { players } as unknown as TumbleApi;
  const ready = mounted.then((list) => {
    players.push(...list.map(api_of));
    // Getters stay getters.
    if (players[0]) Object.defineProperties(page, Object.getOwnPropertyDescriptors(players[0]));
  });
  Object.defineProperty(page, "ready", { value: ready, enumerable: true });
  window.tumble = page;
}
