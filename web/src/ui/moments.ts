// The moments of a run at which impacts happen: impacts at one time are one moment.
import type { Impact, Run } from "../data/clip.ts";
import { number_text } from "./format.ts";
import { same_time } from "./player_state.ts";
import { text_of } from "../texts/texts.ts";

export interface Moment {
  time: number;
  /** Indices into the impacts: first .. last. */
  first: number;
  last: number;
}

const cache = new WeakMap<Run, Moment[]>();

export function moments_of(run: Run): Moment[] {
  let moments = cache.get(run);
  if (!moments) {
    moments = [];
    for (const [index, impact] of run.impacts.entries()) {
      const open = moments[moments.length - 1];
      if (open && impact.time - open.time < same_time) open.last = index;
      else moments.push({ time: impact.time, first: index, last: index });
    }
    cache.set(run, moments);
  }
  return moments;
}

/** Index of the first moment at or after the time, give or take rounding. */
function first_not_before(moments: Moment[], time: number): number {
  let low = 0;
  let high = moments.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (moments[middle].time < time) low = middle + 1;
    else high = middle;
  }
  return low;
}

export function next_moment(run: Run, time: number): Moment | null {
  const moments = moments_of(run);
  return moments[first_not_before(moments, time + same_time)] ?? null;
}

export function previous_moment(run: Run, time: number): Moment | null {
  const moments = moments_of(run);
  return moments[first_not_before(moments, time - same_time) - 1] ?? null;
}

export function moment_at(run: Run, time: number): Moment | null {
  const moments = moments_of(run);
  const moment = moments[first_not_before(moments, time - same_time)];
  return moment && moment.time <= time + same_time ? moment : null;
}

/** "Impact 3 at 1.3521 s: ball on ground, impulse 2.31 N s". */
export function moment_text(run: Run, moment: Moment): string {
  const impact: Impact = run.impacts[moment.first];
  const count = moment.last - moment.first + 1;
  const at = { time: moment.time.toFixed(4), first: moment.first + 1, last: moment.last + 1 };
  if (count === 1) {
    const what = text_of("with_impulse", { pair: pair_text(run, impact), impulse: number_text(impact.impulse, 3) });
    return text_of("impact_at", { ...at, what });
  }
  const pairs = new Set(run.impacts.slice(moment.first, moment.last + 1).map((each) => pair_text(run, each)));
  const named = [...pairs].slice(0, 3).join("; ") + (pairs.size > 3 ? `; ${text_of("more_pairs", { count: pairs.size - 3 })}` : "");
  return text_of("impacts_at", { ...at, what: named });
}

/** The moving body first: "ball on ground". */
export function pair_text(run: Run, impact: Impact): string {
  const a_moves = run.scene.bodies[impact.body_a]?.type === "dynamic";
  const b_moves = run.scene.bodies[impact.body_b]?.type === "dynamic";
  if (a_moves && b_moves) return text_of("both", { a: impact.a, b: impact.b });
  return text_of("one_on_other", b_moves ? { a: impact.b, b: impact.a } : { a: impact.a, b: impact.b });
}
