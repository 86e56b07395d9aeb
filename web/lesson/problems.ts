// Mistakes of lessons with their places. All of a course are collected, so that one run shows them all.

/** From 1, in the Markdown file. */
export interface Place {
  line: number;
  column: number;
}

export interface Problem extends Place {
  file: string;
  message: string;
}

const longest_message = 600;  // characters; it may quote a text of any length

export class Problems {
  readonly list: Problem[] = [];

  add(file: string, place: Place, message: string): void {
    const text = message.replace(/[\u0000-\u001f\u007f]+/g, " ");
    const start = text.slice(0, longest_message).replace(/[\ud800-\udbff]$/, "");
    this.list.push({ file, line: place.line, column: place.column, message: start.length < text.length ? `${start}\u2026` : text });
  }

  /** In order of file and place. */
  sorted(): Problem[] {
    return [...this.list].sort((a, b) =>
      a.file < b.file ? -1 : a.file > b.file ? 1 : a.line - b.line || a.column - b.column);
  }
}

/** As compilers print it, and as `tumble` prints mistakes of scenes. */
export function problem_text(problem: Problem): string {
  return `${problem.file}:${problem.line}:${problem.column}: error: ${problem.message}`;
}

/** Where the word stands alone in the text, without a character of words before it or after it; -1: nowhere. A regular
 * expression cannot be made of a word of any length. */
export function index_of_word(text: string, word: string, from = 0, of_words = /[A-Za-z0-9_]/): number {
  const continues = (character: string | undefined) => character !== undefined && of_words.test(character);
  for (let at = text.indexOf(word, from); at >= 0; at = text.indexOf(word, at + 1))
    if (!(continues(word[0]) && continues(text[at - 1])) && !continues(text[at + word.length])) return at;
  return -1;
}

const longest_name = 200;  // characters; a longer one is no misspelt name, and the distance takes the square of its length

function edit_distance(a: string, b: string): number {
  let row = Array.from({ length: b.length + 1 }, (_, j) => j);
  for (let i = 1; i <= a.length; ++i) {
    const next = [i];
    for (let j = 1; j <= b.length; ++j)
      next[j] = Math.min(row[j] + 1, next[j - 1] + 1, row[j - 1] + (a[i - 1] === b[j - 1] ? 0 : 1));
    row = next;
  }
  return row[b.length];
}

/** " (nearest: 'name')", or the known names if they are few, or nothing. */
export function suggestion(given: string, known: readonly string[]): string {
  if (given.length > longest_name) return "";
  let nearest = "";
  let least = Math.max(2, Math.floor(given.length / 3)) + 1;
  for (const name of known) {
    const distance = edit_distance(given, name);
    if (distance < least) {
      least = distance;
      nearest = name;
    }
  }
  if (nearest) return ` (nearest: '${nearest}')`;
  return known.length > 0 && known.length <= 12 ? ` (known: ${known.join(", ")})` : "";
}
