// Several pictures side by side, in the arrangement in which they are largest.
import type { ViewRectangle } from "./labels.ts";

/** Width over height of a picture that shows what a scene's author composed. */
const composed = 16 / 9;
/** CSS pixels. */
const gap = 2;

export function tile(count: number, width: number, height: number): ViewRectangle[] {
  let best = { columns: 1, rows: count, size: 0 };
  for (let columns = 1; columns <= count; ++columns) {
    const rows = Math.ceil(count / columns);
    const size = Math.min(width / columns / composed, height / rows);
    // Of equal ones that with more columns: heights are compared side by side.
    if (size >= best.size) best = { columns, rows, size };
  }
  const { columns, rows } = best;
  const edge = (index: number, parts: number, whole: number) => Math.round((index * (whole + gap)) / parts);
  return Array.from({ length: count }, (_, i) => {
    const column = i % columns;
    const row = Math.floor(i / columns);
    const left = edge(column, columns, width);
    const top = edge(row, rows, height);
    return { left, top, width: edge(column + 1, columns, width) - gap - left, height: edge(row + 1, rows, height) - gap - top };
  });
}
