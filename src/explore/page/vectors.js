// What is drawn as lines over the map: certified tongues, curves (a, b), their labels.
//
// The server gives lines in fractions of a window that it knows exactly, so that they are right at any depth.

import { latest } from "./ask.js";
import { css, family } from "./colours.js";
import { text } from "./exact.js";

const DASHES = [[], [1.5, 3], [7, 4], []];

/** Lines with the exact window that they are fractions of. */
class Sheet {
  constructor(key, window, data) {
    Object.assign(this, { key, window, data });
  }

  /** The pixels of the window's corner and its size in pixels, upward. */
  frame(view) {
    const at = (axis, side) => view.place(axis, this.window[axis][side]);
    const [x, y] = [at(0, "lo"), at(1, "lo")];
    return { x, y, width: at(0, "hi") - x, height: y - at(1, "hi") };
  }

  /** Does it still cover the screen, with as much detail as was asked for? */
  serves(key, view) {
    if (this.key !== key) return false;
    const { x, y, width, height } = this.frame(view);
    const covers = (from, length, screen) => {
      const slack = length / 2 + 1;
      return from - slack <= 0 && from + length + slack >= screen && length <= 2.5 * screen && length >= 0.4 * screen;
    };
    return covers(x, width, view.width) && covers(y - height, height, view.height);
  }
}

const range = ({ lo, hi }) => `${text(lo)}..${text(hi)}`;

export class Vectors {
  constructor(questions, changed) {
    Object.assign(this, { changed, tongues: null, curves: null, refused: null });
    this.askTongues = latest(async (key, window, params, signal) => {
      const data = await questions.json("tongues", params, signal);
      this.tongues = new Sheet(key, window, data);
      this.refused = null;
      changed();
    }, 60);
    this.askCurves = latest(async (key, window, params, signal) => {
      this.curves = new Sheet(key, window, await questions.json("curves", params, signal));
      changed();
    }, 60);
    this.asked = { tongues: null, curves: null };
  }

  /** Asks for what the screen lacks. `tongues`: null, or {maxSum}; `curves`: bool. */
  update(view, { lambda1, lambda2 }, { tongues, curves }) {
    const window = view.window();
    const where = { lambda1, lambda2, h1: range(window[0]), h2: range(window[1]) };
    const once = (kind, key, send) => {
      if (this[kind]?.serves(key, view)) return;
      const id = `${key}|${where.h1}|${where.h2}`;
      if (this.asked[kind] === id) return;
      this.asked[kind] = id;
      send(key).catch((error) => {
        this.refused = error.message;
        this.changed();
      });
    };
    if (tongues) {
      const extra = tongues.maxSum ? { max_sum: tongues.maxSum } : { min_width: tongues.minWidth };
      once("tongues", (this.wanted = `${lambda1}|${lambda2}|${tongues.maxSum ?? ""}`), (key) => this.askTongues(key, window, { ...where, ...extra }));
    }
    if (curves) once("curves", lambda1, (key) => this.askCurves(key, window, { ...where, a: "0..3", b: "-12..12" }));
  }

  /** Up to which p + q the screen shows every tongue; undefined while it does not yet. */
  shownSum(view) {
    return this.tongues?.serves(this.wanted, view) ? this.tongues.data.max_sum : undefined;
  }

  /** Tongues on the screen as pixel lines: {segment, x0, y0, x1, y1}. */
  lines(view) {
    if (!this.tongues) return [];
    const { x, y, width, height } = this.tongues.frame(view);
    return this.tongues.data.segments.map((segment) => {
      const [u0, v0, u1, v1] = segment.line;
      return { segment, x0: x + u0 * width, y0: y - v0 * height, x1: x + u1 * width, y1: y - v1 * height };
    });
  }

  /** The line nearest to a pixel, no farther than `reach`. */
  nearest(view, px, py, reach) {
    let best = null;
    for (const line of this.lines(view)) {
      const [dx, dy] = [line.x1 - line.x0, line.y1 - line.y0];
      const t = Math.min(1, Math.max(0, ((px - line.x0) * dx + (py - line.y0) * dy) / (dx * dx + dy * dy || 1)));
      const far = Math.hypot(line.x0 + t * dx - px, line.y0 + t * dy - py);
      if (far <= (best?.far ?? reach)) best = { ...line, far, t };
    }
    return best;
  }

  drawCurves(context, view, colours) {
    if (!this.curves) return [];
    const { x, y, width, height } = this.curves.frame(view);
    const labels = [];
    context.strokeStyle = css(colours.faint);
    for (const { a, b, lines } of this.curves.data.curves) {
      context.lineWidth = a === 0 ? 2.4 : 1;
      context.setLineDash(DASHES[Math.abs(a)] ?? []);
      context.beginPath();
      for (const line of lines) {
        for (let k = 0; k < line.length; k += 2) {
          const point = [x + line[k] * width, y - line[k + 1] * height];
          if (k) context.lineTo(...point);
          else context.moveTo(...point);
        }
        labels.push({ words: `(${a}, ${b})`.replace(/-/g, "−"), spots: spots(line, x, y, width, height, view) });
      }
      context.stroke();
    }
    context.setLineDash([]);
    return labels;
  }

  /** `over`: whether cells lie below; `byFamily`: each family in its colour. */
  drawTongues(context, view, colours, { over, byFamily }) {
    const labels = [];
    const plain = over ? colours.accent : colours.kinds[1];
    context.lineCap = "round";
    const lines = this.lines(view);
    // Where lines are many, marks at their ends would be all that one sees.
    const crowded = lines.length > 120;
    for (const { segment, x0, y0, x1, y1 } of lines) {
      if (Math.max(x0, x1) < -4 || Math.min(x0, x1) > view.width + 4 || Math.max(y0, y1) < -4 || Math.min(y0, y1) > view.height + 4) continue;
      const colour = css(byFamily ? family(colours, segment.a) : plain);
      const length = Math.hypot(x1 - x0, y1 - y0);
      context.strokeStyle = context.fillStyle = colour;
      context.lineWidth = crowded ? 1.2 : length > 24 ? 2 : 1.6;
      context.beginPath();
      context.moveTo(x0, y0);
      // A tongue shorter than a pixel is a point that can still be seen.
      context.lineTo(length < 1 ? x0 + 1 : x1, y1);
      context.stroke();
      if (length > 24 && !crowded) ends(context, segment.ends, [x0, y0], [x1, y1]);
      const [left, right, top, bottom] = [Math.max(0, Math.min(x0, x1)), Math.min(view.width, Math.max(x0, x1)), Math.max(0, Math.min(y0, y1)), Math.min(view.height, Math.max(y0, y1))];
      if (length > 30) labels.push({ words: `${segment.ratio ?? `${segment.p}/${segment.q}`}, m = ${segment.m}`, spots: [[(left + right) / 2 + 8, (top + bottom) / 2 + 17]], weight: length });
    }
    context.lineCap = "butt";
    return labels.sort((a, b) => b.weight - a.weight);
  }
}

/** The certified edges as dots; where a line is cut off by the window there is none. */
function ends(context, [first, last], from, to) {
  for (const [shown, [x, y]] of [[first, from], [last, to]]) {
    if (!shown) continue;
    context.beginPath();
    context.arc(x, y, 2.6, 0, 2 * Math.PI);
    context.fill();
  }
}

/** Where a label may stand along a curve: a few points well inside the screen. */
function spots(line, x, y, width, height, view) {
  const found = [];
  for (let k = 0; k < line.length; k += 2) {
    const [px, py] = [x + line[k] * width, y - line[k + 1] * height];
    if (px > 30 && px < view.width - 40 && py > 20 && py < view.height - 12) found.push([px + 5, py - 5]);
  }
  return [0.25, 0.5, 0.75, 0.1].map((t) => found[Math.floor(t * (found.length - 1))]).filter(Boolean);
}

/** Writes labels where they cover no other. */
export function drawLabels(context, labels, colours, font, { width: across, height: down }) {
  const taken = [];
  context.font = font;
  context.textBaseline = "alphabetic";
  context.textAlign = "left";
  context.lineJoin = "round";
  for (const { words, spots: places } of labels.slice(0, 400)) {
    if (taken.length >= (across * down) / 9000) break;
    const width = context.measureText(words).width;
    const inside = ([x, y]) => x > 3 && x + width < across - 3 && y > 14 && y < down - 4;
    const free = places.filter(inside).find(([x, y]) => !taken.some((t) => x < t.x + t.width + 6 && x + width + 6 > t.x && Math.abs(y - t.y) < 17));
    if (!free) continue;
    const [x, y] = free;
    taken.push({ x, y, width });
    context.strokeStyle = css(colours.paper, 0.85);
    context.lineWidth = 4;
    context.strokeText(words, x, y);
    context.fillStyle = css(colours.ink);
    context.fillText(words, x, y);
  }
}
