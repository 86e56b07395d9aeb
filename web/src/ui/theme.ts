// Dark or light: the system's choice until the reader chooses.
import type { Theme } from "./player_state.ts";

const storage_key = "tumble-theme";
const query = matchMedia("(prefers-color-scheme: dark)");
const listeners = new Set<(theme: Theme) => void>();
let chosen: Theme | null = null;
/** Paper is light. */
let printing = false;

/** Pages opened from disk may refuse storage. */
function stored(): Theme | null {
  try {
    const value = localStorage.getItem(storage_key);
    return value === "dark" || value === "light" ? value : null;
  } catch {
    return null;
  }
}

function apply(): void {
  if (chosen || printing) document.documentElement.dataset.theme = theme();
  else delete document.documentElement.dataset.theme;
  for (const call of listeners) call(theme());
}

export function theme(): Theme {
  if (printing) return "light";
  return chosen ?? (query.matches ? "dark" : "light");
}

export function toggle_theme(): void {
  chosen = theme() === "dark" ? "light" : "dark";
  try {
    localStorage.setItem(storage_key, chosen);
  } catch {
    // The choice holds for this page.
  }
  apply();
}

export function on_theme(call: (theme: Theme) => void): () => void {
  listeners.add(call);
  return () => listeners.delete(call);
}

chosen = stored();
if (chosen) document.documentElement.dataset.theme = chosen;
query.addEventListener("change", () => { if (!chosen) apply(); });
addEventListener("beforeprint", () => { printing = true; apply(); });
addEventListener("afterprint", () => { printing = false; apply(); });
