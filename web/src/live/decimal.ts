// Steps of a slider as decimal text: 0.15 is 15 hundredths, never 0.15000000000000002.

/** Digits after the point. */
function places(text: string): number {
  const point = text.indexOf(".");
  return point < 0 ? 0 : text.length - point - 1;
}

function scaled(text: string, digits: number): number {
  return Math.round(Number(text) * 10 ** digits);
}

function text_of(whole: number, digits: number): string {
  const sign = whole < 0 ? "-" : "";
  const all = String(Math.abs(whole)).padStart(digits + 1, "0");
  if (digits === 0) return sign + all;
  return `${sign}${all.slice(0, -digits)}.${all.slice(-digits)}`;
}

export class DecimalSteps {
  private readonly digits: number;
  private readonly first: number;
  private readonly by: number;
  /** Index of the largest value; 0 has the smallest one. */
  readonly last: number;

  /** All without exponent. */
  constructor(min: string, max: string, step: string) {
    this.digits = Math.max(places(min), places(step));
    this.first = scaled(min, this.digits);
    this.by = Math.max(1, scaled(step, this.digits));
    this.last = Math.max(0, Math.floor((scaled(max, this.digits) - this.first) / this.by + 1e-9));
  }

  text(index: number): string {
    return text_of(this.first + index * this.by, this.digits);
  }

  /** Of the nearest value. */
  index(text: string): number {
    const at = Math.round((Number(text) * 10 ** this.digits - this.first) / this.by);
    return Math.min(Math.max(at, 0), this.last);
  }
}
