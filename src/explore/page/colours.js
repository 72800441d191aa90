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

/** Lightness, chroma, hue of eight families; on a dark ground they are lifted. */
const FAMILIES = [
  [0.47, 0.16, 0.715], [0.66, 0.17, 0.13], [0.56, 0.12, 0.45], [0.5, 0.19, 0.03],
  [0.72, 0.12, 0.64], [0.78, 0.15, 0.23], [0.4, 0.15, 0.86], [0.6, 0.05, 0.75],
];

const SHADES = 256;
const shades = (scale) => Array.from({ length: SHADES }, (_, k) => scale(k / (SHADES - 1)));

function theme({ paper, ink, faint, accent, outside, kinds, growth, lift, grey, behind }) {
  return {
    paper, ink, faint, accent, outside, behind,
    kinds,
    growth: shades(growth),
    families: FAMILIES.map(([l, c, h]) => fromLch(lift(l), c, h)),
    grey,
  };
}

export const LIGHT = theme({
  paper: [255, 255, 255], ink: [0x1b, 0x1b, 0x1f], faint: [0x8f, 0x92, 0x99], accent: [0xc2, 0x18, 0x5b], outside: [0xf1, 0xf1, 0xf3],
  // Stable is the paper; hyperbolic, parabolic and coexistence as the program's figures have them.
  kinds: [[255, 255, 255], [0x27, 0x3c, 0x75], [0xd9, 0x5f, 0x02], [0x1b, 0xb0, 0x8a]],
  growth: gradient([0.81, 0.165, 0.225], [0.24, 0.115, -0.21]),
  lift: (l) => l, grey: [0x8f, 0x92, 0x99], behind: [0x92, 0xb4, 0xdc],
});

export const DARK = theme({
  paper: [0x12, 0x13, 0x18], ink: [0xe8, 0xe6, 0xe1], faint: [0x85, 0x88, 0x92], accent: [0xff, 0x7a, 0xa8], outside: [0x1d, 0x1f, 0x26],
  kinds: [[0x12, 0x13, 0x18], [0x8c, 0xab, 0xf2], [0xff, 0x9a, 0x45], [0x3f, 0xd6, 0xac]],
  growth: gradient([0.44, 0.13, -0.21], [0.93, 0.165, 0.275]),
  lift: (l) => 0.62 + (l - 0.4) * 0.62, grey: [0x85, 0x88, 0x92], behind: [0x3a, 0x4f, 0x80],
});

export const css = ([r, g, b], alpha = 1) => `rgb(${r} ${g} ${b} / ${alpha})`;

/** The place of a in 0, 1, -1, 2, -2, ...: the order of the families' colours. */
export const rank = (a) => (a > 0 ? 2 * a - 1 : -2 * a);

export const family = (colours, a) => colours.families[rank(a)] ?? colours.grey;

/** The decades of growth that the colours span, over the frequency sqrt(lambda1 + lambda2): fixed, so that colours mean the same wherever one goes. */
export const DECADES = [-4.5, 0];

/** The colour of a growth rate. */
export function growth(colours, rate, frequency) {
  const t = (Math.log10(rate / frequency) - DECADES[0]) / (DECADES[1] - DECADES[0]);
  return colours.growth[Math.round(Math.min(1, Math.max(0, t)) * (SHADES - 1))];
}

/** A function from a cell's value to a colour packed for an ImageData seen as 32-bit words. */
export function painter(what, colours, frequency) {
  const pack = ([r, g, b]) => ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
  if (what === "verdict") {
    const table = Array.from({ length: 8 }, (_, value) => pack(colours.kinds[value & 3]));
    return (value) => table[value & 7];
  }
  const paper = pack(colours.paper);
  if (what === "growth") {
    const table = colours.growth.map(pack);
    const [scale, from] = [(SHADES - 1) / (DECADES[1] - DECADES[0]), DECADES[0] + Math.log10(frequency)];
    return (rate) => (rate > 0 ? table[Math.round(Math.min(SHADES - 1, Math.max(0, (Math.log10(rate) - from) * scale)))] : paper);
  }
  const table = colours.families.map(pack);
  const grey = pack(colours.grey);
  return (a) => (a === -32768 ? paper : (table[rank(a)] ?? grey));
}
