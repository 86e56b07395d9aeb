// What the fuzz target of lessons and its thread tell each other.

export interface FuzzPlan {
  seed: number;
  /** Changed lessons after those of the corpus. */
  runs: number;
  corpus: Uint8Array[];
  /** Text of a dictionary of libFuzzer. */
  dictionary: string;
  /** Int32: number of started lessons, bytes of the current one, not 0 to stop. */
  counters: SharedArrayBuffer;
  /** The current lesson. */
  current: SharedArrayBuffer;
}

export type FuzzReport = { kind: "new" | "finding"; what: string; input: Uint8Array } | { kind: "end" };
