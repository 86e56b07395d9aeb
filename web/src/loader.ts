// Unpacks the player, the only other script of the page, and runs it. Without it the films and pictures of the page stay.
import * as de from "./texts/de.ts";
import * as en from "./texts/en.ts";
import * as es from "./texts/es.ts";
import * as fr from "./texts/fr.ts";
import { in_force, in_language } from "./texts/language.ts";

const texts = in_force<Record<keyof typeof en.loader, string>>({ en: en.loader, de: de.loader, es: es.loader, fr: fr.loader });
const root = document.documentElement;

function explain_failure(text: string): void {
  root.dataset.player = "failed";
  for (const figure of document.querySelectorAll(".tumble-player")) {
    const note = in_language(document.createElement("p"));
    note.className = "player-note";
    note.textContent = text;
    const caption = figure.querySelector("figcaption");
    figure.insertBefore(note, caption);
  }
}

async function run_player(): Promise<void> {
  const packed = document.getElementById("tumble-player")!.textContent!.trim();
  const bytes = Uint8Array.from(atob(packed), (letter) => letter.charCodeAt(0));
  const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  const script = document.createElement("script");
  // The content security policy has the hash of this text.
  script.textContent = await new Response(unpacked).text();
  document.body.append(script);
}

if (typeof DecompressionStream === "undefined")
  explain_failure(texts.too_old);
else run_player().catch(() => explain_failure(texts.damaged));
