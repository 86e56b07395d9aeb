// Numbers as text.

const minus = "\u2212";
const superscripts: Record<string, string> = {
  "-": "\u207b", "0": "\u2070", "1": "\u00b9", "2": "\u00b2", "3": "\u00b3", "4": "\u2074",
  "5": "\u2075", "6": "\u2076", "7": "\u2077", "8": "\u2078", "9": "\u2079",
};

export type Digits = 3 | 4 | 6 | 17;

function power_text(exponent: number): string {
  return `\u00b710${[...String(exponent)].map((character) => superscripts[character]).join("")}`;
}

/** With a typographic minus and powers of ten: −1.25, 3.1·10⁻⁷. Below 17 digits, numbers nearer to 0 than `zero` are "0". */
export function number_text(value: number, digits: Digits = 6, zero = 1e-12): string {
  if (Number.isNaN(value)) return "\u2013";
  if (!Number.isFinite(value)) return value < 0 ? `${minus}\u221e` : "\u221e";
  if (digits < 17 && Math.abs(value) < zero) return "0";
  if (value === 0) return "0";
  const magnitude = Math.floor(Math.log10(Math.abs(value)));
  if (magnitude >= 7 || magnitude < -4) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    return `${mantissa.replace("-", minus)}${power_text(Number(exponent))}`;
  }
  // Integers have all their digits: 15360, where toPrecision() writes 1.536e+4.
  const text = magnitude >= digits ? String(Number(value.toPrecision(digits))) : value.toPrecision(digits);
  return text.replace("-", minus);
}

/** Without zeros at the end of the decimals. */
export function trimmed_text(value: number, digits: Digits = 6): string {
  return number_text(value, digits).replace(/(\.\d*?)0+(?=$|\u00b7)/, "$1").replace(/\.(?=$|\u00b7)/, "");
}

/** At most six characters or so, for ticks of axes. */
export function tick_text(value: number): string {
  if (Math.abs(value) < 1e5) return trimmed_text(value);
  const exponent = Math.floor(Math.log10(Math.abs(value)));
  return `${trimmed_text(Number((value / 10 ** exponent).toPrecision(3)))}${power_text(exponent)}`;
}

/** For files and the clipboard: the shortest text that gives the number back, with an ASCII minus. */
export function plain_text(value: number, digits: Digits = 17): string {
  return digits === 17 ? String(value) : String(Number(value.toPrecision(digits)));
}

export function time_text(time: number): string {
  return `${time.toFixed(3)} s`;
}

/** Speed of playing: "¼×". */
export function speed_text(speed: number): string {
  return `${speed === 0.25 ? "\u00bc" : speed === 0.5 ? "\u00bd" : speed}\u00d7`;
}

/** Two digits, without zeros at the end: for scales. */
export function short_text(value: number): string {
  const rounded = Number(value.toPrecision(2));
  return rounded >= 1e-3 && rounded < 1e6 ? String(rounded) : number_text(rounded, 3);
}
