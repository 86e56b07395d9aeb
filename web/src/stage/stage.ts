// The stage: draws the moment of a clip that it is told, and nothing while nothing changes.
import * as THREE from "three";
import type { Clip, OverlayName, Vec3 } from "../data/clip.ts";
import { CameraRig } from "./camera_rig.ts";
import { Labels } from "./labels.ts";
import { Materials } from "./materials.ts";
import type { Moment } from "./moment.ts";
import { style } from "./overlay_style.ts";
import { pick } from "./pick.ts";
import { listen } from "./pointer.ts";
import { RunView } from "./run_view.ts";
import { ScreenUniforms } from "./screen_shapes.ts";
import type { SymbolRequest } from "./symbols.ts";
import { add_run_titles, type RunRectangle, type StageMode } from "./run_titles.ts";
import type { Theme } from "./theme.ts";
import { draws_in_software } from "./software.ts";
import { tile } from "./tiles.ts";

/** Pixels of the picture for a pixel of the page, at most: more is not seen, and costs. */
const most_pixel_ratio = 2;
/** Of a stage that is not laid out, CSS pixels. */
const hidden_size = { width: 640, height: 360 };

export class Stage {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly materials: Materials;
  private readonly uniforms = new ScreenUniforms();
  private readonly rig = new CameraRig();
  private readonly labels: Labels;
  private readonly run_views = new Map<number, RunView>();
  private readonly stop_listening: () => void;
  private readonly observer: ResizeObserver;
  private runs: number[] = [0];
  private mode: StageMode = "single";
  private readonly moment: Moment = { time: 0, before: false, shown: new Set(), symbol: null, selected: null };
  private views: RunRectangle[] = [];
  private width = 0;
  private height = 0;
  private pending = 0;
  private changed = true;
  private lost = false;
  private readonly most_ratio: number;
  private theme: Theme;
  private picked: (body: number | null) => void = () => {};

  /** Throws where there is no WebGL. */
  constructor(
    private readonly host: HTMLElement,
    private readonly clip: Clip,
    theme: Theme,
  ) {
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: false, powerPreference: "low-power" });
    this.renderer.autoClear = false;
    this.materials = new Materials(clip.runs[0].scene, clip.runs.some(({ scene }) => scene.light.color !== undefined));
    this.most_ratio = draws_in_software(this.renderer.getContext()) ? 1 : most_pixel_ratio;
    const canvas = this.canvas;
    Object.assign(canvas.style, { display: "block", width: "100%", height: "100%" });
    canvas.setAttribute("aria-hidden", "true");
    if (getComputedStyle(host).position === "static") host.style.position = "relative";
    host.append(canvas);
    this.labels = new Labels(host, theme);
    this.theme = theme;
    this.set_theme(theme);
    this.stop_listening = listen(host, canvas, {
      orbit: (dx, dy) => this.orbit(dx, dy),
      pan: (dx, dy) => this.pan(dx, dy),
      zoom: (factor) => this.zoom(factor),
      pick: (x, y) => this.picked(this.body_at(x, y)),
    });
    canvas.addEventListener("webglcontextlost", this.on_lost);
    canvas.addEventListener("webglcontextrestored", this.on_restored);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(host);
    this.resize();
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  /** `before`: velocities just before an impact at that time. */
  show(runs: number[], time: number, mode: StageMode, before = false): void {
    this.runs = runs.length > 0 ? runs : [0];
    this.mode = mode;
    this.moment.time = time;
    this.moment.before = before;
    this.change();
  }

  /** At once. */
  draw(): void {
    cancelAnimationFrame(this.pending);
    this.pending = 0;
    if (this.lost) return;
    if (this.width === 0) this.set_size(hidden_size.width, hidden_size.height);
    const { renderer, moment } = this;
    this.lay_out();
    const seen = this.views.map((view) => this.run_view(view.run));
    if (this.changed) {
      const others = this.mode === "ghost" ? this.runs.slice(1).map((index) => ({ index, run: this.clip.runs[index] })) : [];
      seen.forEach((run_view, i) => run_view.update(moment, i === 0 ? others : []));
      this.changed = false;
    }
    for (const run_view of seen) run_view.draw_shadows(renderer, moment.time);
    renderer.setScissorTest(false);
    renderer.setViewport(0, 0, this.width, this.height);
    renderer.clear();
    renderer.setScissorTest(this.views.length > 1);
    this.labels.begin();
    this.views.forEach((view, i) => this.draw_view(view, seen[i]));
    add_run_titles(this.labels, this.clip, this.runs, this.views, this.mode, this.theme);
    this.labels.end();
  }

  set_overlays(names: Set<OverlayName>): void {
    this.moment.shown = names;
    this.change();
  }

  /** Lights the arrow of a symbol of a lesson, and dims all others; null: none. */
  highlight(symbol: SymbolRequest | null): void {
    this.moment.symbol = symbol;
    this.change();
  }

  follow(body: number | null): void {
    this.rig.follow(body, this.first_run, this.moment.time);
    this.request();
  }

  select(body: number | null): void {
    this.moment.selected = body;
    this.change();
  }

  on_pick(callback: (body: number | null) => void): void {
    this.picked = callback;
  }

  /** The scene's camera, or the view that was set; a body is not followed any more. */
  reset_view(): void {
    this.rig.reset();
    this.request();
  }

  /** Radians about the target. */
  orbit(dx: number, dy: number): void {
    this.rig.orbit(dx, dy, this.first_run, this.moment.time);
    this.request();
  }

  /** Factor of the distance; below 1: nearer. */
  zoom(factor: number): void {
    this.rig.zoom(factor, this.first_run, this.moment.time);
    this.request();
  }

  /** Fractions of the height of the picture. */
  pan(dx: number, dy: number): void {
    this.rig.pan(dx, dy, this.first_run, this.moment.time);
    this.request();
  }

  set_theme(theme: Theme): void {
    this.theme = theme;
    this.materials.set_theme(theme);
    this.labels.set_theme(theme);
    this.request();
  }

  resize(): void {
    const { clientWidth, clientHeight } = this.host;
    const { ratio } = this;
    if (clientWidth === 0 || clientHeight === 0) return;
    if (clientWidth === this.width && clientHeight === this.height && ratio === this.renderer.getPixelRatio()) return;
    this.set_size(clientWidth, clientHeight);
    // A canvas of a new size is empty: without a picture now, it flickers.
    this.draw();
  }

  /** Draws, and reads the picture: bytes of red, green, blue and alpha, from the top left corner. */
  pixels(): { width: number; height: number; data: Uint8Array } {
    this.draw();
    const gl = this.renderer.getContext();
    const { drawingBufferWidth: width, drawingBufferHeight: height } = gl;
    const rows = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, rows);
    const data = new Uint8Array(rows.length);
    for (let y = 0; y < height; ++y)
      data.set(rows.subarray(4 * width * (height - 1 - y), 4 * width * (height - y)), 4 * width * y);
    return { width, height, data };
  }

  /** By overlay: the arrows that are drawn of the first run shown, and markers as arrows of no length. */
  arrows(): Record<string, { from: Vec3; to: Vec3 }[]> {
    if (this.changed) this.draw();
    const drawn: Record<string, { from: Vec3; to: Vec3 }[]> = {};
    const { frame, lit } = this.run_view(this.runs[0]).overlays;
    for (const part of [frame, lit]) {
      for (const { overlay, from, to } of part?.arrows ?? []) (drawn[overlay] ??= []).push({ from: [...from], to: [...to] });
      for (const { overlay, at } of part?.markers ?? []) (drawn[overlay] ??= []).push({ from: [...at], to: [...at] });
    }
    return drawn;
  }

  dispose(): void {
    cancelAnimationFrame(this.pending);
    this.observer.disconnect();
    this.stop_listening();
    this.canvas.removeEventListener("webglcontextlost", this.on_lost);
    this.canvas.removeEventListener("webglcontextrestored", this.on_restored);
    for (const run_view of this.run_views.values()) run_view.dispose();
    this.materials.dispose();
    this.labels.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
    this.canvas.remove();
  }

  private get ratio(): number {
    return Math.min(globalThis.devicePixelRatio || 1, this.most_ratio);
  }

  private get first_run() {
    return this.clip.runs[this.runs[0]];
  }

  private run_view(index: number): RunView {
    let view = this.run_views.get(index);
    if (!view) {
      view = new RunView(this.clip.runs[index], this.materials, this.uniforms);
      this.run_views.set(index, view);
      this.changed = true;
    }
    return view;
  }

  private set_size(width: number, height: number): void {
    this.width = width;
    this.height = height;
    this.renderer.setPixelRatio(this.ratio);
    this.renderer.setSize(width, height, false);
  }

  private change(): void {
    this.changed = true;
    this.request();
  }

  private request(): void {
    if (this.pending === 0) this.pending = requestAnimationFrame(() => this.draw());
  }

  private lay_out(): void {
    const runs = this.mode === "side-by-side" ? this.runs : this.runs.slice(0, 1);
    this.views = tile(runs.length, this.width, this.height).map((rectangle, i) => ({ ...rectangle, run: runs[i] }));
  }

  private draw_view(view: RunRectangle, run_view: RunView): void {
    const { renderer, moment } = this;
    const { left, top, width, height } = view;
    const ratio = renderer.getPixelRatio();
    const bottom = this.height - top - height;
    renderer.setViewport(left, bottom, width, height);
    renderer.setScissor(left, bottom, width, height);
    run_view.place_camera(this.rig.view(run_view.run, moment.time), width / height, moment.time);
    const unit = ratio * Math.max(this.height / style.unit_height, style.least_unit);
    run_view.draw(renderer, moment.time, { width: width * ratio, height: height * ratio, unit });
    for (const label of run_view.overlays.frame.labels) this.labels.add(label, run_view.camera, view);
    for (const label of run_view.overlays.lit?.labels ?? []) this.labels.add(label, run_view.camera, view);
  }

  private body_at(x: number, y: number): number | null {
    const view = this.views.find(
      ({ left, top, width, height }) => x >= left && x < left + width && y >= top && y < top + height,
    );
    if (!view) return null;
    const { camera, run } = this.run_view(view.run);
    const at = new THREE.Vector3((2 * (x - view.left)) / view.width - 1, 1 - (2 * (y - view.top)) / view.height, 0.5);
    const way = at.unproject(camera).sub(camera.position).normalize();
    return pick(run, this.moment.time, { from: camera.position.toArray() as Vec3, way: way.toArray() as Vec3 });
  }

  private readonly on_lost = (event: Event): void => {
    // Without this the browser does not give the context back.
    event.preventDefault();
    this.lost = true;
  };

  private readonly on_restored = (): void => {
    this.lost = false;
    for (const run_view of this.run_views.values()) run_view.forget();
    this.changed = true;
    this.draw();
  };
}
