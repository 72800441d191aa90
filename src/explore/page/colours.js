// The colours of the figures (OKLab: equal distances look equally different), and their like on a dark ground.

/** The sRGB bytes of an OKLab lightness, chroma and hue in turns; a chroma that no screen has is reduced. */
function fromLch(lightness, chroma, hue) {
  const [sin, cos] = [Math.sin(hue * 2 * Math.PI), Math.cos(hue * 2 * Math.PI)];
  const linear = (c) => {
    const [a, b] = [c * cos, c * sin];
    const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
    return [
      4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
      -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
      -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
    ];
  };
  const inside = (rgb) => rgb.every((c) => c >= 0 && c <= 1);
  let [low, high] = [0, chroma];
  if (inside(linear(high))) low = high;
  while (high - low > 1e-6) {
    const middle = (low + high) / 2;
    if (inside(linear(middle))) low = middle;
    else high = middle;
  }
  return linear(low).map((c) => {
    const x = Math.min(1, Math.max(0, c));
    return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
  });
}

const gradient = (from, to) => (t) => {
  const mix = (k) => from[k] + t * (to[k] - from[k]);
  return fromLch(mix(0), mix(1) + 0.16 * t * (1 - t), mix(2));
};

/** Lightness, chroma, hue of seven families and of all others, as the program's figures have them. */
const FAMILIES = [
  [0.40, 0.17, 0.715], [0.68, 0.17, 0.13], [0.56, 0.13, 0.45], [0.47, 0.19, 0.03],
  [0.76, 0.11, 0.64], [0.85, 0.16, 0.26], [0.29, 0.13, 0.86], [0.62, 0.03, 0.75],
];

/** Their like on a dark ground: for every kind of colour vision any two are 0.12 apart in OKLab at least, as a search found them. */
const ON_DARK = [
  [0.63, 0.15, 0.746], [0.67, 0.17, 0.113], [0.79, 0.16, 0.423], [0.56, 0.12, 0.04],
  [0.91, 0.16, 0.616], [0.93, 0.18, 0.289], [0.5, 0.14, 0.863], [0.72, 0.03, 0.724],
];

const SHADES = 256;
const shades = (scale) => Array.from({ length: SHADES }, (_, k) => scale(k / (SHADES - 1)));

/** Scales are computed when they are first looked at: the first picture needs none. */
function theme({ growth, families, ...plain }) {
  const made = {};
  return {
    ...plain,
    get growth() {
      return (made.growth ??= shades(growth));
    },
    /** By the rank of a; the last is that of all others. */
    get families() {
      return (made.families ??= families.map((lch) => fromLch(...lch)));
    },
  };
}

export const LIGHT = theme({
  paper: [255, 255, 255], ink: [0x1b, 0x1b, 0x1f], faint: [0x8f, 0x92, 0x99], accent: [0xc2, 0x18, 0x5b], outside: [0xf1, 0xf1, 0xf3],
  // Stable is the paper; hyperbolic, parabolic and coexistence as the program's figures have them.
  kinds: [[255, 255, 255], [0x27, 0x3c, 0x75], [0xd9, 0x5f, 0x02], [0x1b, 0xb0, 0x8a]],
  growth: gradient([0.81, 0.165, 0.225], [0.24, 0.115, -0.21]),
  families: FAMILIES,
});

export const DARK = theme({
  paper: [0x12, 0x13, 0x18], ink: [0xe8, 0xe6, 0xe1], faint: [0x85, 0x88, 0x92], accent: [0xff, 0x7a, 0xa8], outside: [0x1d, 0x1f, 0x26],
  kinds: [[0x12, 0x13, 0x18], [0x8c, 0xab, 0xf2], [0xff, 0x9a, 0x45], [0x3f, 0xd6, 0xac]],
  growth: gradient([0.44, 0.13, -0.21], [0.93, 0.165, 0.275]),
  families: ON_DARK,
});

export const css = ([r, g, b], alpha = 1) => `rgb(${r} ${g} ${b} / ${alpha})`;

/** The place of a in 0, 1, -1, 2, -2, ...: the order of the families' colours. */
export const rank = (a) => (a > 0 ? 2 * a - 1 : -2 * a);

export const family = ({ families }, a) => families[rank(a)] ?? families.at(-1);

/** The decades of growth that the colours span, over the frequency sqrt(lambda1 + lambda2): fixed, so that colours mean the same wherever one goes. */
export const DECADES = [-4.5, 0];

/** The colour of a growth rate. */
export function growth(colours, rate, frequency) {
  const t = (Math.log10(rate / frequency) - DECADES[0]) / (DECADES[1] - DECADES[0]);
  return colours.growth[Math.round(Math.min(1, Math.max(0, t)) * (SHADES - 1))];
}

/** What fills an ImageData, seen as 32-bit words, with the colours of a tile's values: (values, words, size), the lowest row last. */
export function painter(what, colours, frequency) {
  const pack = ([r, g, b]) => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
  const paper = pack(colours.paper);
  if (what === "verdict") {
    return eachUnstable(Uint32Array.from(colours.kinds, pack));
  }
  if (what === "growth") {
    const table = Uint32Array.from(colours.growth.map(pack));
    const [scale, from] = [(SHADES - 1) / (DECADES[1] - DECADES[0]), DECADES[0] + Math.log10(frequency)];
    return eachCell(1, (rate) => (rate > 0 ? table[Math.round(Math.min(SHADES - 1, Math.max(0, (Math.log10(rate) - from) * scale)))] : paper));
  }
  const table = Uint32Array.from(colours.families.map(pack));
  const last = table.length - 1;
  return eachCell(2, (a) => (a === -32768 ? paper : table[Math.min(last, rank(a))]));
}

/** Most cells are stable: four are looked at together, which is as quick before the loop is compiled, when the first picture is drawn. */
const eachUnstable = (table) => (values, words, size) => {
  const fours = new Uint32Array(values.buffer, values.byteOffset, values.length / 4);
  words.fill(table[0]);
  for (let k = 0; k < fours.length; k++) {
    if ((fours[k] & 0x03030303) === 0) continue;
    for (let at = 4 * k; at < 4 * k + 4; at++) words[(size - 1 - Math.floor(at / size)) * size + (at % size)] = table[values[at] & 3];
  }
};

/** `colour` for every cell; neighbours are mostly alike, and so the last one is kept. */
const eachCell = (each, colour) => (values, words, size) => {
  let [before, packed] = [values[0], colour(values[0])];
  for (let j = 0, at = 0; j < size; j++) {
    const row = (size - 1 - j) * size;
    for (let i = 0; i < size; i++, at += each) {
      const value = values[at];
      if (value !== before) packed = colour((before = value));
      words[row + i] = packed;
    }
  }
};
