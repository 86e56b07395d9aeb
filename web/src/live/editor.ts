// The scene's text, to change: mistakes stand below it, with line and column.
import { h } from "../ui/dom.ts";
import type { LiveError } from "./module.ts";
import { text_of } from "../texts/texts.ts";

/** After the last key, ms. */
const pause = 500;

export class Editor {
  readonly element: HTMLDetailsElement;
  private readonly area: HTMLTextAreaElement;
  private readonly mistake = h("p", { class: "tp-live-mistake", role: "status", hidden: true });
  private timer = 0;

  constructor(private readonly name: string, private readonly given: string, changed: () => void) {
    this.area = h("textarea", {
      class: "tp-live-text", rows: 16, spellcheck: "false", autocapitalize: "off", autocomplete: "off", wrap: "off",
      "aria-label": text_of("text_of", { name }), disabled: true,
    });
    this.area.value = given;
    this.area.addEventListener("input", () => {
      clearTimeout(this.timer);
      this.timer = setTimeout(changed, pause) as unknown as number;
    });
    this.element = h("details", { class: "tp-live-editor" }, h("summary", {}, text_of("change_scene")), this.area, this.mistake,
      h("p", { class: "tp-live-links" },
        h("button", { type: "button", class: "tp-link", onclick: () => this.save() }, text_of("save_scene"))));
  }

  get text(): string {
    return this.area.value;
  }

  get edited(): boolean {
    return this.text !== this.given;
  }

  get open(): boolean {
    return this.element.open;
  }

  set(text: string | null): void {
    clearTimeout(this.timer);
    this.area.value = text ?? this.given;
    this.show(null);
  }

  enable(enabled: boolean): void {
    this.area.disabled = !enabled;
  }

  show(error: LiveError | null): void {
    this.mistake.hidden = error === null;
    this.mistake.replaceChildren();
    this.area.setAttribute("aria-invalid", String(error !== null));
    if (error === null) return;
    if (error.line > 0) {
      this.mistake.append(h("button", { type: "button", class: "tp-link", onclick: () => this.go_to(error) },
        text_of("line_column", { line: error.line, column: error.column })), ": ");
    }
    this.mistake.append(error.message.replace(/^(?:[^\n]*?:\d+:\d+: )?error: /, ""));
  }

  private go_to({ line, column }: LiveError): void {
    const before = this.area.value.split("\n").slice(0, line - 1).reduce((sum, each) => sum + each.length + 1, 0);
    const at = Math.min(before + Math.max(column - 1, 0), this.area.value.length);
    this.area.focus();
    this.area.setSelectionRange(at, at);
  }

  private save(): void {
    const link = h("a", { download: this.name, href: `data:text/plain;charset=utf-8,${encodeURIComponent(this.text)}` });
    link.click();
  }
}
