// Unpacks the player, the only other script of the page, and runs it. Without it the films and pictures of the page stay.
const root = document.documentElement;

function explain_failure(text: string): void {
  root.dataset.player = "failed";
  for (const figure of document.querySelectorAll(".tumble-player")) {
    const note = document.createElement("p");
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
  explain_failure("This browser is too old for the interactive view: it needs Chrome 103, Firefox 113, Safari 16.4 or later.");
else run_player().catch(() => explain_failure("The interactive view could not be unpacked: the file of this page is damaged."));
