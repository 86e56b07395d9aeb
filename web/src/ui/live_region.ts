// Speaks events to screen readers.
import { h } from "./dom.ts";

export class Announcer {
  readonly element = h("div", { class: "tp-visually-hidden", role: "status", "aria-live": "polite" });

  say(text: string): void {
    // The same text twice is an event too: readers speak only changes.
    this.element.textContent = this.element.textContent === text ? `${text}\u00a0` : text;
  }
}
