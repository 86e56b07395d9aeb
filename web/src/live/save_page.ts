// The page as a file with the reader's settings in it.
import type { LiveOptions } from "./options.ts";

/** Taken before the players change the page. */
export class PristinePage {
  private readonly root = document.documentElement.cloneNode(true) as HTMLElement;

  constructor() {
    // The player is unpacked again where the saved page is opened.
    for (const script of this.root.querySelectorAll("body > script:not([type])"))
      if (script.id === "" && script.textContent!.length > 20_000) script.remove();
    this.root.dataset.player = "loading";
  }

  /** `clip`: of the figure. */
  save(file: string, clip: string, options: LiveOptions): void {
    this.root.querySelector<HTMLElement>(`figure.tumble-player[data-clip="${clip}"]`)!.dataset.live = JSON.stringify(options);
    const html = `<!doctype html>\n${this.root.outerHTML}\n`;
    const address = URL.createObjectURL(new Blob([html], { type: "text/html" }));
    const link = document.createElement("a");
    link.download = file;
    link.href = address;
    link.click();
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
  }
}
