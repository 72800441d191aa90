// What is shown as texts, for the address, and back.

import { parse } from "./exact.js";

const COLOURINGS = ["verdict", "growth", "family"];
const SUM = 40;

/** What a page begins with. */
export const plain = () => ({ what: "verdict", tongues: "auto", maxSum: SUM, curves: false, labels: true, cut: null, strip: null, system: false, outer: null, at: null });

/** The largest p + q of tongues as lines, kept within what the program lays out quickly. */
export const summed = (entered) => Math.min(400, Math.max(2, Math.round(entered) || SUM));

/** All that an address says; what is as a page begins is empty. */
export function saved({ lambda1, lambda2, step, what, tongues, maxSum, curves, labels, pin, cut, strip, system, outer, at }, view) {
  return {
    lambda1, lambda2, step, view: view.save(), what: what === "verdict" ? "" : what, tongues: tongues === "auto" ? "" : tongues,
    maxSum: maxSum === SUM ? "" : String(maxSum), curves: curves ? "1" : "", labels: labels ? "" : "0",
    pin: pin ? pin.text.join(",") : "", cut: cut ? [cut.kind, cut.value, cut.lo, cut.hi].join(",") : "", strip: strip ?? "", system: system ? "1" : "",
    outer: outer ?? "", at: at ?? "",
  };
}

/** What an address says of the pictures; anything that it should not say is as a page begins. */
export function taken(texts) {
  const [kind, value, lo, hi] = (texts.cut ?? "").split(",");
  return {
    what: COLOURINGS.includes(texts.what) ? texts.what : "verdict",
    tongues: ["on", "off"].includes(texts.tongues) ? texts.tongues : "auto",
    maxSum: summed(Number(texts.maxSum)),
    curves: texts.curves === "1", labels: texts.labels !== "0", system: texts.system === "1",
    cut: ["h1", "h2", "ratio"].includes(kind) && [value, lo, hi].every(parse) ? { kind, value, lo, hi } : null,
    strip: ratio(texts.strip), outer: texts.outer || null, at: texts.at || null,
  };
}

/** A ratio p/q as it was typed, or null. */
export const ratio = (source) => (/^\d{1,9}\/\d{1,9}$/.test((source ?? "").trim()) ? source.trim() : null);
