// Frame, ticks and numbers around the map, as the program's figures draw them.

import { css } from "./colours.js";
import { pointed } from "./exact.js";
import { raised } from "./writing.js";

export const SERIF = '"Libertinus Serif", "Libertinus", Palatino, "Palatino Linotype", Georgia, serif';

/** Numbers longer than this are written as offsets from a round one. */
const LONGEST = 8;

/** The numbers of an axis, and the base that they are offsets from (null: none). */
function numbered({ ticks, power }) {
  const whole = ticks.map(({ count }) => (count === 0n ? "0" : pointed(count, -power)));
  if (whole.every((label) => label.length <= LONGEST)) return { labels: whole, base: null };
  const zeros = (n) => (n === 0n ? 1e9 : n.toString().length - n.toString().replace(/0+$/, "").length);
  const base = ticks.map(({ count }) => count).reduce((best, n) => (zeros(n) > zeros(best) ? n : best));
  const labels = ticks.map(({ count }) => {
    const n = count - base;
    return n === 0n ? "0" : n < 0n ? `−${-n}` : `+${n}`;
  });
  let written = pointed(base, -power);
  if (written.includes(".")) written = written.replace(/0+$/, "").replace(/\.$/, "");
  return { labels, base: written.length <= 16 ? written : `${written.slice(0, 9)}…${written.slice(-4)}`, exact: written };
}

/** Draws pieces of text side by side around x: `i` italic, `_` lowered. */
export function formula(context, pieces, x, y, size) {
  const set = ({ style }) => {
    context.font = `${style === "i" ? "italic " : ""}${style === "_" ? size * 0.72 : size}px ${SERIF}`;
  };
  const widths = pieces.map((piece) => (set(piece), context.measureText(piece.words).width));
  let at = x - widths.reduce((a, b) => a + b, 0) / 2;
  context.textAlign = "left";
  pieces.forEach((piece, k) => {
    set(piece);
    context.fillText(piece.words, at, y + (piece.style === "_" ? size * 0.22 : 0));
    at += widths[k];
  });
}

function title(axis, base, power, unit) {
  const name = [{ style: "i", words: "h" }, { style: "_", words: axis ? "2" : "1" }];
  if (!base) return [...name, { words: ` (${unit})` }];
  return [...name, { words: ` − ${base}  (10${raised(power)} ${unit})` }];
}

/**
 * `box`: the plot's [left, top, width, height]; `lettered`: with numbers and names. Returns what the numbers are offsets from, exactly.
 */
export function drawAxes(context, view, colours, [left, top, width, height], unit, narrow, lettered) {
  const size = narrow ? 13 : 15;
  context.strokeStyle = context.fillStyle = css(colours.ink);
  context.lineWidth = 1;
  context.strokeRect(left - 0.5, top - 0.5, width + 1, height + 1);
  const wanted = [narrow ? 62 : 84, narrow ? 44 : 56];
  return [0, 1].map((axis) => {
    const marks = view.ticks(axis, wanted[axis]);
    const { labels, base, exact } = numbered(marks);
    context.beginPath();
    const stroke = (px, length) => {
      const at = Math.round(px) + 0.5;
      if (axis) context.moveTo(left - 1, top + at), context.lineTo(left - 1 - length, top + at);
      else context.moveTo(left + at, top + height + 1), context.lineTo(left + at, top + height + 1 + length);
    };
    const minor = marks.pitch / marks.parts;
    const extent = axis ? height : width;
    const zero = view.pixel(axis, 0n, 0);
    for (const { px } of [...marks.ticks, { px: marks.ticks.at(-1)?.px + (axis ? -1 : 1) * marks.pitch }, { px: marks.ticks[0]?.px + (axis ? 1 : -1) * marks.pitch }]) {
      for (let k = 1; k < marks.parts; k++) {
        const at = px + (axis ? -1 : 1) * k * minor;
        const positive = axis ? at <= zero + 0.5 : at >= zero - 0.5;
        if (at >= 0 && at <= extent && positive) stroke(at, 3);
      }
    }
    marks.ticks.forEach(({ px }) => stroke(px, 6));
    context.stroke();
    if (!lettered) return exact ?? null;
    context.font = `${size}px ${SERIF}`;
    context.textBaseline = axis ? "middle" : "top";
    context.textAlign = axis ? "right" : "center";
    marks.ticks.forEach(({ px }, k) => {
      if (axis) context.fillText(labels[k], left - 10, top + px + 1);
      else context.fillText(labels[k], left + px, top + height + 10);
    });
    context.textBaseline = "alphabetic";
    const pieces = title(axis, base, marks.power, unit);
    if (axis) {
      context.save();
      context.translate(narrow ? 13 : 18, top + height / 2);
      context.rotate(-Math.PI / 2);
      formula(context, pieces, 0, 0, size + 2);
      context.restore();
    } else formula(context, pieces, left + width / 2, top + height + (narrow ? 39 : 46), size + 2);
    return exact ?? null;
  });
}
