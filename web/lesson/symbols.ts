// The symbols of lessons: their TeX macros, and the names by which expressions, arrows and numbers know them.

export interface Symbol {
  /** Without the backslash. */
  macro: string;
  tex: string;
  /** Its name in expressions; also of `data-symbol` in the page. */
  name: string;
  /** What a reader hears or sees when it is chosen. */
  meaning: string;
}

function symbol(macro: string, name: string, tex: string, meaning: string): Symbol {
  return { macro, tex, name, meaning };
}

/** A quantity of both bodies of an impact, with its values before and after: \va \vam \vap, \vb \vbm \vbp. */
function before_and_after(stem: string, name: string, tex: string, meaning: string): Symbol[] {
  return (["a", "b"] as const).flatMap((body) => {
    const of_body = tex.replaceAll("BODY", body);
    const whose = `${meaning} of ${body.toUpperCase()}`;
    return [
      symbol(stem + body, name + body, of_body, whose),
      symbol(`${stem}${body}m`, name + body, `${of_body}^{-}`, `${whose} before the impact`),
      symbol(`${stem}${body}p`, `${name}${body}p`, `${of_body}^{+}`, `${whose} after the impact`),
    ];
  });
}

function of_both(stem: string, name: string, tex: string, meaning: string): Symbol[] {
  return (["a", "b"] as const).map((body) =>
    symbol(stem + body, name + body, tex.replaceAll("BODY", body), `${meaning} of ${body.toUpperCase()}`));
}

const v_rel = "v_{\\mathrm{rel}}";

export const symbols: Symbol[] = [
  symbol("vrel", "vrel", v_rel, "relative velocity along the normal"),
  symbol("vrelm", "vrel", `${v_rel}^{-}`, "relative velocity along the normal before the impact"),
  symbol("vrelp", "vrelp", `${v_rel}^{+}`, "relative velocity along the normal after the impact"),
  symbol("nhat", "n", "\\hat{\\mathbf{n}}", "contact normal"),
  symbol("jn", "j", "j", "impulse along the normal"),
  symbol("pp", "p", "\\mathbf{p}", "contact point"),
  symbol("eps", "e", "\\varepsilon", "coefficient of restitution"),
  ...of_both("r", "r", "\\mathbf{r}_BODY", "arm to the contact point, from the center of mass"),
  ...of_both("x", "x", "\\mathbf{x}_BODY", "center of mass"),
  ...of_both("m", "m", "m_BODY", "mass"),
  ...of_both("I", "I", "\\mathbf{I}_BODY", "world-frame inertia matrix"),
  ...before_and_after("p", "u", "\\dot{\\mathbf{p}}_BODY", "velocity of the contact point"),
  ...before_and_after("v", "v", "\\mathbf{v}_BODY", "velocity of the center of mass"),
  ...before_and_after("w", "w", "\\boldsymbol{\\omega}_BODY", "angular velocity"),
  symbol("xx", "x", "\\mathbf{x}", "position of the center of mass"),
  symbol("vv", "v", "\\mathbf{v}", "velocity of the center of mass"),
  symbol("ww", "w", "\\boldsymbol{\\omega}", "angular velocity"),
  symbol("PP", "P", "\\mathbf{P}", "momentum"),
  symbol("LL", "L", "\\mathbf{L}", "angular momentum about the center of mass"),
  symbol("RR", "R", "\\mathbf{R}", "rotation matrix"),
  symbol("II", "I", "\\mathbf{I}", "world-frame inertia matrix"),
  symbol("mm", "m", "m", "mass"),
  symbol("FF", "F", "\\mathbf{F}", "total external force"),
  symbol("tauu", "tau", "\\boldsymbol{\\tau}", "total external torque about the center of mass"),
  symbol("gg", "g", "\\mathbf{g}", "acceleration of gravity"),
  symbol("tt", "t", "t", "time"),
  symbol("hh", "h", "h", "step of the simulation"),
];

const units: Record<string, string> = {
  t: "s", h: "s", p: "m", ra: "m", rb: "m", xa: "m", xb: "m", vrel: "m/s", vrelp: "m/s", j: "N s", f: "N s",
  ma: "kg", mb: "kg", Ia: "kg m\u00b2", Ib: "kg m\u00b2", va: "m/s", vb: "m/s", vap: "m/s", vbp: "m/s",
  ua: "m/s", ub: "m/s", uap: "m/s", ubp: "m/s", wa: "rad/s", wb: "rad/s", wap: "rad/s", wbp: "rad/s",
  x: "m", v: "m/s", w: "rad/s", P: "kg m/s", L: "kg m\u00b2/s", I: "kg m\u00b2", m: "kg", F: "N", tau: "N m", g: "m/s\u00b2",
  Ekin: "J", Epot: "J",
};

/** SI unit of a symbol of expressions; empty of pure numbers. */
export function unit_of(name: string): string {
  return units[name] ?? "";
}

const macros = Object.fromEntries(symbols.map((s) => [`\\${s.macro}`, `\\data{symbol=${s.name}}{${s.tex}}`]));

/** For temml, which writes into the list that it is given. */
export function symbol_macros(): Record<string, string> {
  return { ...macros };
}

export type ValueType = "number" | "vector" | "matrix";

function typed(numbers: string, vectors: string, matrices: string): Map<string, ValueType> {
  const types = new Map<string, ValueType>();
  for (const name of numbers.split(" ")) types.set(name, "number");
  for (const name of vectors.split(" ")) types.set(name, "vector");
  for (const name of matrices.split(" ")) types.set(name, "matrix");
  return types;
}

export type Moment = "impact" | "now";
export const moments: readonly Moment[] = ["impact", "now"];

/** Symbols of expressions. */
export const symbol_types: Record<Moment, Map<string, ValueType>> = {
  impact: typed(
    "t vrel vrelp e j ma mb ima imb",
    "p n ra rb xa xb f va vb wa wb vap vbp wap wbp ua ub uap ubp",
    "Ia Ib iIa iIb"),
  now: typed("t h m Ekin Epot", "g x v w P L F tau", "R I iI"),
};
