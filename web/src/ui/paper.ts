// Equations on paper, where nothing scrolls: a wide one becomes as small as it must be.

/** CSS pixels: A4 and Letter have more between the margins that browsers set. */
const paper_width = 620;

/** Of these the print styles take the zoom. */
const wide_parts = ".tp-equation, .numbers-equation, .equation-body";

function natural_width(element: HTMLElement): number {
  const before = element.style.width;
  element.style.width = "max-content";
  const width = element.offsetWidth;
  element.style.width = before;
  return width;
}

export function fit_to_paper(): void {
  addEventListener("beforeprint", () => {
    for (const element of document.querySelectorAll<HTMLElement>(wide_parts))
      element.style.setProperty("--paper-zoom", String(Math.min(1, paper_width / Math.max(1, natural_width(element)))));
  });
}
