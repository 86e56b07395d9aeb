// The characters of equations, which the font of pages has.

const range = (first, last) => String.fromCodePoint(...Array.from({ length: last - first + 1 }, (_, i) => first + i));

/** Chromium draws a one-letter <mi> with the italic of mathematics, and temml writes bold letters as code points of their own. */
export const math_characters = [
  range(0x20, 0x7e),
  range(0x1d434, 0x1d467), "\u210e",       // italic Latin; the place of h is empty
  range(0x1d6e2, 0x1d71b),                  // italic Greek
  range(0x1d400, 0x1d433),                  // bold Latin
  range(0x1d736, 0x1d755),                  // bold italic Greek, small
  range(0x1d7ce, 0x1d7d7), range(0x1d5a0, 0x1d5b9),  // bold digits; upright sans, for a transpose
  range(0x391, 0x3a1), range(0x3a3, 0x3a9), range(0x3b1, 0x3c9), "\u03d5\u03f5",
  "\u00a0\u00a8\u00ac\u00af\u00b0\u00b1\u00b2\u00b3\u00b4\u00b7\u00b9\u00d7\u00f7",
  "\u02c6\u02c7\u02d8\u02d9\u02dc\u0302\u0304\u0307\u0308\u20d7",
  "\u2009\u200b\u2013\u2014\u2016\u2026\u2032\u2033\u203e\u2044\u2061\u2062\u2063",
  "\u2190\u2192\u2194\u21a6\u21d2\u21d4\u2113\u211d",
  "\u2200\u2202\u2203\u2205\u2206\u2207\u2208\u2209\u220f\u2211\u2212\u2213\u2215\u2216\u2217\u2218\u221a\u221d\u221e\u2220\u2223\u2225",
  "\u2227\u2228\u2229\u222a\u222b\u222c\u222e\u223c\u2243\u2245\u2248\u2260\u2261\u2264\u2265\u226a\u226b\u2282\u2286\u2295\u2297\u22a4\u22a5\u22c5\u22c6",
  "\u22ee\u22ef\u22f1\u2308\u2309\u230a\u230b\u27c2\u27e8\u27e9\u27f6\u2a2f",
  "\u239b\u239c\u239d\u239e\u239f\u23a0\u23a1\u23a2\u23a3\u23a4\u23a5\u23a6\u23a7\u23a8\u23a9\u23aa\u23ab\u23ac\u23ad\u23b4\u23b5\u23de\u23df",
].join("");
