// The grid that is shown in words, or what is shown instead of it.

import { grouped, number, spacing } from "./writing.js";

/** Sentences on a picture's status; names of quantities are set by `formulas` in dom.js. */
export function told(status, view) {
  const [d1, d2] = [0, 1].map((axis) => spacing(view.unit(axis), status.level - (status.thin ?? 0)));
  const { costly, vectors, sum, asked, pale, refused, fault } = status;
  const said = [];
  if (!costly || status.cells) said.push(`Every cell is one exact verdict: multiples of d₁\u00a0=\u00a0${d1} and d₂\u00a0=\u00a0${d2}.`);
  if (costly) {
    said.push(tooMuch(costly, d1, status.cells));
    if (!vectors) said.push("Tongues as lines are switched off.");
    else if (sum) said.push(`Shown instead: certified tongues wider than a cell, all ratios with p + q ≤ ${grouped(sum)}.`);
    else said.push("Asking for certified tongues instead …");
    if (pale !== null) said.push(`Pale: verdicts on a coarser grid, d₁\u00a0=\u00a0${spacing(view.unit(0), pale)}.`);
  } else if (vectors && sum) said.push(`Lines: tongues with p + q ≤ ${sum}${sum < asked ? `; up to ${asked} they would be too many to draw` : ""}.`);
  if (refused && vectors) said.push(refused);
  if (fault) said.push(fault);
  return said.join(" ");
}

function tooMuch({ cost, limit, unit, words }, d1, elsewhere) {
  // A host without a program has a reason of its own.
  if (words) return words;
  if (elsewhere) return "Some tiles would cost too much.";
  if (cost === null) return `Cells of d₁\u00a0=\u00a0${d1} would cost too much.`;
  return `A tile of d₁\u00a0=\u00a0${d1} would cost ${number(Number(cost), 2)} ${unit ?? "kicks"} (limit ${number(Number(limit), 2)}).`;
}
