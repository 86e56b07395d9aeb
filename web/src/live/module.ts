// The simulation as a WebAssembly module (src/live), by the functions of include/tumble/live.h.

interface Exports {
  memory: WebAssembly.Memory;
  _initialize?(): void;
  malloc(bytes: number): number;
  free(address: number): void;
  tumble_open(name: number, text: number, settings: number): number;
  tumble_close(run: number): void;
  tumble_frames(run: number): number;
  tumble_advance(run: number, frames: number): number;
  tumble_error(run: number): number;
  tumble_error_line(run: number): number;
  tumble_error_column(run: number): number;
  tumble_data(run: number, size: number): number;
}

export interface LiveError {
  message: string;
  /** From 1; 0: unknown. */
  line: number;
  column: number;
}

/** Answers of an operating system that has no files, no environment and no arguments. */
const not_supported = 52;

/** The imports that the module asks for. None is needed by a run; the C library names them. */
function imports_of(module: WebAssembly.Module): WebAssembly.Imports {
  const imports: Record<string, Record<string, () => number>> = {};
  for (const { module: space, name, kind } of WebAssembly.Module.imports(module))
    if (kind === "function") (imports[space] ??= {})[name] = () => (name === "emscripten_notify_memory_growth" ? 0 : not_supported);
  // The lengths of an empty environment, which getenv() reads.
  return imports;
}

export class LiveModule {
  private readonly exports: Exports;

  private constructor(instance: WebAssembly.Instance) {
    this.exports = instance.exports as unknown as Exports;
    this.exports._initialize?.();
  }

  static async of(module: WebAssembly.Module): Promise<LiveModule> {
    return new LiveModule(await WebAssembly.instantiate(module, imports_of(module)));
  }

  /** Bytes of the module's memory, which only grows. */
  get memory(): number {
    return this.exports.memory.buffer.byteLength;
  }

  /** `settings`: PATH=VALUE. */
  open(name: string, text: string, settings: string[]): LiveRun {
    const texts = [name, text, settings.join("\n")].map((each) => this.text(each));
    const run = this.exports.tumble_open(texts[0], texts[1], texts[2]);
    for (const address of texts) this.exports.free(address);
    if (run === 0) throw new Error("memory is exhausted");
    return new LiveRun(this.exports, run);
  }

  private text(text: string): number {
    const bytes = new TextEncoder().encode(text);
    const address = this.exports.malloc(bytes.length + 1);
    const memory = new Uint8Array(this.exports.memory.buffer);
    memory.set(bytes, address);
    memory[address + bytes.length] = 0;
    return address;
  }
}

export class LiveRun {
  /** Of the whole clip; 0 of an invalid scene. */
  readonly all_frames: number;

  constructor(private readonly exports: Exports, private readonly run: number) {
    this.all_frames = exports.tumble_frames(run);
  }

  /** Simulates up to so many more frames; returns how many there are. */
  advance(frames: number): number {
    return this.exports.tumble_advance(this.run, frames);
  }

  get error(): LiveError | null {
    const begin = this.exports.tumble_error(this.run);
    const memory = new Uint8Array(this.exports.memory.buffer);
    const message = new TextDecoder().decode(memory.subarray(begin, memory.indexOf(0, begin)));
    if (message === "") return null;
    return { message, line: this.exports.tumble_error_line(this.run), column: this.exports.tumble_error_column(this.run) };
  }

  /** The data of the frames until now, as read_clip() reads it; null without frames. */
  data(): Uint8Array<ArrayBuffer> | null {
    const size = this.exports.malloc(4);
    const begin = this.exports.tumble_data(this.run, size);
    const length = new DataView(this.exports.memory.buffer).getUint32(size, true);
    this.exports.free(size);
    return begin === 0 ? null : new Uint8Array(this.exports.memory.buffer).slice(begin, begin + length);
  }

  close(): void {
    this.exports.tumble_close(this.run);
  }
}
