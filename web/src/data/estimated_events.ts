// Where a clip has too many impacts to keep the bodies' states at each, these follow from the frames around: the body
// flies from the frame before to its first impact, and from its last impact to the frame after.
import type { Vec3 } from "./clip.ts";
import type { Moment } from "./segment.ts";
import type { BodyEvent } from "./track.ts";
import { difference, moved, norm, normalized, product, scaled, sum, turn_by, turn_of, conjugate } from "./vectors.ts";

const most_apart = 0.25; // of the way in a frame: farther apart, both flights do not meet, so the body was not in flight

function flown(from: Moment, time: number, gravity: Vec3): Moment {
  const t = time - from.time;
  return {
    time,
    position: moved(moved(from.position, t, from.velocity), 0.5 * t * t, gravity),
    rotation: normalized(product(turn_by(scaled(t, from.angular_velocity)), from.rotation)),
    velocity: moved(from.velocity, t, gravity),
    angular_velocity: from.angular_velocity,
  };
}

function one_event(before: Moment, after: Moment, share: number): BodyEvent {
  const position = sum(scaled(1 - share, before.position), scaled(share, after.position));
  const turn = turn_of(product(after.rotation, conjugate(before.rotation)));
  const rotation = normalized(product(turn_by(scaled(share, turn)), before.rotation));
  const { time } = before;
  return { time, impact_time: time, before: { ...before, position, rotation }, after: { ...after, position, rotation } };
}

function two_events(first: Moment, last: Moment): BodyEvent[] {
  const rate = 1 / (last.time - first.time);
  const velocity = scaled(rate, difference(last.position, first.position));
  const angular_velocity = scaled(rate, turn_of(product(last.rotation, conjugate(first.rotation))));
  const between = { velocity, angular_velocity };
  return [
    { time: first.time, impact_time: first.time, before: first, after: { ...first, ...between } },
    { time: last.time, impact_time: last.time, before: { ...last, ...between }, after: last },
  ];
}

/** `times`: when the body is struck, in order, s. */
export function estimated_events(frames: Moment[], times: number[], gravity: Vec3): BodyEvent[] {
  const events: BodyEvent[] = [];
  let next = 0;
  for (let n = 0; n + 1 < frames.length; ++n) {
    const from = frames[n], to = frames[n + 1];
    while (next < times.length && times[next] < from.time - 1e-9) ++next;
    const first = times[next];
    let last = -1;
    for (; next < times.length && times[next] < to.time - 1e-9; ++next) last = times[next];
    if (last < 0) continue;
    const start = Math.max(first, from.time), end = Math.max(last, start);
    const before = flown(from, start, gravity), after = flown(to, end, gravity);
    const span = to.time - from.time;
    if (end - start > 1e-3 * span) {
      events.push(...two_events(before, after));
      continue;
    }
    const apart = norm(difference(before.position, after.position));
    const way = span * (norm(from.velocity) + norm(to.velocity));
    if (apart <= most_apart * way) events.push(one_event(before, { ...after, time: start }, (start - from.time) / span));
  }
  return events;
}
