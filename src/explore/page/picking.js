// From a pixel to an exact pair, and from a stroke to an exact cut.

import { compare, divide, multiply, parse, powerOfTwo, rational, simplest, text } from "./exact.js";

const bitsOf = (x) => Math.ceil(Math.log2(Number(x) + 1));

/** A pair on the ray of a tongue, both steps dyadic multiples of d, well inside the part of the tongue that is drawn. */
function onTongue(view, { segment, x0, y0, x1, y1, t, ends = segment.ends }) {
  const [p, q] = [BigInt(segment.p), BigInt(segment.q)];
  const inside = Math.min(ends[1] ? 0.88 : 1, Math.max(ends[0] ? 0.12 : 0, t));
  const [width, height] = [Math.abs(x1 - x0), Math.abs(y1 - y0)];
  // Fine enough to stay inside the tongue, and on the pixel.
  const level = view.level + 3 + bitsOf(p > q ? p : q) + Math.max(0, Math.ceil(Math.log2(16 / Math.max(width, height, 1e-9))));
  const axis = height > width ? 1 : 0;
  const cell = axis ? view.cell(y0 + inside * (y1 - y0), 1, level) : view.cell(x0 + inside * (x1 - x0), 0, level);
  const along = multiply([cell, 1n], axis ? powerOfTwo(view.stretch) : [1n, 1n]);
  const [n, d] = along;
  const share = (n * 2n) / (d * (axis ? p : q)) + 1n;
  const time = multiply(multiply([share / 2n, 1n], powerOfTwo(-level)), view.step);
  return [multiply(time, [q, 1n]), multiply(time, [p, 1n])];
}

/** The pair below a pixel: {pair, cells, line}; on a tongue that is drawn within `reach`, a pair on its ray. */
export function pick(map, [x, y], reach, withTongues) {
  const { view, vectors } = map;
  if (x < 0 || y < 0 || x > view.width || y > view.height) return null;
  const line = withTongues ? vectors.nearest(view, x, y, reach) : null;
  if (line) {
    const pair = onTongue(view, line);
    if (pair.every(([n]) => n > 0n)) return { pair, cells: null, line };
  }
  const pair = view.pair(x, y);
  return pair && { pair, cells: [view.cell(x, 0), view.cell(y, 1)], line: null };
}

const ordered = (a, b) => (compare(a, b) <= 0 ? [a, b] : [b, a]);

/** The simplest ratio of steps whose ray passes within three pixels of a pixel. */
function ratioNear(view, [x, y]) {
  const at = (py) => view.pair(x, py);
  const [lower, upper] = [at(y + 3), at(y - 3)];
  if (!lower || !upper) return null;
  const [lo, hi] = [lower, upper].map(([h1, h2]) => divide(h2, h1));
  return compare(lo, hi) < 0 ? simplest(lo, hi) : null;
}

/** The cut that a stroke from one pixel to another means: {kind, value, lo, hi} as texts; null if it is none. */
export function cutOf(map, kind, from, to) {
  const { view } = map;
  const [a, b] = [from, to].map(([x, y]) => view.pair(Math.min(view.width, Math.max(0, x)), Math.min(view.height, Math.max(0, y))));
  if (!a || !b) return null;
  let [value, ends] = [null, null];
  if (kind === "h1") [value, ends] = [a[0], ordered(a[1], b[1])];
  else if (kind === "h2") [value, ends] = [a[1], ordered(a[0], b[0])];
  else {
    value = ratioNear(view, from);
    if (!value) return null;
    const steep = Math.abs(to[1] - from[1]) > Math.abs(to[0] - from[0]);
    ends = steep ? ordered(divide(a[1], value), divide(b[1], value)) : ordered(a[0], b[0]);
  }
  if (compare(...ends) === 0) return null;
  return { kind, value: text(value), lo: text(ends[0]), hi: text(ends[1]) };
}

/** The cut through a pair from edge to edge of the screen. */
export function cutThrough(map, kind, [h1, h2]) {
  const [w1, w2] = map.view.window();
  if (kind === "h1") return { kind, value: text(h1), lo: text(w2.lo), hi: text(w2.hi) };
  if (kind === "h2") return { kind, value: text(h2), lo: text(w1.lo), hi: text(w1.hi) };
  const value = divide(h2, h1);
  const [lo, hi] = [divide(w2.lo, value), divide(w2.hi, value)];
  const later = (a, b) => (compare(a, b) < 0 ? b : a);
  const sooner = (a, b) => (compare(a, b) < 0 ? a : b);
  return { kind, value: text(value), lo: text(later(lo, w1.lo)), hi: text(sooner(hi, w1.hi)) };
}

/** A typed pair as exact rationals, or null. */
export function typed(first, second) {
  const pair = [parse(first), parse(second)];
  return pair.every((x) => x && x[0] > 0n) ? pair.map(([n, d]) => rational(n, d)) : null;
}
