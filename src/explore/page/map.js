// The map: a canvas that draws tiles, lines, marks and axes of one view.

import { drawAxes, SERIF } from "./axes.js";
import { css } from "./colours.js";
import { parse, text } from "./exact.js";
import { layerKey, Tiles } from "./tiles.js";
import { drawLabels, Vectors } from "./vectors.js";
import { SIZE, View } from "./view.js";

/** Rising strokes, a pattern that joins at its edges. */
function hatch(context, { paper, faint }) {
  const side = 8;
  const square = Object.assign(document.createElement("canvas"), { width: side, height: side });
  const pen = square.getContext("2d");
  pen.fillStyle = css(paper);
  pen.fillRect(0, 0, side, side);
  pen.strokeStyle = css(faint, 0.7);
  pen.lineWidth = 1;
  pen.beginPath();
  for (const at of [-side, 0, side]) {
    pen.moveTo(at - 1, side + 1);
    pen.lineTo(at + side + 1, -1);
  }
  pen.stroke();
  return context.createPattern(square, "repeat");
}

export class StabilityMap {
  /** `settings()`: {layer, palette, tongues, maxSum, curves, labels, unit, pin, cut}; `report(status)` after each picture. */
  constructor(canvas, questions, step, settings, report) {
    Object.assign(this, { canvas, settings, report, frames: 0, cursor: null, stale: null, drawn: null });
    this.context = canvas.getContext("2d", { alpha: false });
    this.view = new View(step);
    this.tiles = new Tiles(questions, () => this.redraw());
    this.vectors = new Vectors(questions, () => this.redraw());
    this.tiles.failed = (error) => (this.fault = error.message);
    this.box = [0, 0, 1, 1];
  }

  /** Draws before the next frame is shown. */
  redraw() {
    if (this.due || this.idle) return;
    this.due = requestAnimationFrame(() => this.#now());
  }

  #now() {
    cancelAnimationFrame(this.due);
    this.due = null;
    this.paint();
  }

  /** Asks for the tiles that the screen shows, before there is a picture. */
  ask() {
    this.tiles.want(this.settings().layer, this.view.tiles(this.view.level));
  }

  /** The plot's box within an element of this size. Is the picture lost? Another size makes a canvas black. */
  resize(width, height) {
    const [left, bottom, top, right] = this.narrow ? [56, 48, 10, 12] : [74, 58, 12, 16];
    const ratio = window.devicePixelRatio || 1;
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    const lost = this.canvas.width !== w || this.canvas.height !== h;
    if (lost) Object.assign(this.canvas, { width: w, height: h });
    this.ratio = ratio;
    this.box = [left, top, Math.max(20, Math.round(width) - left - right), Math.max(20, Math.round(height) - top - bottom)];
    this.view.resize(this.box[2], this.box[3]);
    this.redraw();
    return lost;
  }

  /** Draws in the frame that is under way, where there was a picture: nobody sees it black. */
  repaint() {
    if (this.frames && !this.idle) this.#now();
  }

  get narrow() {
    return this.canvas.clientWidth < 520;
  }

  paint() {
    const { context, view, box, ratio } = this;
    const [left, top, width, height] = box;
    const now = this.settings();
    const { palette } = now;
    this.frames += 1;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = css(palette.outside);
    context.fillStyle = palette.page ?? css(palette.paper);
    context.fillRect(0, 0, this.canvas.width, this.canvas.height);
    context.save();
    context.beginPath();
    context.rect(left, top, width, height);
    context.clip();
    context.fillStyle = css(palette.paper);
    context.fillRect(left, top, width, height);
    context.translate(left, top);
    this.pale = null;
    const status = this.#cells(now);
    status.pale = this.pale;
    this.#mark(status);
    this.#lines(now, status);
    this.#outside(palette);
    this.#marks(now);
    context.restore();
    status.offsets = drawAxes(context, view, palette, box, now.unit, this.narrow, this.lettered);
    this.report({ ...status, level: view.level, sum: this.vectors.shownSum(this.view), refused: this.vectors.refused });
  }

  /** For whoever traces the page: the first picture with a cell, and the first with all. */
  #mark({ cells, waiting }) {
    for (const [name, holds] of [["first cells", cells], ["all cells", cells && !waiting]]) {
      if (holds && performance.getEntriesByName(name).length === 0) performance.mark(name);
    }
  }

  /** Draws what is here of the tiles, and asks for what is not. */
  #cells(now) {
    const { view, tiles } = this;
    const { level } = view;
    const shown = view.tiles(level);
    const costs = shown.map((place) => tiles.cost(now.layer, place));
    const here = shown.map((place) => tiles.get(now.layer, place));
    const lacking = here.filter((tile) => !tile).length;
    const costly = costs.find(Boolean) ?? null;
    const key = layerKey(now.layer);
    here.forEach((tile, k) => tile || this.#pending(view.tileBox(shown[k]), now.palette));
    // Tiles of another step have other places.
    const { stale } = this;
    if (lacking && stale && stale.key !== key && stale.layer.step === now.layer.step) this.#under(stale.layer, now.palette, false);
    else if (!lacking) this.stale = { key, layer: now.layer };
    // Where cells would cost too much, coarser ones would be taken for them: they stay, but pale.
    if (lacking) this.#under(now.layer, now.palette, costly !== null);
    here.forEach((tile) => tile && this.#tile(tile, now.layer, now.palette));
    const coarser = costly ? this.#affordable(now.layer) : [];
    const ring = lacking === 0 && !this.moving && tiles.quick ? view.tiles(level, 1) : [];
    tiles.want(now.layer, lacking ? [...shown, ...coarser] : ring);
    // The first picture; where tiles come quickly, with room for a frame that grows a little.
    this.whole ||= Boolean(this.lettered) && lacking === 0 && (tiles.idle || !tiles.quick);
    this.bare = here.map((tile, k) => (tile ? null : view.tileBox(shown[k]))).filter(Boolean);
    // Of so many cells along an axis, as a power of two, one is decided.
    const thin = Math.max(0, ...here.map((tile) => (tile ? Math.log2(SIZE / tile.size) : 0)));
    return { costly, thin, whole: this.whole, cells: lacking < shown.length, waiting: lacking > costs.filter(Boolean).length, fault: lacking ? this.fault : null };
  }

  /** The tiles of the finest level at most four above that no refusal is known of: pale, they show where one is. */
  #affordable(layer) {
    for (let level = this.view.level - 1; level >= this.view.level - 4; level--) {
      const places = this.view.tiles(level);
      if (!places.some((place) => this.tiles.cost(layer, place))) return places;
    }
    return [];
  }

  /** Is a pixel in none of the tiles that are here? */
  #isBare([x, y]) {
    return this.bare.some(([l, t, r, b]) => x >= l && x < r && y >= t && y < b);
  }

  /** Hatched: no verdict is here, where the colour of paper would say that all is stable. */
  #pending([left, top, right, bottom], palette) {
    const { context } = this;
    if (this.hatched !== palette) Object.assign(this, { hatched: palette, hatch: hatch(context, palette) });
    context.fillStyle = this.hatch;
    context.fillRect(left, top, right - left, bottom - top);
  }

  /** Tiles of neighbouring levels, while those of this one are on their way. */
  #under(layer, palette, pale) {
    const { context, view, tiles } = this;
    context.globalAlpha = pale ? 0.3 : 1;
    const isOther = layerKey(layer) !== layerKey(this.settings().layer);
    const around = tiles.around(layer, view, view.level, pale ? 4 : 6, isOther);
    for (const tile of around) this.#tile(tile, layer, palette);
    if (pale) this.pale = around.length ? around.at(-1).place.level : null;
    context.globalAlpha = 1;
  }

  #tile(tile, layer, palette) {
    const { context, ratio, box } = this;
    const picture = this.tiles.picture(tile, layer, palette);
    // Edges on whole pixels of the screen: neighbours meet without a seam.
    const [l, t, r, b] = this.view.tileBox(tile.place, layer.stretch).map((px, k) => {
      const origin = box[k % 2];
      return Math.round((px + origin) * ratio) / ratio - origin;
    });
    const scale = ((r - l) * ratio) / picture.width;
    const whole = Math.abs(scale - Math.round(scale)) < 1e-3;
    context.imageSmoothingEnabled = !whole && scale < 3;
    context.imageSmoothingQuality = scale < 1 ? "medium" : "low";
    context.drawImage(picture, l, t, r - l, b - t);
  }

  #lines(now, status) {
    const { context, view, vectors } = this;
    const byCost = status.costly !== null && now.tongues !== "off";
    const shown = byCost || now.tongues === "on";
    const tongues = shown ? { maxSum: byCost ? null : now.maxSum, minWidth: byCost ? text(view.coordinate(1n, 0)) : null } : null;
    if (!this.moving || !vectors.tongues) vectors.update(view, now.layer, { tongues, curves: now.curves });
    const labels = [];
    if (now.curves) labels.push(...vectors.drawCurves(context, view, now.palette));
    if (shown) {
      const style = { over: !byCost && now.layer.what !== "family", byFamily: now.layer.what === "family" };
      context.save();
      if (byCost) this.#clip();
      const found = vectors.drawTongues(context, view, now.palette, style);
      context.restore();
      labels.unshift(...(byCost ? found.filter(({ spots }) => this.#isBare(spots[0])) : found));
    }
    if (now.labels && this.lettered) drawLabels(context, labels, now.palette, `14px ${SERIF}`, view);
    Object.assign(status, { vectors: shown, asked: now.maxSum });
  }

  /** Lines that stand for cells are drawn where there are none. */
  #clip() {
    const { context } = this;
    context.beginPath();
    for (const [l, t, r, b] of this.bare) context.rect(l, t, r - l, b - t);
    context.clip();
  }

  /** Steps are positive: what lies below zero is no part of the map. */
  #outside(palette) {
    const { context, view } = this;
    const [x, y] = [view.pixel(0, 0n, 0), view.pixel(1, 0n, 0)];
    context.fillStyle = css(palette.outside);
    if (x > 0) context.fillRect(0, 0, x, view.height);
    if (y < view.height) context.fillRect(0, y, view.width, view.height - y);
  }

  /** The cut, the pinned pair, the cell below the pointer. */
  #marks(now) {
    const { context, view } = this;
    const { accent, ink, paper } = now.palette;
    const line = this.draft ?? (now.cut && this.cutLine(now.cut));
    if (line) {
      for (const [colour, wide] of [[css(paper, 0.8), 5], [css(accent), 2]]) {
        context.strokeStyle = colour;
        context.lineWidth = wide;
        context.beginPath();
        context.moveTo(line[0], line[1]);
        context.lineTo(line[2], line[3]);
        context.stroke();
      }
      if (this.probe !== undefined && this.probe !== null) {
        this.#dot(line[0] + this.probe * (line[2] - line[0]), line[1] + this.probe * (line[3] - line[1]), accent, paper, 4.5);
      }
    }
    if (this.framed) {
      const [x0, y0, x1, y1] = this.framed;
      context.fillStyle = css(accent, 0.12);
      context.fillRect(x0, y0, x1 - x0, y1 - y0);
      context.strokeStyle = css(accent);
      context.lineWidth = 1.5;
      context.strokeRect(x0, y0, x1 - x0, y1 - y0);
    }
    if (now.pin) {
      const [x, y] = now.pin.map((value, axis) => view.place(axis, value));
      this.#dot(x, y, accent, paper, 5.5);
    }
    if (this.cursor) {
      const [x, y] = this.cursor;
      context.lineWidth = 1;
      context.strokeStyle = css(ink, 0.55);
      context.beginPath();
      for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        context.moveTo(x + 5 * dx, y + 5 * dy);
        context.lineTo(x + 13 * dx, y + 13 * dy);
      }
      context.stroke();
    }
  }

  #dot(x, y, fill, edge, radius) {
    const { context } = this;
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fillStyle = css(fill);
    context.fill();
    context.lineWidth = 2;
    context.strokeStyle = css(edge);
    context.stroke();
  }

  /** A cut as pixels from its `lo` to its `hi`. */
  cutLine({ kind, value, lo, hi }) {
    const [fixed, from, to] = [value, lo, hi].map(parse);
    if (!fixed || !from || !to) return null;
    const at = (axis, x) => this.view.place(axis, x);
    if (kind === "h1") return [at(0, fixed), at(1, from), at(0, fixed), at(1, to)];
    if (kind === "h2") return [at(0, from), at(1, fixed), at(0, to), at(1, fixed)];
    const times = (x) => [x[0] * fixed[0], x[1] * fixed[1]];
    return [at(0, from), at(1, times(from)), at(0, to), at(1, times(to))];
  }
}
