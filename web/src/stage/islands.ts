// Bodies in contact with each other, by way of others too. Fixed and kinematic bodies join none.
import type { Run } from "../data/clip.ts";
import { nobody } from "../data/clip.ts";

/** By body: the lowest index in its island. */
export function island_roots(run: Run, frame: number): number[] {
  const { contacts, scene } = run;
  const parent = scene.bodies.map((_, i) => i);
  const root = (i: number): number => {
    while (parent[i] !== i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (let row = contacts.first[frame]; row < contacts.first[frame + 1]; ++row) {
    const [a, b] = [contacts.a[row], contacts.b[row]];
    if (a === nobody || scene.bodies[a].type !== "dynamic" || scene.bodies[b].type !== "dynamic") continue;
    const [one, other] = [root(a), root(b)];
    parent[Math.max(one, other)] = Math.min(one, other);
  }
  return parent.map((_, i) => root(i));
}
