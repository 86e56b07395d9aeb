// Sliders and choices of a live page.
import { h, new_id, set_text } from "../ui/dom.ts";
import { text_of } from "../texts/texts.ts";
import { DecimalSteps } from "./decimal.ts";
import type { LiveControl } from "./options.ts";

export interface ControlView {
  readonly key: string;
  readonly element: HTMLElement;
  /** As of `--set`; null: as in the scene. */
  value(): string | null;
  set(value: string | null): void;
  enable(enabled: boolean): void;
}

function row(control: LiveControl, input: HTMLElement, readout: HTMLElement): HTMLElement {
  const id = new_id("live");
  input.id = id;
  return h("div", { class: "tp-live-row" }, h("label", { for: id }, control.label), input, readout);
}

function shown(text: string, unit: string): string {
  return `${text.replace("-", "\u2212")}${unit ? `\u202f${unit}` : ""}`;
}

function slider(control: LiveControl, changed: () => void): ControlView {
  const steps = new DecimalSteps(control.min!, control.max!, control.step!);
  const input = h("input", { type: "range", min: 0, max: steps.last, step: 1, disabled: true });
  const readout = h("output", { class: "tp-live-value" });
  let value: string | null = null;
  const show = (): void => {
    const text = value === null ? text_of("as_in_scene") : shown(value, control.unit);
    set_text(readout, text);
    input.setAttribute("aria-valuetext", text);
  };
  const set = (to: string | null): void => {
    value = to;
    input.value = String(to === null ? Math.round(steps.last / 2) : steps.index(to));
    show();
  };
  input.addEventListener("input", () => {
    value = steps.text(Number(input.value));
    show();
    changed();
  });
  set(control.value ?? null);
  return { key: control.key, element: row(control, input, readout), value: () => value, set, enable: (on) => { input.disabled = !on; } };
}

function choice(control: LiveControl, changed: () => void): ControlView {
  const as_in_scene = control.value === undefined || !control.choices!.includes(control.value);
  const input = h("select", { class: "tp-select", disabled: true },
    as_in_scene && h("option", { value: "" }, control.value ?? text_of("as_in_scene")),
    ...control.choices!.map((each) => h("option", { value: each }, each)));
  const set = (to: string | null): void => { input.value = to !== null && control.choices!.includes(to) ? to : ""; };
  input.addEventListener("change", changed);
  set(control.value ?? null);
  return { key: control.key, element: row(control, input, h("span", { class: "tp-live-value" }, control.unit)),
    value: () => input.value || (control.value ?? null), set, enable: (on) => { input.disabled = !on; } };
}

export function build_control(control: LiveControl, changed: () => void): ControlView {
  return control.choices ? choice(control, changed) : slider(control, changed);
}
