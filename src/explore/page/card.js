// What the page says about one pair: under the pointer in short, pinned as a card.

import { h, icon, step } from "./dom.js";
import { rational } from "./exact.js";
import { enclosure, exactly, grouped, number } from "./writing.js";

export const KINDS = ["elliptic", "hyperbolic", "parabolic", "coexistence"];
const SAID = {
  elliptic: ["Stable", "elliptic"],
  hyperbolic: ["Unstable", "exponential growth, hyperbolic"],
  parabolic: ["Unstable", "linear growth, parabolic"],
  coexistence: ["Stable", "coexistence, a closed tongue"],
};

/** The verdict in words, with its colour before it. */
export function verdict(kind, stable) {
  const [word, detail] = SAID[kind] ?? ["…", ""];
  const said = stable === undefined ? word : stable ? "Stable" : "Unstable";
  return h("span.verdict", {}, h("span.swatch", { class: `swatch ${kind}` }), h("b", {}, said), detail ? ` ${detail}` : "");
}

export const spoken = (kind) => (SAID[kind] ?? ["not decided", ""]).join(", ");

const ratioOf = ({ p, q }) => `${grouped(p).length > 12 ? `${String(p).slice(0, 6)}…` : p}/${String(q).length > 9 ? `${String(q).slice(0, 6)}…` : q}`;

/** Under the pointer: exact pair; verdict, growth and tenfold once the server has told. */
export function readout(host, pair, kind, told, unit, note) {
  const [h1, h2] = pair.map((x) => exactly(x, 30));
  const growth = told?.growth_rate && told.growth_rate.hi > 0;
  const rows = [
    h("div.pair", {}, h("span", {}, step(1), " = ", h("b.number", {}, h1)), h("span", {}, step(2), " = ", h("b.number", {}, h2))),
    h("div", {}, kind ? verdict(kind, told?.stable) : h("span.quiet.note-of-pair", {}, note ?? "not decided yet")),
    h("div.quiet", {}, told ? [step(2), "/", step(1), ` = ${ratioOf(told)}`, told.resonance ? h("span", {}, `, tongue `, h("i", {}, "m"), ` = ${told.resonance.m}, family (${told.resonance.a}, ${told.resonance.b})`.replace(/-/g, "−")) : ""] : (kind && note) || " "),
    h("div.quiet", {}, growth ? `growth ${number((told.growth_rate.lo + told.growth_rate.hi) / 2, 3)} per ${unit}` : " ", told?.tenfold ? `; tenfold in ${number(told.tenfold.steps, 3)} slow steps, ${number(told.tenfold.time, 3)} ${unit}` : ""),
  ];
  host.replaceChildren(...rows);
}

const row = (name, ...value) => [h("dt", {}, ...[name].flat()), h("dd", {}, ...value)];
const interval = (lower, upper, unit) => [h("span.end", {}, h("span.number", {}, enclosure(lower)), " to"), h("span.end", {}, h("span.number", {}, upper ? enclosure(upper) : "∞"), unit ? ` ${unit}` : "")];

function tongueRows(tongue, unit) {
  if (!tongue) return [];
  const edge = (axis) => interval(tongue.lower[axis], tongue.upper?.[axis], axis === "s" ? null : unit);
  return [
    row("tongue", h("i", {}, "m"), ` = ${tongue.m}, family (${tongue.a}, ${tongue.b})`.replace(/-/g, "−")),
    row(["edges in ", step(1)], ...edge("h1")),
    row(["edges in ", step(2)], ...edge("h2")),
    tongue.lower.s ? row(["edges in ", h("i", {}, "s")], ...edge("s")) : [],
  ].flat();
}

function neighbour(name, tongue, side) {
  if (!tongue) return [];
  const edge = side === "below" ? tongue.upper : tongue.lower;
  return row(name, h("i", {}, "m"), ` = ${tongue.m}, `, step(1), " ", side === "below" ? "to " : "from ", h("span.number", {}, edge ? enclosure(edge.h1) : "∞"));
}

/** `act`: {copy, certificate, document, centre, cut(kind), strip, close}. */
export function card(host, pin, told, unit, act) {
  const head = h("div.head", {}, h("h2", {}, "Pinned pair"), h("button.round.small", { type: "button", "aria-label": "Remove the pin", title: "Remove the pin", onclick: act.close }, icon("close")));
  const pair = [
    ...row(step(1), h("span.number.exact", { "data-exact": "h1" }, pin.text[0]), ` ${unit}`),
    ...row(step(2), h("span.number.exact", { "data-exact": "h2" }, pin.text[1]), ` ${unit}`),
  ];
  const go = h("div.row", {}, h("button", { type: "button", onclick: act.centre }, "Centre here"));
  if (!told || told.error) {
    const said = told?.error ?? "asking …";
    host.replaceChildren(head, h("dl", {}, ...pair), h("p.quiet", { role: "status" }, said), go);
    return;
  }
  const growth = told.growth_rate.hi > 0;
  host.replaceChildren(
    head,
    h("p.answer", { "data-kind": told.kind }, verdict(told.kind, told.stable)),
    h("dl", {},
      ...pair,
      ...row([step(2), "/", step(1)], h("span.number", {}, `${told.p}/${told.q}`)),
      ...(growth ? row("growth rate", h("span.number", {}, enclosure(told.growth_rate)), ` per ${unit}`) : []),
      ...(told.tenfold ? row("tenfold in", h("span.number", {}, number(told.tenfold.steps)), " slow steps, ", h("span.number", {}, number(told.tenfold.time)), ` ${unit}`) : []),
      ...tongueRows(told.tongue, unit),
      ...neighbour("tongue below", told.nearest?.below, "below"),
      ...neighbour("tongue above", told.nearest?.above, "above"),
      ...row("trace", h("span.number", {}, told.trace.exact ?? enclosure(told.trace))),
      ...row("decided by", { filter: "filter: a certified bound on rounding", refine: "refine: intervals of more bits", exact: "exact arithmetic" }[told.decided_by] ?? told.decided_by)),
    h("div.command", {}, h("code", { tabindex: 0, role: "textbox", "aria-readonly": "true", "aria-label": "The command that gives this verdict" }, told.command), h("button.round.small", { type: "button", "aria-label": "Copy the command", title: "Copy the command", onclick: (event) => act.copy(told.command, event.currentTarget) }, icon("copy"))),
    h("div.row", {},
      h("button", { type: "button", onclick: act.centre }, "Centre here"),
      h("button", { type: "button", onclick: act.certificate, title: "A Coq proof of this verdict" }, "Certificate"),
      h("button", { type: "button", onclick: act.document }, "JSON")),
    h("div.row", {},
      h("button", { type: "button", onclick: () => act.cut("ratio") }, "Cut along ", h("span.number", {}, ratioOf(told))),
      h("button", { type: "button", onclick: () => act.cut("h1") }, "along ", step(2)),
      h("button", { type: "button", onclick: () => act.cut("h2") }, "along ", step(1)),
      h("button", { type: "button", onclick: act.strip }, "Tongues over ", h("i", {}, "ρ"))),
    h("p.error", { role: "alert" }, pin.said ?? ""),
  );
}

/** The pair as exact rationals and as text that the program reads. */
export const pinned = (pair) => ({ pair, text: pair.map(([n, d]) => (([a, b]) => (b === 1n ? `${a}` : `${a}/${b}`))(rational(n, d))) });
