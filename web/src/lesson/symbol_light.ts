// A symbol under the pointer, or reached by the arrow keys in an equation, lights its arrow on the stage and shows its number.
import { h } from "../ui/dom.ts";
import type { Player } from "../ui/player.ts";
import { symbols, unit_of } from "../../lesson/symbols.ts";
import { is_infinite, value_text } from "./value_math.ts";
import { meaning_of, type LessonStages } from "./stages.ts";
import { in_language } from "../texts/language.ts";
import { term_of, text_of } from "../texts/texts.ts";

const gap = 8; // pixels between symbol and note

function meaning_text(name: string): string {
  const meaning = symbols.find((symbol) => symbol.name === name)?.meaning ?? "";
  const [, stem, body, side] = /^(.*?)(?: of ([AB]))?(?: (before|after) the impact)?$/.exec(meaning)!;
  const text = body ? text_of("meaning_of", { meaning: term_of(stem), body }) : term_of(stem);
  return side ? text_of(side === "before" ? "meaning_before" : "meaning_after", { meaning: text }) : text;
}

export class SymbolLight {
  private readonly note = h("div", { class: "symbol-note", role: "status", "aria-live": "polite", hidden: true });
  private lit: MathMLElement | null = null;
  private player: Player | null = null;

  constructor(private readonly stages: LessonStages, root: HTMLElement) {
    document.body.append(in_language(this.note));
    const symbol_at = (target: EventTarget | null): MathMLElement | null =>
      target instanceof Element ? target.closest<MathMLElement>("[data-symbol]") : null;
    root.addEventListener("pointerover", (event) => this.light(symbol_at(event.target)));
    root.addEventListener("pointerleave", () => this.light(null));
    // A finger leaves no pointer behind; its click stays until the next one.
    document.addEventListener("click", (event) => this.light(symbol_at(event.target)));
    addEventListener("scroll", () => this.place(), { passive: true });
    for (const equation of root.querySelectorAll<HTMLElement>(".equation-body, .numbers-equation")) this.listen_to_keys(equation);
  }

  private listen_to_keys(equation: HTMLElement): void {
    if (!equation.querySelector("[data-symbol]")) return;
    equation.tabIndex = 0;
    equation.setAttribute("role", "group");
    equation.setAttribute("aria-label", text_of("equation_keys"));
    equation.addEventListener("keydown", (event) => {
      const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
      if (event.key === "Escape") this.light(null);
      if (step === 0) return;
      event.preventDefault();
      const all = [...equation.querySelectorAll<MathMLElement>("[data-symbol]")];
      const at = this.lit ? all.indexOf(this.lit) : -1;
      this.light(all[at < 0 ? (step > 0 ? 0 : all.length - 1) : (at + step + all.length) % all.length]);
    });
    equation.addEventListener("blur", () => this.light(null));
  }

  light(symbol: MathMLElement | null): void {
    if (symbol === this.lit) return;
    this.clear();
    if (!symbol) return;
    const name = symbol.dataset.symbol!;
    const player = this.stages.near(symbol);
    this.lit = symbol;
    // The same quantity everywhere in the text of this stage.
    for (const same of document.querySelectorAll<MathMLElement>(`[data-symbol="${CSS.escape(name)}"]`))
      if (this.stages.near(same) === player) same.classList.add("lit");
    const text = [meaning_text(name)];
    const meaning = player ? meaning_of(player, name) : null;
    if (player && meaning) {
      this.player = player;
      player.view.highlight({ name, impact: meaning.impact, body: meaning.body });
      const value = meaning.values[name];
      if (value !== undefined && is_infinite(name, value)) text.push(text_of("infinite"));
      else if (value !== undefined) text.push(`${value_text(value)} ${unit_of(name)}`.trim());
    }
    this.note.replaceChildren(h("span", {}, text[0]), ...(text[1] ? [h("b", {}, text[1])] : []));
    this.note.hidden = false;
    this.place();
  }

  private clear(): void {
    for (const symbol of document.querySelectorAll(".lit")) symbol.classList.remove("lit");
    this.player?.view.highlight(null);
    this.player = null;
    this.lit = null;
    this.note.hidden = true;
  }

  private place(): void {
    if (!this.lit) return;
    const box = this.lit.getBoundingClientRect();
    const note = this.note.getBoundingClientRect();
    const left = Math.min(Math.max(gap, (box.left + box.right - note.width) / 2), innerWidth - note.width - gap);
    const above = box.top - note.height - gap;
    this.note.style.left = `${left}px`;
    this.note.style.top = `${above > gap ? above : box.bottom + gap}px`;
  }
}
