// The worker of a live page: simulates in pieces, so that a newer request ends an older one.
import { LiveModule, type LiveRun } from "./module.ts";
import type { FromWorker, LiveRequest, ToWorker } from "./protocol.ts";

/** Of a piece, ms: the delay of a newer request. */
const piece_time = 30;
/** Of a run that gets its first frames shown before the rest, ms. */
const patience = 120;

const scope = globalThis as unknown as { onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
  postMessage(message: FromWorker, transfer?: Transferable[]): void };
const say = (message: FromWorker, transfer: Transferable[] = []): void => scope.postMessage(message, transfer);

let module: LiveModule | null = null;
let next: LiveRequest | null = null;
let stopped = false;
let busy = false;

/** Lets messages in. */
const breath = (): Promise<void> => new Promise((done) => { setTimeout(done, 0); });

function send(id: number, run: LiveRun, whole: boolean): void {
  const bytes = run.data();
  const error = run.error;
  if (bytes) say({ kind: "data", id, bytes, whole, error }, [bytes.buffer]);
  else if (error) say({ kind: "error", id, error });
}

async function simulate(request: LiveRequest): Promise<void> {
  const { id } = request;
  const run = module!.open(request.name, request.text, request.settings);
  try {
    if (run.error) return say({ kind: "error", id, error: run.error });
    const start = performance.now();
    let frames = 0, shown = false;
    while (frames < run.all_frames && !run.error) {
      const end = performance.now() + piece_time;
      while (frames < run.all_frames && !run.error && performance.now() < end) frames = run.advance(1);
      if (frames === run.all_frames || run.error) break;
      if (!shown && performance.now() - start > patience) {
        shown = true;
        send(id, run, false);
      }
      say({ kind: "progress", id, frames, all: run.all_frames });
      await breath();
      if (stopped) {
        send(id, run, true);
        return say({ kind: "stopped", id });
      }
      if (next) return;
    }
    send(id, run, true);
  } finally {
    run.close();
  }
}

async function work(): Promise<void> {
  if (busy) return;
  busy = true;
  while (next) {
    const request = next;
    next = null;
    stopped = false;
    try {
      await simulate(request);
    } catch (error) {
      say({ kind: "failed", reason: error instanceof Error ? error.message : String(error) });
    }
  }
  busy = false;
}

scope.onmessage = ({ data }) => {
  if (data.kind === "module") {
    LiveModule.of(data.module).then((made) => { module = made; say({ kind: "ready" }); void work(); },
      (error: unknown) => say({ kind: "failed", reason: error instanceof Error ? error.message : String(error) }));
  } else if (data.kind === "run") {
    next = data.request;
    if (module) void work();
  } else {
    stopped = true;
  }
};
