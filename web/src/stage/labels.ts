// Names and symbols over the picture, as text of the page. Screen readers get the same from the panels.
import * as THREE from "three";
import type { OverlayLabel } from "./overlay_frame.ts";
import { theme_of, type Theme } from "./theme.ts";

export interface ViewRectangle {
  /** CSS pixels, from the left and the top of the stage. */
  left: number;
  top: number;
  width: number;
  height: number;
}

export class Labels {
  private readonly layer = document.createElement("div");
  private readonly pool: HTMLSpanElement[] = [];
  private used = 0;

  constructor(
    host: HTMLElement,
    private theme: Theme,
  ) {
    this.layer.setAttribute("aria-hidden", "true");
    Object.assign(this.layer.style, { position: "absolute", inset: "0", overflow: "hidden", pointerEvents: "none" });
    host.append(this.layer);
  }

  set_theme(theme: Theme): void {
    this.theme = theme;
  }

  begin(): void {
    this.used = 0;
  }

  /** Above the point; not at all outside of the view. */
  add(label: OverlayLabel, camera: THREE.PerspectiveCamera, view: ViewRectangle): void {
    const at = new THREE.Vector3(...label.at).project(camera);
    if (!(at.z < 1 && Math.abs(at.x) < 1 && Math.abs(at.y) < 1)) return;
    const x = view.left + (0.5 + 0.5 * at.x) * view.width;
    const y = view.top + (0.5 - 0.5 * at.y) * view.height;
    this.put(label.text, `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -130%)`, label.color);
  }

  /** In the upper left corner of a view. */
  add_title(text: string, view: ViewRectangle, color: string | null): void {
    this.put(text, `translate(${view.left + 10}px, ${view.top + 10}px)`, color);
  }

  end(): void {
    for (let i = this.used; i < this.pool.length; ++i) this.pool[i].style.display = "none";
  }

  dispose(): void {
    this.layer.remove();
  }

  private put(text: string, transform: string, dot: string | null): void {
    const { label_color, label_background } = theme_of(this.theme);
    const span = this.pool[this.used] ?? this.make();
    this.used += 1;
    if (span.dataset.text !== text) {
      span.dataset.text = text;
      span.replaceChildren(...with_subscripts(text));
    }
    Object.assign(span.style, {
      display: "block", transform, color: label_color, background: label_background,
      borderLeft: dot ? `0.3em solid ${dot}` : "none",
    });
  }

  private make(): HTMLSpanElement {
    const span = document.createElement("span");
    Object.assign(span.style, {
      position: "absolute", left: "0", top: "0", padding: "0.08em 0.5em", borderRadius: "0.35em", whiteSpace: "nowrap",
      font: "500 13px/1.45 system-ui, sans-serif", willChange: "transform",
    });
    this.layer.append(span);
    this.pool.push(span);
    return span;
  }
}

// "r_b" has a b below the line; names of bodies may have underscores too, and are longer.
function with_subscripts(text: string): (string | HTMLElement)[] {
  const parts = /^(.?[vrxωmIṗ])_(rel|a|b)(.*)$/u.exec(text);
  if (!parts) return [text];
  const below = document.createElement("sub");
  below.textContent = parts[2];
  return [parts[1], below, parts[3]];
}
