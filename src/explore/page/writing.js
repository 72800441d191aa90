// Numbers as people read them.

import { decimal, text, toNumber, truncated } from "./exact.js";

const RAISED = { 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹", "-": "⁻", "−": "⁻" };

export const raised = (k) => [...String(k)].map((c) => RAISED[c]).join("");

/** `pi^2/25` as π²/25. */
export function mathematics(source) {
  return String(source)
    .replace(/\^\(?(-?\d+)\)?/g, (_, k) => raised(k))
    .replace(/pi/g, "π")
    .replace(/\*/g, "·")
    .replace(/-/g, "−");
}

/** An exact rational: a decimal where it is short, a fraction where that is, else its first digits and an ellipsis. */
export function exactly(x, room = 14) {
  const short = decimal(x, room - 2);
  if (short !== null && short.length <= room) return short;
  const fraction = text(x).replace("-", "−");
  if (fraction.length <= room) return fraction;
  const leading = Math.max(0, -Math.floor(Math.log10(Math.abs(toNumber(x)) || 1)) - 1);
  return `${truncated(x, leading + room - 3)}…`;
}

/** A double to `digits` significant ones, with a power of ten where that is shorter. */
export function number(x, digits = 4) {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (x === 0) return "0";
  if (!Number.isFinite(x)) return x < 0 ? "−∞" : "∞";
  const size = Math.abs(x);
  if (size >= 1e-3 && size < 1e6) {
    const places = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
    const [whole, part] = size.toFixed(Math.min(places, 15)).split(".");
    const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, ",") : whole;
    return (x < 0 ? "−" : "") + grouped + (part ? `.${part}` : "");
  }
  const [mantissa, exponent] = x.toExponential(digits - 1).split("e");
  return `${mantissa.replace("-", "−")}·10${raised(Number(exponent))}`;
}

/** The digits that both ends of an enclosure share once rounded; none is shown that is not certain. */
export function enclosure({ lo, hi }) {
  if (lo === hi) return number(lo, 16).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
  for (let digits = 16; digits > 1; digits--) {
    const [a, b] = [number(lo, digits), number(hi, digits)];
    if (a === b) return a;
  }
  return `${number(lo, 3)} … ${number(hi, 3)}`;
}

/** Years, days, ... are the reader's to make: a duration in the unit of the steps. */
export const withUnit = (value, unit) => `${value} ${unit ?? "time"}`;

/** A count with its digits in threes. */
export const grouped = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, ",");

/** d = step / 2^level, exactly and briefly. */
export function spacing(step, level) {
  const [n, d] = step;
  if (level <= 24) {
    const shift = BigInt(Math.abs(level));
    const value = level >= 0 ? [n, d << shift] : [n << shift, d];
    let [a, b] = value;
    while (a % 2n === 0n && b % 2n === 0n) [a, b] = [a / 2n, b / 2n];
    return b === 1n ? `${a}` : `${a}/${b}`;
  }
  return `2${raised(-level)}·${n === 1n ? "" : n}${d === 1n ? (n === 1n ? "1" : "") : `${n === 1n ? "1" : ""}/${d}`}`;
}
