// The accessibility checker axe on a page.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import type { Page } from "playwright-core";

const axe_source = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

interface AxeResults {
  violations: { id: string; impact: string; help: string; nodes: { target: string[]; failureSummary: string }[] }[];
}

/** A line for each violation of any rule, with the first places. */
export async function accessibility_faults(page: Page): Promise<string[]> {
  // Colors between two states have less contrast than either.
  await page.evaluate(() => Promise.all(document.getAnimations().filter((one) => one instanceof CSSTransition)
    .map((one) => one.finished.catch(() => undefined))));
  await page.evaluate(axe_source);   // as a script element the page's policy would refuse it
  const results = await page.evaluate(() =>
    (window as unknown as { axe: { run(root: Document, options: object): Promise<AxeResults> } }).axe.run(document, { preload: false }));
  return results.violations.map(({ id, impact, help, nodes }) =>
    `${impact}: ${id}: ${help}: ${nodes.slice(0, 3).map((node) => `${node.target.join(" ")} (${node.failureSummary.replaceAll("\n", " ")})`).join("; ")}`);
}
