// The state of one player, which its parts read, set and watch; and the stage as the other parts see it.
import type { Clip, Impact, OverlayName, Run, Vec3 } from "../data/clip.ts";

export type Theme = "light" | "dark";
export type CompareMode = "single" | "ghost" | "side-by-side";

/** Lights the arrow of a symbol of the lessons: v_rel, n, r_a, r_b, omega, v, P, L, j, g. */
export interface SymbolHighlight {
  name: string;
  impact?: Impact;
  body?: number;
}

/** Implemented by the class of web/src/stage/stage.ts, whose constructor throws if there is no WebGL. */
export interface Stage {
  /** Sets the moment and draws on the next animation frame. `before`: velocities just before an impact at that time. */
  show(runs: number[], time: number, mode: CompareMode, before?: boolean): void;
  /** Draws at once. */
  draw(): void;
  set_overlays(names: Set<OverlayName>): void;
  highlight(symbol: SymbolHighlight | null): void;
  follow(body: number | null): void;
  select(body: number | null): void;
  on_pick(callback: (body: number | null) => void): void;
  /** The scene's camera, moving with the clip if it moves. */
  reset_view(): void;
  /** Radians about the target. */
  orbit(dx: number, dy: number): void;
  /** Below 1: nearer. */
  zoom(factor: number): void;
  /** Fractions of the height of the picture. */
  pan(dx: number, dy: number): void;
  set_theme(theme: Theme): void;
  resize(): void;
  pixels(): { width: number; height: number; data: Uint8Array };
  arrows(): Record<string, { from: Vec3; to: Vec3 }[]>;
  dispose(): void;
}

export interface PlayerValues {
  /** s. */
  time: number;
  playing: boolean;
  /** Seconds of the clip in a second. */
  speed: number;
  loop: boolean;
  /** Index of the chosen run. */
  run: number;
  compare: CompareMode;
  /** Index of the chosen body. */
  body: number | null;
  /** Whether the camera follows the chosen body. */
  follow: boolean;
  /** Index into the impacts of the chosen run. */
  impact: number | null;
  /** At an impact: velocities before it. */
  before: boolean;
  overlays: ReadonlySet<OverlayName>;
}

type Listener = (changed: ReadonlySet<keyof PlayerValues>) => void;

export const speeds = [0.25, 0.5, 1, 2, 4];
/** Times nearer than this are the same moment, s. */
export const same_time = 1e-9;

export class PlayerState {
  readonly clip: Clip;
  private values: PlayerValues;
  private listeners: { keys: (keyof PlayerValues)[]; call: Listener }[] = [];

  constructor(clip: Clip, start: Partial<PlayerValues> = {}) {
    this.clip = clip;
    const first = clip.runs[0];
    const moving = first.scene.bodies.findIndex((body) => body.type === "dynamic");
    this.values = {
      time: 0, playing: false, speed: 1, loop: false, run: 0, compare: "single",
      body: moving < 0 ? null : moving, follow: false, impact: null, before: false,
      overlays: new Set(first.overlays.show), ...start,
    };
    this.values.time = this.clamped(this.values.time);
  }

  get<K extends keyof PlayerValues>(key: K): PlayerValues[K] {
    return this.values[key];
  }

  /** Sets values and tells the listeners of those that changed, each once. */
  set(values: Partial<PlayerValues>): void {
    const next = { ...this.values, ...values };
    next.run = Math.min(Math.max(next.run, 0), this.clip.runs.length - 1);
    if (next.run !== this.values.run && values.impact === undefined) next.impact = null;
    const before = this.values;
    this.values = next;
    next.time = this.clamped(next.time);
    // A moment that is left has no "before" any more.
    if (next.time !== before.time && values.before === undefined) next.before = false;
    const changed = new Set((Object.keys(next) as (keyof PlayerValues)[]).filter((key) => next[key] !== before[key]));
    if (changed.size === 0) return;
    for (const { keys, call } of [...this.listeners]) if (keys.some((key) => changed.has(key))) call(changed);
  }

  /** Calls back after each change of one of the keys. Returns the end of watching. */
  on(keys: (keyof PlayerValues)[], call: Listener): () => void {
    const listener = { keys, call };
    this.listeners.push(listener);
    return () => { this.listeners = this.listeners.filter((other) => other !== listener); };
  }

  /** The chosen run. */
  get run(): Run {
    return this.clip.runs[this.values.run];
  }

  /** Indices of the runs on the stage; the chosen one first. */
  get runs_shown(): number[] {
    if (this.values.compare === "single") return [this.values.run];
    const others = this.clip.runs.map((_, index) => index).filter((index) => index !== this.values.run);
    return this.values.compare === "ghost" ? [this.values.run, ...others] : this.clip.runs.map((_, index) => index);
  }

  /** Of the longest run shown, s. */
  get duration(): number {
    return Math.max(...this.runs_shown.map((index) => this.clip.runs[index].duration));
  }

  /** The last frame at or before the time. */
  get frame(): number {
    return Math.floor(this.values.time * this.run.fps + 1e-6);
  }

  private clamped(time: number): number {
    return Math.min(Math.max(time, 0), this.duration);
  }
}
