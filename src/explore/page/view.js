// Where the map stands: exact dyadic coordinates without a bottom.
//
// Along h1 the unit is the step d, along h2 it is d * 2^stretch; a coordinate is an integer over 2^bits of that unit.
// At zoom z a unit is 2^z pixels wide, and the level floor(z) has cells of 1 to 2 pixels.

import { log10, multiply, powerOfTwo, rational, subtract, toNumber } from "./exact.js";

/** Bits below a pixel: a drag by a fraction of one is not lost. */
const SPARE = 40;
/** Cells along the side of a tile. */
export const SIZE = 256;
/** The coarsest level: cells of 2^10 steps. */
export const COARSEST = -10;

const big = (x) => BigInt(Math.round(x));
const shifted = (n, by) => (by >= 0 ? n << BigInt(by) : n >> BigInt(-by));

export class View {
  constructor(step) {
    this.step = step;
    this.stretch = 0;
    this.zoom = 0;
    this.bits = SPARE;
    this.centre = [0n, 0n];
    this.width = this.height = 1;
  }

  /** The level whose cells are 1 to 2 pixels wide. */
  get level() {
    return Math.max(COARSEST, Math.floor(this.zoom + 1e-9));
  }

  /** The unit of an axis, exactly. */
  unit(axis) {
    return axis ? multiply(this.step, powerOfTwo(this.stretch)) : this.step;
  }

  /** So many pixels in units of the coordinates' last bit, to the precision of a double. */
  #span(pixels) {
    const power = this.bits - this.zoom;
    // No double holds 2^1024: what is beyond 60 bits is shifted.
    const shift = Math.max(0, Math.floor(power) - 60);
    return big(pixels * 2 ** (power - shift)) << BigInt(shift);
  }

  #ensure(bits) {
    if (this.bits >= bits) return;
    this.centre = this.centre.map((c) => c << BigInt(bits - this.bits));
    this.bits = bits;
  }

  /** Drops the bits that no pixel shows, so that addresses stay short. */
  #trim() {
    const bits = Math.max(SPARE, Math.ceil(this.zoom) + SPARE);
    if (this.bits <= bits) return;
    this.centre = this.centre.map((c) => c >> BigInt(this.bits - bits));
    this.bits = bits;
  }

  resize(width, height) {
    this.width = Math.max(1, width);
    this.height = Math.max(1, height);
  }

  /** Moves the picture by pixels, to the right and down. */
  pan(dx, dy) {
    this.#trim();
    this.centre[0] -= this.#span(dx);
    this.centre[1] += this.#span(dy);
    this.#stay();
  }

  /** Zooms to `zoom`; the point of the plane below the pixel stays there. */
  zoomTo(zoom, x = this.width / 2, y = this.height / 2) {
    const next = Math.max(COARSEST, zoom);
    this.#ensure(Math.ceil(Math.max(next, this.zoom)) + SPARE);
    const away = [x - this.width / 2, this.height / 2 - y];
    const before = away.map((px) => this.#span(px));
    this.zoom = next;
    this.centre = this.centre.map((c, axis) => c + before[axis] - this.#span(away[axis]));
    this.#stay();
  }

  /** The centre stays among positive steps. */
  #stay() {
    this.centre = this.centre.map((c) => (c < 0n ? 0n : c));
  }

  /** Centres on a pair of exact rationals, to as many bits as `depth` further levels need. */
  centreOn(pair, depth = 0) {
    this.bits = Math.max(SPARE, Math.ceil(this.zoom) + SPARE) + depth;
    this.centre = [0, 1].map((axis) => {
      const [n, d] = pair[axis];
      const [a, b] = this.unit(axis);
      const twice = (((n * b) << BigInt(this.bits + 1)) / (d * a));
      return (twice + 1n) >> 1n;
    });
  }

  /** Changes the scale of h2 against that of h1; the centre stays. */
  restretch(stretch) {
    const by = stretch - this.stretch;
    if (by > 0) this.#ensure(this.bits + by);
    this.centre[1] = shifted(this.centre[1], -by);
    this.stretch = stretch;
  }

  /** Shows a window of doubles [h1 lo, h1 hi, h2 lo, h2 hi] as a whole. */
  fit([a, b, c, d], stretch) {
    const wide = (b - a) / toNumber(this.step), high = (d - c) / toNumber(this.step);
    this.stretch = stretch ?? Math.max(-8, Math.min(8, Math.round(Math.log2((high / this.height) / (wide / this.width)))));
    const fitting = Math.min(this.width / wide, this.height / (high / 2 ** this.stretch));
    this.zoom = Math.max(COARSEST, Math.log2(fitting));
    this.bits = SPARE + Math.ceil(Math.max(0, this.zoom));
    // What is left over lies to the right and above: the lower left corner is the window's.
    const half = [this.width / 2, this.height / 2].map((px) => px / 2 ** this.zoom);
    this.centre = [a, c].map((x, axis) => big((x / toNumber(this.unit(axis)) + half[axis]) * 2 ** this.bits));
  }

  /** The pixel of a coordinate given as an integer over 2^bits of the axis's unit. */
  pixel(axis, n, bits) {
    const common = Math.max(bits, this.bits);
    const off = shifted(n, common - bits) - shifted(this.centre[axis], common - this.bits);
    // Cut to 900 bits: farther off is off the screen all the same.
    const long = Math.max(0, off.toString(16).length * 4 - 900);
    const pixels = Number(shifted(off, -long)) * 2 ** (this.zoom - common + long);
    return axis ? this.height / 2 - pixels : this.width / 2 + pixels;
  }

  /** The pixel rectangle of a tile, of this or another stretch: [left, top, right, bottom]. */
  tileBox({ level, x, y }, stretch = this.stretch) {
    const edge = (axis, tile) => this.pixel(axis, tile * BigInt(2 * SIZE) + 1n, level + 1 + (axis ? this.stretch - stretch : 0));
    return [edge(0, x), edge(1, y + 1n), edge(0, x + 1n), edge(1, y)];
  }

  /** The tiles of a level that the screen shows, widened by `margin` tiles; those nearest to the centre first. */
  tiles(level, margin = 0) {
    const at = (axis, px) => shifted(2n * this.cell(px, axis, level) - 1n, -1 - Math.log2(SIZE));
    const m = BigInt(margin);
    const [left, right] = [at(0, 0) - m, at(0, this.width) + m];
    const [low, high] = [at(1, this.height) - m, at(1, 0) + m];
    const found = [];
    for (let x = left < 0n ? 0n : left; x <= right; x++) {
      for (let y = low < 0n ? 0n : low; y <= high; y++) found.push({ level, x, y });
    }
    const far = (tile) => {
      const [l, t, r, b] = this.tileBox(tile);
      return Math.hypot((l + r) / 2 - this.width / 2, (t + b) / 2 - this.height / 2);
    };
    return found.map((tile) => [far(tile), tile]).sort((a, b) => a[0] - b[0]).map(([, tile]) => tile);
  }

  /** The number of the cell of a level below a pixel of an axis: the coordinate is cell / 2^level units. */
  cell(px, axis, level = this.level) {
    const at = this.centre[axis] + this.#span(axis ? this.height / 2 - px : px - this.width / 2);
    const bits = this.bits - level;
    return bits > 0 ? (at + (1n << BigInt(bits - 1))) >> BigInt(bits) : at << BigInt(-bits);
  }

  /** The exact step of a cell. */
  coordinate(cell, axis, level = this.level) {
    return multiply(multiply([cell, 1n], powerOfTwo(-level)), this.unit(axis));
  }

  /** The exact pair of the cell below a pixel; null outside the positive steps. */
  pair(x, y) {
    const cells = [this.cell(x, 0), this.cell(y, 1)];
    return cells.some((n) => n < 1n) ? null : cells.map((n, axis) => this.coordinate(n, axis));
  }

  /** The pixel of an exact rational. */
  place(axis, [n, d]) {
    const [a, b] = this.unit(axis);
    const bits = this.bits + 20;
    return this.pixel(axis, ((n * b) << BigInt(bits)) / (d * a), bits);
  }

  /** What is on the screen as whole cells, from edge to edge: exact `lo`, `hi` for each axis, positive. */
  window() {
    const level = this.level + 3;
    const range = (axis, from, to) => {
      const [lo, hi] = [this.cell(from, axis, level), this.cell(to, axis, level)];
      const first = lo < 1n ? 1n : lo;
      const last = hi <= first ? first + 1n : hi;
      return { lo: this.coordinate(first, axis, level), hi: this.coordinate(last, axis, level) };
    };
    return [range(0, 0, this.width), range(1, this.height, 0)];
  }

  /** log10 of the width of a pixel along an axis, in units of time. */
  logPixel(axis) {
    return log10(this.unit(axis)) - this.zoom * Math.log10(2);
  }

  /** The exact value at the centre. */
  middle(axis) {
    return multiply(rational(this.centre[axis], 1n << BigInt(this.bits)), this.unit(axis));
  }

  /** Ticks at round decimals, `wanted` pixels apart or a little more: the count of units 10^power of each, and its pixel. */
  ticks(axis, wanted) {
    const length = axis ? this.height : this.width;
    const target = this.logPixel(axis) + Math.log10(wanted);
    let power = Math.floor(target) - 1;
    let digit = 1;
    search: for (; ; power++) {
      for (digit of [1, 2, 5]) if (Math.log10(digit) + power >= target - 1e-9) break search;
    }
    const pitch = 10 ** (Math.log10(digit) + power - this.logPixel(axis));
    const tick = power >= 0 ? [BigInt(digit) * 10n ** BigInt(power), 1n] : rational(BigInt(digit), 10n ** BigInt(-power));
    const middle = this.middle(axis);
    const nearest = (middle[0] * tick[1]) / (middle[1] * tick[0]);
    const rest = subtract(middle, multiply([nearest, 1n], tick));
    const offset = rest[0] === 0n ? 0 : toNumber(rest) === 0 ? 0 : 10 ** (log10(rest) - this.logPixel(axis));
    const found = [];
    const reach = Math.ceil(length / pitch) + 1;
    for (let k = -reach; k <= reach; k++) {
      const px = axis ? length / 2 + offset - k * pitch : length / 2 - offset + k * pitch;
      const count = (nearest + BigInt(k)) * BigInt(digit);
      if (px >= -0.5 && px <= length + 0.5 && count >= 0n) found.push({ px, count });
    }
    return { ticks: axis ? found.reverse() : found, power, pitch, parts: digit === 2 ? 4 : 5, reversed: axis === 1 };
  }

  /** For the address: exact, and as short as the centre allows. */
  save() {
    let { bits } = this;
    let [x, y] = this.centre;
    while (bits > 0 && !((x | y) & 1n)) [x, y, bits] = [x >> 1n, y >> 1n, bits - 1];
    return `${x},${y},${bits},${this.zoom},${this.stretch}`;
  }

  /** Takes what `save` gave; false where the text is not of that form. */
  restore(saved) {
    const match = /^(\d{1,4000}),(\d{1,4000}),(\d{1,5}),(-?[\d.]+(?:e-?\d+)?),(-?\d{1,2})$/.exec(saved ?? "");
    if (!match) return false;
    const [x, y, bits, zoom, stretch] = match.slice(1);
    this.centre = [BigInt(x), BigInt(y)];
    this.bits = Number(bits);
    this.zoom = Math.max(COARSEST, Number(zoom));
    this.stretch = Math.max(-12, Math.min(12, Number(stretch)));
    this.#ensure(Math.max(0, Math.ceil(this.zoom)) + SPARE);
    return true;
  }
}
