// The simulation of a page, in a worker of its own: unpacked at the first need, started again where it hangs.
import { read_clip } from "../data/decode_clip.ts";
import type { Clip } from "../data/clip.ts";
import { inflate_bytes } from "../data/inflate.ts";
import type { LiveError } from "./module.ts";
import type { FromWorker, LiveRequest, ToWorker } from "./protocol.ts";
import { decode91 } from "./text91.ts";
import { text_of } from "../texts/texts.ts";

declare const LIVE_WORKER: string;

/** A worker that does not answer a stop hangs in a step, ms. */
const stop_patience = 1000;
/** The reader is asked to wait or to stop after that time, ms. */
export const time_limit = 10_000;

/** (module (func (result v128) i32.const 0 i8x16.splat)): refused by engines without vectors. */
const with_vectors = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0, 65, 0, 253, 15, 11]);

export interface SimulationEvents {
  ready(): void;
  /** For a reader: why there is no simulation. */
  failed(reason: string): void;
  progress(share: number): void;
  data(clip: Clip, whole: boolean, error: LiveError | null): void;
  error(error: LiveError): void;
  stopped(): void;
}

let shared: Promise<WebAssembly.Module> | null = null;

/** One for all players of the page. */
function compiled(): Promise<WebAssembly.Module> {
  return shared ??= compile();
}

async function compile(): Promise<WebAssembly.Module> {
  if (typeof WebAssembly === "undefined") throw new Error(text_of("no_webassembly"));
  if (!WebAssembly.validate(with_vectors)) throw new Error(text_of("old_for_simulation"));
  const packed = decode91(document.getElementById("tumble-live")?.textContent?.trim() ?? "");
  if (!packed?.length) throw new Error(text_of("no_simulation"));
  const bytes = await inflate_bytes(packed) as Uint8Array<ArrayBuffer>;
  try {
    return await WebAssembly.compile(bytes);
  } catch (error) {
    throw new Error(text_of(/unsafe-eval|Content Security|disallowed/i.test(String(error)) ? "forbidden" : "unreadable"));
  }
}

export class Simulation {
  private module: WebAssembly.Module | null = null;
  private worker: Worker | null = null;
  private ready = false;
  private last_id = 0;
  private waiting: LiveRequest | null = null;
  private stop_timer = 0;

  constructor(private readonly events: SimulationEvents) {}

  async start(): Promise<void> {
    try {
      this.module = await compiled();
      this.start_worker();
    } catch (error) {
      this.events.failed(error instanceof Error ? error.message : String(error));
    }
  }

  run(request: Omit<LiveRequest, "id">): void {
    clearTimeout(this.stop_timer);
    this.last_id += 1;
    this.waiting = { ...request, id: this.last_id };
    this.send_waiting();
  }

  /** Makes the run void. */
  cancel(): void {
    this.last_id += 1;
    this.waiting = null;
    this.tell({ kind: "stop" });
  }

  /** Ends the run; what there is of it stays. */
  stop(): void {
    this.waiting = null;
    this.tell({ kind: "stop" });
    clearTimeout(this.stop_timer);
    this.stop_timer = setTimeout(() => {
      this.worker?.terminate();
      this.start_worker();
      this.events.stopped();
    }, stop_patience) as unknown as number;
  }

  private start_worker(): void {
    this.ready = false;
    const refused = text_of("no_worker");
    try {
      const address = URL.createObjectURL(new Blob([LIVE_WORKER], { type: "text/javascript" }));
      this.worker = new Worker(address);
      URL.revokeObjectURL(address);
    } catch {
      this.events.failed(refused);
      return;
    }
    this.worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.hear(data);
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.events.failed(this.ready ? text_of("simulation_failed", { reason: event.message }) : refused);
    };
    this.tell({ kind: "module", module: this.module! });
  }

  private tell(message: ToWorker): void {
    this.worker?.postMessage(message);
  }

  private send_waiting(): void {
    if (!this.ready || !this.waiting) return;
    this.tell({ kind: "run", request: this.waiting });
    this.waiting = null;
  }

  private hear(message: FromWorker): void {
    if (message.kind === "ready") {
      this.ready = true;
      this.events.ready();
      this.send_waiting();
    } else if (message.kind === "failed") {
      this.events.failed(text_of("cannot_run", { reason: message.reason }));
    } else if (message.id === this.last_id) {
      this.hear_of_run(message);
    }
  }

  private hear_of_run(message: Extract<FromWorker, { id: number }>): void {
    if (message.kind === "progress") {
      this.events.progress(message.frames / message.all);
    } else if (message.kind === "error") {
      this.events.error(message.error);
    } else if (message.kind === "stopped") {
      clearTimeout(this.stop_timer);
      this.events.stopped();
    } else {
      this.events.data(read_clip(message.bytes), message.whole, message.error);
    }
  }
}
