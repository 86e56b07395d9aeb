// The data of a page: a JSON header, and arrays that it refers to (src/page/array_store.h, src/page/clip_data.h).

/** [offset in bytes, count, kind]. Kind 0: doubles; else zigzag coded integers of that many bytes. By byte planes. */
export type ArrayReference = [number, number, number];
/** [order of prediction, array]. */
export type PredictedReference = [number, ArrayReference];

export class Container<Header> {
  readonly header: Header;
  readonly #arrays: Uint8Array;

  constructor(bytes: Uint8Array) {
    const damaged = new Error("The clip's data is incomplete or damaged: its header cannot be read.");
    if (bytes.length < 4) throw damaged;
    const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true);
    if (bytes.length < 4 + length) throw damaged;
    try {
      this.header = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length)));
    } catch {
      throw damaged;
    }
    this.#arrays = bytes.subarray(4 + length);
  }

  doubles([offset, count, kind]: ArrayReference): Float64Array {
    if (kind !== 0) throw new Error("The clip's data is damaged: an array is not of doubles.");
    const bytes = new Uint8Array(8 * count);
    for (let plane = 0, at = offset; plane < 8; ++plane)
      for (let i = 0; i < count; ++i) bytes[8 * i + plane] = this.#arrays[at++];
    return new Float64Array(bytes.buffer);
  }

  /** Whole numbers up to 2^52. */
  integers([offset, count, kind]: ArrayReference): Float64Array {
    const values = new Float64Array(count);
    for (let plane = kind - 1; plane >= 0; --plane) {
      const at = offset + plane * count;
      for (let i = 0; i < count; ++i) values[i] = 256 * values[i] + this.#arrays[at + i];
    }
    for (let i = 0; i < count; ++i) {
      const half = Math.floor(values[i] / 2);
      values[i] = 2 * half === values[i] ? half : -half - 1;
    }
    return values;
  }

  predicted([order, reference]: PredictedReference): Float64Array {
    const values = this.integers(reference);
    sum_differences(values, order);
    return values;
  }
}

/** Undoes differences of an order (src/page/prediction.h), in place. */
export function sum_differences(channel: Float64Array, order: number): void {
  for (let k = 0; k < order; ++k) for (let i = 1; i < channel.length; ++i) channel[i] += channel[i - 1];
}
