// References between equations, sections, stages and lessons: [](#eq-impulse), [text](friction.md#coulomb). They are
// filled in when all lessons are read, because a target may come later.
import { existsSync } from "node:fs";
import { dirname, join } from "node:path";
import { escape_html } from "./html.ts";
import { suggestion, type Place } from "./problems.ts";
import type { Source } from "./source.ts";

/** What can be referred to in a lesson. */
export interface Anchor {
  /** Of a reference without text of its own: "(3)", the section's title; empty if it needs one. */
  text: string;
}

interface Reference {
  source: Source;
  place: Place;
  /** Name of the lesson; empty: the one that it stands in. */
  lesson: string;
  anchor: string;
  has_text: boolean;
}

export class References {
  private readonly waiting: Reference[] = [];
  private readonly anchors = new Map<string, Map<string, Anchor>>();
  private readonly titles = new Map<string, string>();

  add_lesson(lesson: string, title: string): void {
    this.titles.set(lesson, title);
    this.anchors.set(lesson, new Map());
  }

  /** False if the lesson has that name already. */
  add_anchor(lesson: string, name: string, anchor: Anchor): boolean {
    const known = this.anchors.get(lesson)!;
    if (known.has(name)) return false;
    known.set(name, anchor);
    return true;
  }

  /** Null if the address is none of ours. Else the marks that stand for the address and the text. */
  refer(source: Source, place: Place, address: string, has_text: boolean): { href: string; text: string } | null {
    const parts = /^(?:(?:\.\/)?([^#/:]+)\.md)?(?:#(.*))?$/.exec(address);
    if (!parts || address === "") return null;
    this.waiting.push({ source, place, lesson: parts[1] ?? "", anchor: decodeURIComponent(parts[2] ?? ""), has_text });
    const index = this.waiting.length - 1;
    return { href: `%%href:${index}%%`, text: `%%text:${index}%%` };
  }

  /** Tells every reference without target, once. */
  resolve_all(own_lesson: (source: Source) => string): (html: string) => string {
    const resolved = this.waiting.map((reference) => this.resolve(reference, own_lesson(reference.source)));
    return (html) => html
      .replace(/%%href:(\d+)%%/g, (_, index) => resolved[Number(index)].href)
      .replace(/%%text:(\d+)%%/g, (_, index) => resolved[Number(index)].text);
  }

  private resolve(reference: Reference, own: string): { href: string; text: string } {
    const { source, place, anchor, has_text } = reference;
    const lesson = reference.lesson || own;
    const none = { href: "#", text: "" };
    const anchors = this.anchors.get(lesson);
    if (!anchors && existsSync(join(dirname(source.file), `${lesson}.md`))) {
      // A lesson of the same course, which is not made this time.
      return { href: `${lesson}.html${anchor ? `#${anchor}` : ""}`, text: escape_html(lesson) };
    }
    if (!anchors) {
      source.problem(place, `no lesson '${lesson}.md' among the lessons given or in their folder${suggestion(lesson, [...this.anchors.keys()])}`);
      return none;
    }
    const file = reference.lesson && reference.lesson !== own ? `${lesson}.html` : "";
    const title = escape_html(this.titles.get(lesson) ?? "");
    if (!anchor) return { href: file, text: title };
    const target = anchors.get(anchor);
    if (!target) {
      source.problem(place, `no target '#${anchor}' in ${lesson}.md${suggestion(anchor, [...anchors.keys()])}`);
      return none;
    }
    if (!has_text && !target.text)
      source.problem(place, `the reference needs a text: [text](#${anchor})`);
    return { href: `${file}#${anchor}`, text: file ? `${target.text} of \u201c${title}\u201d` : target.text };
  }
}
