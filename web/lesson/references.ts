// References between equations, sections, stages and lessons: [](#eq-impulse), [text](friction.md#coulomb). A target may
// come after the reference, or in another lesson, so lessons are read twice: once for the targets, and once with them.
import { decode_address } from "./addresses.ts";
import { escape_html } from "./html.ts";
import { suggestion, type Place } from "./problems.ts";
import type { Source } from "./source.ts";

/** Ids of the page's own elements. */
const taken = /^(content|tumble-player|clip-.*|quiz-\d.*)$/;

/** Names of all lessons that can be referred to, each with the HTML that stands for a reference without text of its own:
 * "(3)", the section's title; empty if it needs one. */
export class Targets {
  readonly titles = new Map<string, string>();
  readonly anchors = new Map<string, Map<string, string>>();

  add_lesson(lesson: string, title: string): void {
    this.titles.set(lesson, title);
    this.anchors.set(lesson, new Map());
  }

  /** What is wrong with the name; empty: nothing. */
  add_anchor(lesson: string, name: string, html: string): string {
    const known = this.anchors.get(lesson)!;
    if (known.has(name)) return `the name '${name}' is used twice in this lesson`;
    if (taken.test(name)) return `the name '${name}' is taken by a part of the page: give another, as in {#my-${name}}`;
    known.set(name, html);
    return "";
  }
}

/** Where a reference leads. */
export interface Link {
  href: string;
  /** HTML, for a reference without text. */
  text: string;
}

const nowhere: Link = { href: "#", text: "" };

export class References {
  /** `targets`: of all lessons, or null while they are collected, when no reference is resolved. */
  constructor(private readonly targets: Targets | null, private readonly lies_beside: (file: string, name: string) => boolean) {}

  /** Null if the address is none of ours. `own`: name of the lesson that the reference stands in. */
  resolve(source: Source, place: Place, address: string, own: string, has_text: boolean): Link | null {
    const parts = /^(?:(?:\.\/)?([^#/:]+)\.md)?(?:#(.*))?$/s.exec(address);
    if (!parts || address === "") return null;
    const lesson = parts[1] === undefined ? own : decode_address(parts[1]) ?? "";
    const anchor = decode_address(parts[2] ?? "") ?? "";
    return this.targets ? this.found(this.targets, source, place, lesson, anchor, own, has_text) : nowhere;
  }

  private found(targets: Targets, source: Source, place: Place, lesson: string, anchor: string, own: string, has_text: boolean): Link {
    const file = lesson === own ? "" : page_address(lesson);
    const href = anchor ? `${file}#${encodeURIComponent(anchor)}` : file || "#content";
    const anchors = targets.anchors.get(lesson);
    // A lesson of the same course, which is not made this time.
    if (!anchors && this.lies_beside(source.file, `${lesson}.md`)) return { href, text: escape_html(lesson) };
    if (!anchors) {
      source.problem(place, `no lesson '${lesson}.md' among the lessons given or in their folder${suggestion(lesson, [...targets.anchors.keys()])}`);
      return nowhere;
    }
    const title = escape_html(targets.titles.get(lesson) ?? "");
    if (!anchor) return { href, text: title };
    const text = anchors.get(anchor);
    if (text === undefined) {
      source.problem(place, `no target '#${anchor}' in ${lesson}.md${suggestion(anchor, [...anchors.keys()])}`);
      return nowhere;
    }
    if (!has_text && !text) source.problem(place, `the reference needs a text: [text](#${anchor})`);
    return { href, text: file ? `${text} of \u201c${title}\u201d` : text };
  }
}

/** Address of a lesson's page from another one. */
export function page_address(lesson: string): string {
  return `${encodeURIComponent(lesson)}.html`;
}
