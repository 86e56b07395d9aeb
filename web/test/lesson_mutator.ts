// Random changes of lessons. The same seed gives the same changes.
import { Buffer } from "node:buffer";

const most_bytes = 1 << 16;
const long_lesson = 3000;  // bytes

/** Words of a dictionary of libFuzzer: one in quotes on each line, with \\, \" and \xHH. */
export function read_dictionary(text: string): Buffer[] {
  return text.split("\n").flatMap((line) => {
    const quoted = /^[^#"]*"(.*)"\s*$/.exec(line);
    if (!quoted) return [];
    const bytes = quoted[1].replace(/\\(?:x([0-9a-f]{2})|(.))/gi, (_, code: string | undefined, sign: string) =>
      code === undefined ? sign : String.fromCharCode(parseInt(code, 16)));
    return [Buffer.from(bytes, "latin1")];
  });
}

export class Mutator {
  constructor(private readonly random: () => number, private readonly words: readonly Buffer[]) {}

  below(count: number): number {
    return Math.floor(this.random() * count);
  }

  pick<T>(list: readonly T[]): T {
    return list[this.below(list.length)];
  }

  /** `others`: lessons to take parts from. */
  change(bytes: Buffer, others: readonly Buffer[]): Buffer {
    let changed = bytes.length > long_lesson && this.below(8) > 0 ? this.excerpt(bytes) : bytes;
    for (let count = 1 + this.below(this.pick([2, 4, 16])); count > 0; --count) changed = this.change_once(changed, others);
    return changed.subarray(0, most_bytes);
  }

  /** The head of a long lesson, and some of its lines: most of a whole one would only take time. */
  private excerpt(bytes: Buffer): Buffer {
    const head = bytes.subarray(0, bytes.indexOf("\n+++\n") + 5);
    const from = bytes.lastIndexOf(10, head.length + this.below(bytes.length - head.length)) + 1;
    const end = bytes.indexOf(10, Math.min(bytes.length, from + long_lesson / 2));
    return Buffer.concat([head, bytes.subarray(from, end < 0 ? bytes.length : end)]);
  }

  private change_once(bytes: Buffer, others: readonly Buffer[]): Buffer {
    const [from, to] = this.pick([() => this.range(bytes), () => this.lines(bytes), () => this.short_range(bytes)])();
    const put = (part: Uint8Array, at = from, end = to) => Buffer.concat([bytes.subarray(0, at), part, bytes.subarray(end)]);
    const word = this.pick(this.words);
    switch (this.below(11)) {
      case 0: return put(word, from, from);
      case 1: return put(word);
      case 2: return put(Buffer.alloc(0), ...this.short_range(bytes));
      case 3: return put(Buffer.alloc(0));
      case 4: return put(bytes.subarray(from, to), to, to);
      case 5: return put(this.part_of(this.pick(others)), from, from);
      case 6: return put(this.part_of(this.pick(others)));
      case 7: return put(Buffer.from([this.below(256)]), from, Math.min(from + this.below(2), bytes.length));
      case 8: return put(this.repeated(this.pick([word, bytes.subarray(from, Math.min(to, from + 8))])), from, from);
      case 9: return this.with_number(bytes);
      default: {
        // Around a part, as brackets are.
        const count = this.pick([1, 2, 50]);
        const close = this.pick(this.words);
        return put(Buffer.concat([...Array<Buffer>(count).fill(word), bytes.subarray(from, to), ...Array<Buffer>(count).fill(close)]));
      }
    }
  }

  private range(bytes: Buffer): [number, number] {
    const a = this.below(bytes.length + 1), b = this.below(bytes.length + 1);
    return [Math.min(a, b), Math.max(a, b)];
  }

  private short_range(bytes: Buffer): [number, number] {
    const from = this.below(bytes.length + 1);
    return [from, Math.min(bytes.length, from + 1 + this.below(12))];
  }

  private lines(bytes: Buffer): [number, number] {
    const from = bytes.lastIndexOf(10, this.below(bytes.length + 1)) + 1;
    let to = from;
    for (let count = 1 + this.below(4); count > 0; --count) {
      const end = bytes.indexOf(10, to);
      to = end < 0 ? bytes.length : end + 1;
    }
    return [from, to];
  }

  private part_of(bytes: Buffer): Buffer {
    const [from, to] = this.lines(bytes);
    return bytes.subarray(from, to);
  }

  private repeated(part: Uint8Array): Buffer {
    const count = this.pick([2, 20, 200, 3000]);
    return Buffer.concat(Array<Uint8Array>(Math.min(count, Math.ceil((most_bytes >> 2) / Math.max(1, part.length)))).fill(part));
  }

  private with_number(bytes: Buffer): Buffer {
    const numbers = [...bytes.toString("latin1").matchAll(/-?\d+(\.\d+)?(e-?\d+)?/g)];
    if (numbers.length === 0) return bytes;
    const { index, 0: text } = this.pick(numbers);
    const other = this.pick(["0", "-1", "1", "2", "1e9", "1e300", "1e-300", "4294967296", "9007199254740993", "-0.0", "0.1", "99999999999999999999"]);
    return Buffer.concat([bytes.subarray(0, index), Buffer.from(other), bytes.subarray(index! + text.length)]);
  }
}
