// The overlays of one run, as objects to draw.
import * as THREE from "three";
import type { OverlayName, Run } from "../data/clip.ts";
import { BodySet } from "./body_set.ts";
import type { Geometries } from "./geometries.ts";
import type { Materials } from "./materials.ts";
import { OverlayBuilder } from "./overlay_builder.ts";
import { empty_frame, type OverlayArrow, type OverlayFrame, type OverlayMarker } from "./overlay_frame.ts";
import { style } from "./overlay_style.ts";
import type { SceneSize } from "./scene_size.ts";
import { marker_forms } from "./screen_glsl.ts";
import { ScreenShapes, type ScreenUniforms } from "./screen_shapes.ts";
import { draw_symbol, type SymbolRequest } from "./symbols.ts";
import { add_trails, started } from "./trails.ts";

/** Opacity of all other overlays while a symbol is lit. */
const dimmed = 0.3;

export class OverlayView {
  readonly group = new THREE.Group();
  frame: OverlayFrame = empty_frame();
  lit: OverlayFrame | null = null;
  private readonly builder: OverlayBuilder;
  private readonly trails: ScreenShapes;
  private readonly lines: ScreenShapes;
  private readonly arrows: ScreenShapes;
  private readonly markers: ScreenShapes;
  private readonly lit_arrows: ScreenShapes;
  private readonly lit_markers: ScreenShapes;
  private readonly ghosts: BodySet;
  private trail_times: Float64Array | null = null;

  constructor(
    private readonly run: Run,
    private readonly size: SceneSize,
    geometries: Geometries,
    materials: Materials,
    uniforms: ScreenUniforms,
  ) {
    this.builder = new OverlayBuilder(run, size);
    this.trails = new ScreenShapes("trail", uniforms, 0);
    this.lines = new ScreenShapes("line", uniforms, 1);
    this.arrows = new ScreenShapes("arrow", uniforms, 2);
    this.markers = new ScreenShapes("marker", uniforms, 3);
    this.lit_arrows = new ScreenShapes("arrow", uniforms, 4);
    this.lit_markers = new ScreenShapes("marker", uniforms, 5);
    this.ghosts = new BodySet(run.scene, geometries, materials.ghost, (mesh) => (mesh.renderOrder = 5));
    for (const shapes of this.shapes) this.group.add(shapes.group);
    this.group.add(this.ghosts.group);
  }

  update(time: number, before: boolean, overlays: Set<OverlayName>, symbol: SymbolRequest | null): void {
    this.frame = this.builder.build(time, before, overlays);
    this.lit = symbol && draw_symbol(this.run, this.size, time, symbol);
    if (overlays.has("trails")) {
      this.trail_times ??= add_trails(this.run, this.size.viewing_distance, this.trails);
      this.trails.limit(started(this.trail_times, time));
    } else this.trails.limit(0);
    for (const shapes of [this.lines, this.arrows, this.markers, this.lit_arrows, this.lit_markers]) shapes.begin();
    for (const line of this.frame.lines)
      for (let i = 0; i + 1 < line.points.length; ++i)
        this.lines.add({
          from: line.points[i], from_w: line.width, to: line.points[i + 1], to_w: 0, color: line.color, opacity: line.opacity,
          allowance: line.allowance, form: 0,
        });
    for (const arrow of this.frame.arrows) add_arrow(arrow, this.arrows);
    for (const marker of this.frame.markers) add_marker(marker, this.markers);
    for (const arrow of this.lit?.arrows ?? []) add_arrow(arrow, this.lit_arrows);
    for (const marker of this.lit?.markers ?? []) add_marker(marker, this.lit_markers);
    for (const shapes of [this.lines, this.arrows, this.markers, this.lit_arrows, this.lit_markers]) shapes.end();
    for (const shapes of [this.trails, this.lines, this.arrows, this.markers]) shapes.set_opacity(this.lit ? dimmed : 1);
    this.ghosts.begin();
    for (const ghost of this.frame.ghosts) this.ghosts.add(ghost.body, ghost.origin, ghost.rotation, undefined, style.ghost_opacity);
    this.ghosts.end();
  }

  get trail_time(): number {
    return this.run.overlays.trail_time;
  }

  dispose(): void {
    for (const shapes of this.shapes) shapes.dispose();
    this.ghosts.dispose();
  }

  private get shapes(): ScreenShapes[] {
    return [this.trails, this.lines, this.arrows, this.markers, this.lit_arrows, this.lit_markers];
  }
}

function add_arrow(arrow: OverlayArrow, to: ScreenShapes): void {
  to.add({
    from: arrow.from, from_w: arrow.width, to: arrow.to, to_w: arrow.double_head ? 2 : 1, color: arrow.color,
    opacity: arrow.opacity, allowance: arrow.allowance, form: 0,
  });
}

function add_marker(marker: OverlayMarker, to: ScreenShapes): void {
  to.add({
    from: marker.at, from_w: marker.radius, to: marker.at, to_w: 0, color: marker.color, opacity: 1,
    allowance: marker.allowance, form: marker_forms.indexOf(marker.form),
  });
}
