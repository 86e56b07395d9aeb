// The keyboard's way through a page.
import type { Page } from "playwright-core";

/** Visible controls that the tabulator key does not reach, or that show no sign of the focus, as HTML. */
export async function controls_missed_by_tab(page: Page): Promise<string[]> {
  await page.evaluate(() => {
    const controls = 'a[href], button, input, select, textarea, summary, video[controls], [tabindex="0"]';
    const missed = new Set([...document.querySelectorAll<HTMLElement>(controls)].filter(
      (element) => element.checkVisibility({ checkVisibilityCSS: true }) && !element.matches(":disabled, [tabindex='-1']")));
    Object.assign(window, { missed_controls: missed, unmarked_controls: new Set<HTMLElement>() });
    (document.activeElement as HTMLElement | null)?.blur();
  });
  const number = await page.evaluate(() => (window as unknown as { missed_controls: Set<HTMLElement> }).missed_controls.size);
  for (let i = 0; i < 2 * number + 10; ++i) {
    await page.keyboard.press("Tab");
    const done = await page.evaluate(() => {
      const { missed_controls, unmarked_controls } = window as unknown as Record<string, Set<HTMLElement>>;
      const element = document.activeElement as HTMLElement;
      const style = getComputedStyle(element);
      if (missed_controls.delete(element) && style.outlineStyle === "none" && style.boxShadow === "none") unmarked_controls.add(element);
      return missed_controls.size === 0;
    });
    if (done) break;
  }
  return page.evaluate(() => {
    const { missed_controls, unmarked_controls } = window as unknown as Record<string, Set<HTMLElement>>;
    const html = (element: HTMLElement) => element.outerHTML.replace(element.innerHTML, "").slice(0, 200);
    return [...[...missed_controls].map((e) => `not reached: ${html(e)}`), ...[...unmarked_controls].map((e) => `no sign of the focus: ${html(e)}`)];
  });
}
