// Messages between a page and its simulation, which runs in a worker.
import type { LiveError } from "./module.ts";

export interface LiveRequest {
  /** Grows. A request makes the ones before it void. */
  id: number;
  name: string;
  text: string;
  /** PATH=VALUE. */
  settings: string[];
}

export type ToWorker =
  | { kind: "module"; module: WebAssembly.Module }
  | { kind: "run"; request: LiveRequest }
  | { kind: "stop" };

export type FromWorker =
  | { kind: "ready" }
  | { kind: "failed"; reason: string }
  | { kind: "progress"; id: number; frames: number; all: number }
  /** `whole`: the last data of the request. `error`: of a simulation that failed later. */
  | { kind: "data"; id: number; bytes: Uint8Array<ArrayBuffer>; whole: boolean; error: LiveError | null }
  | { kind: "error"; id: number; error: LiveError }
  | { kind: "stopped"; id: number };
