// Exact rationals as [numerator, denominator] of BigInts, the denominator positive.

const magnitude = (n) => (n < 0n ? -n : n);

function gcd(a, b) {
  while (b) [a, b] = [b, a % b];
  return magnitude(a);
}

/** In lowest terms. */
export function rational(n, d = 1n) {
  const g = gcd(n, d) * (d < 0n ? -1n : 1n);
  return g === 0n ? [0n, 1n] : [n / g, d / g];
}

export const add = ([a, b], [c, d]) => rational(a * d + c * b, b * d);
export const subtract = ([a, b], [c, d]) => rational(a * d - c * b, b * d);
export const multiply = ([a, b], [c, d]) => rational(a * c, b * d);
export const divide = ([a, b], [c, d]) => rational(a * d, b * c);
export const compare = ([a, b], [c, d]) => {
  const difference = a * d - c * b;
  return difference < 0n ? -1 : difference > 0n ? 1 : 0;
};

/** 2^k for any integer k. */
export const powerOfTwo = (k) => (k >= 0 ? [1n << BigInt(k), 1n] : [1n, 1n << BigInt(-k)]);

/** 10^k for any integer k. */
export const powerOfTen = (k) => (k >= 0 ? [10n ** BigInt(k), 1n] : [1n, 10n ** BigInt(-k)]);

/** Reads `7/2`, `0.48`, `1e-3`, `3/2/5`, `2*3`; null for anything else, such as what involves pi. */
export function parse(text) {
  let value = [1n, 1n];
  const parts = String(text).replace(/\s/g, "").split(/([*/])/);
  for (let k = 0; k < parts.length; k += 2) {
    const match = /^(-?\d*)(?:\.(\d*))?(?:e([+-]?\d{1,4}))?$/i.exec(parts[k]);
    if (!match || !/\d/.test(match[1] + (match[2] ?? ""))) return null;
    const [, whole, part = "", exponent = "0"] = match;
    const factor = multiply([BigInt(`${whole}${part}` || 0), 1n], powerOfTen(Number(exponent) - part.length));
    if (parts[k - 1] === "/" && factor[0] === 0n) return null;
    value = parts[k - 1] === "/" ? divide(value, factor) : multiply(value, factor);
  }
  return value;
}

/** As the program reads it. */
export const text = ([n, d]) => (d === 1n ? `${n}` : `${n}/${d}`);

/** The nearest double, to a unit or two in the last place, however long the digits are. */
export function toNumber([n, d]) {
  const bits = (x) => magnitude(x).toString(16).length * 4;
  const shift = 70 + bits(d) - bits(n);
  const quotient = shift >= 0 ? (n << BigInt(shift)) / d : n / (d << BigInt(-shift));
  // In two steps, for 2^-shift alone may be below every double.
  const half = Math.trunc(shift / 2);
  return Number(quotient) * 2 ** -half * 2 ** (half - shift);
}

/** log10 of a positive rational, also where its double would overflow. */
export function log10([n, d]) {
  const digits = (x) => {
    const s = x.toString();
    return s.length - 1 + Math.log10(Number(`${s[0]}.${s.slice(1, 17)}`));
  };
  return digits(n) - digits(d);
}

/** The exact decimal, or null where it has no end or more than `most` digits after the point. */
export function decimal([n, d], most = 12) {
  let [rest, twos, fives] = [d, 0, 0];
  while (rest % 2n === 0n) [rest, twos] = [rest / 2n, twos + 1];
  while (rest % 5n === 0n) [rest, fives] = [rest / 5n, fives + 1];
  const places = Math.max(twos, fives);
  if (rest !== 1n || places > most) return null;
  return pointed((n * 10n ** BigInt(places)) / d, places);
}

/** n / 10^places in writing, exactly. */
export function pointed(n, places) {
  const sign = n < 0n ? "−" : "";
  if (places <= 0) return sign + magnitude(n).toString() + "0".repeat(n === 0n ? 0 : -places);
  const digits = magnitude(n).toString().padStart(places + 1, "0");
  return `${sign}${digits.slice(0, -places)}.${digits.slice(-places)}`;
}

/** The first `places` digits after the point, cut off and not rounded: what stands there is true. */
export function truncated([n, d], places) {
  const whole = (magnitude(n) * 10n ** BigInt(places)) / d;
  return (n < 0n ? "−" : "") + pointed(whole, places);
}

/** The simplest rational (least denominator) strictly between 0 <= lo < hi: a walk down the Stern-Brocot tree. */
export function simplest(lo, hi) {
  const whole = lo[0] / lo[1];
  if (compare([whole + 1n, 1n], hi) < 0) return [whole + 1n, 1n];
  const at = (x) => subtract(x, [whole, 1n]);
  const [a, b] = [at(lo), at(hi)];
  // Between a and b <= 1: the reciprocal of the simplest between 1/b and 1/a.
  if (a[0] === 0n) return add([whole, 1n], [1n, b[1] / b[0] + 1n]);
  return add([whole, 1n], divide([1n, 1n], simplest(divide([1n, 1n], b), divide([1n, 1n], a))));
}
