// Below the map: growth along a cut, the tongues of one ratio over rho, a system's growth over its outer step.

import { latest } from "./ask.js";
import { css, family } from "./colours.js";
import { h, iconButton, step } from "./dom.js";
import { parse, toNumber } from "./exact.js";
import { plot } from "./plot.js";
import { enclosure, exactly, mathematics, number } from "./writing.js";

const minus = (source) => String(source).replace(/-/g, "−");
const label = ({ m, a, b }) => minus(`m = ${m} (${a}, ${b})`);

/** Ends of a growth axis, from zero; one that is flat gets a height all the same. */
const upward = (rates) => {
  const most = Math.max(0, ...rates.filter((rate) => rate !== null));
  return { lo: 0, hi: most > 0 ? 1.2 * most : 1 };
};

/** Outer steps at which a system is decided. */
const SAMPLES = 201;

/** Samples are evenly spaced in rho: a decade at a time they are so in its logarithm, nearly. */
const DECADES = ["1/1000..1/300", "1/300..1/100", "1/100..3/100", "3/100..1/10", "1/10..3/10", "3/10..1", "1..3", "3..10"];

/** Strips side by side as one; what two share at their common end is taken once. */
function joined(strips) {
  const [first, ...rest] = strips;
  const all = { rho: [...first.rho], tongues: first.tongues.map((t) => ({ ...t, lower: [...t.lower], upper: [...t.upper] })), closings: first.closings && [...first.closings] };
  for (const { rho, tongues, closings } of rest) {
    all.rho.push(...rho.slice(1));
    tongues.forEach((t, k) => {
      all.tongues[k].lower.push(...t.lower.slice(1));
      all.tongues[k].upper.push(...t.upper.slice(1));
    });
    all.closings?.push(...(closings ?? []));
  }
  return all;
}

/** Growth is zero at the edges of an interval: they belong to the curve between its samples. */
function withEdges(x, rate, intervals) {
  const edges = intervals.flatMap((t) => [t.lower.lo, t.upper?.hi]).filter((at) => at > x[0] && at < x.at(-1));
  const points = [...x.map((at, k) => [at, rate[k]]), ...edges.map((at) => [at, 0])].sort((a, b) => a[0] - b[0]);
  return { x: points.map(([at]) => at), y: points.map(([, y]) => y) };
}

const table = (caption, head, rows) =>
  h("details", {}, h("summary", {}, caption), h("div.scroll", { tabindex: 0, role: "region", "aria-label": caption }, h("table", {}, h("thead", {}, h("tr", {}, ...head.map((cell) => h("th", { scope: "col" }, ...[cell].flat())))), h("tbody", {}, ...rows.map((row) => h("tr", {}, ...row.map((cell) => h("td", {}, cell))))))));

export class Drawer {
  /** `shared()`: {lambda1, lambda2, rho, values, palette, unit, pin}; `act`: {close(kind), probe(t), rho(text), ratio(text), outer(text), at(text)}. */
  constructor(host, questions, shared, act) {
    Object.assign(this, { host, questions, shared, act, shown: null, data: null });
    this.title = h("h2", {});
    this.field = h("div.plot", {});
    this.below = h("div.below", {});
    this.extra = h("div.row", {});
    this.host.append(h("div.head", {}, this.title, this.extra, iconButton("close", "Close the plot", () => act.close(this.shown?.kind))), this.field, this.below);
    this.load = latest(async (kind, asked, signal) => {
      const replies = await Promise.all(asked.map(([path, params]) => questions.json(path, params, signal)));
      this.data = { of: kind, reply: kind === "strip" ? joined(replies) : replies[0] };
      this.paint();
      if (kind === "system") this.loadStretches(this.data.reply, asked[0][1]);
    }, 30);
    // Growth is shown before it is known where it is proven: that may take long, or too long.
    this.loadStretches = latest(async (reply, { outer }, signal) => {
      const found = await this.questions.json("stretches", outer ? { outer } : {}, signal).catch((error) => ({ stretches: null, lost: error.message }));
      if (signal.aborted) return;
      Object.assign(reply, found);
      this.paint();
    });
    this.loadModes = latest(async (at, signal) => {
      this.modes = await questions.json("modes", { at }, signal).catch((error) => ({ at: Number(at), error: error.message }));
      this.paint();
    });
    new ResizeObserver(() => this.paint()).observe(this.field);
  }

  /** `what`: null, {kind: "cut", ...cut}, {kind: "strip", ratio} or {kind: "system", outer, at}. */
  show(what) {
    const { lambda1, lambda2 } = this.shared();
    const key = what && JSON.stringify([{ ...what, at: null }, lambda1, lambda2]);
    this.host.hidden = !what;
    this.#choose(what?.at ?? null);
    if (!what || this.key === key) return;
    Object.assign(this, { key, shown: what });
    this.#head(what);
    this.field.classList.add("busy");
    this.#ask(what, { lambda1, lambda2 }).catch((error) => {
      this.data = null;
      this.field.classList.remove("busy");
      this.field.replaceChildren(h("p.quiet", { role: "status" }, error.message));
      this.below.replaceChildren();
    });
  }

  /** The outer step whose modes are told, or none. */
  #choose(at) {
    if (at === (this.at ?? null)) return;
    Object.assign(this, { at, modes: null });
    if (this.chosen) this.chosen.value = at ?? "";
    if (at) this.loadModes(at);
    else this.loadModes.stop();
    this.paint();
  }

  #ask(what, springs) {
    if (what.kind === "cut") {
      const { along, value, lo, hi } = what;
      return this.load("cut", [["cut", { ...springs, kind: along, value, lo, hi, samples: 401 }]]);
    }
    if (what.kind === "strip") return this.load("strip", DECADES.map((rho) => ["strip", { ratio: what.ratio, rho, samples: 31 }]));
    return this.load("system", [["system", what.outer ? { outer: what.outer, samples: SAMPLES } : { samples: SAMPLES }]]);
  }

  #head(what) {
    this.extra.replaceChildren();
    if (what.kind === "cut") {
      const fixed = parse(what.value);
      const name = { h1: step(1), h2: step(2), ratio: [step(2), "/", step(1)] }[what.along];
      this.title.replaceChildren("Growth along ", ...[name].flat(), " = ", what.along === "ratio" ? what.value : exactly(fixed, 20));
    } else if (what.kind === "strip") {
      const input = h("input", { value: what.ratio, size: 6, "aria-label": "Ratio p/q of the strip", onchange: () => this.act.ratio(input.value) });
      this.title.replaceChildren("Tongues of ", step(2), "/", step(1), " = ", what.ratio);
      this.extra.append(h("label.entry", {}, h("i", {}, "p/q"), input));
    } else {
      const input = h("input", { value: what.outer ?? "", placeholder: "from..to", size: 10, "aria-label": "Range of the outer step, from..to", onchange: () => this.act.outer(input.value.trim() || null) });
      const chosen = h("input", { value: what.at ?? "", placeholder: "step", size: 6, "aria-label": "Outer step whose modes are told", onchange: () => this.act.at(chosen.value.trim() || null) });
      Object.assign(this, { range: input, chosen });
      this.title.replaceChildren("Growth against the outer step");
      this.extra.append(h("label.entry.wide", {}, "range", input), h("label.entry", {}, "modes at", chosen));
    }
  }

  paint() {
    if (!this.data || !this.shown || this.host.hidden || this.data.of !== this.shown.kind) return;
    this.field.classList.remove("busy");
    this[`_${this.data.of}`](this.data.reply);
  }

  _cut({ x, rate, kind, axis, intervals: tongues }) {
    const intervals = tongues?.map((t) => ({ ...t, lower: t.lower[axis], upper: t.upper && t.upper[axis] }));
    const { palette, unit } = this.shared();
    const [lo, hi] = [this.shown.lo, this.shown.hi].map((end) => toNumber(parse(end)));
    const layers = [{ kind: "line", ...withEdges(x, rate, intervals ?? []), colour: css(palette.kinds[1]), below: true }];
    if (intervals?.length) {
      layers.unshift({ kind: "spans", colour: css(palette.accent), spans: intervals.map((t) => ({ lo: t.lower.lo, hi: t.upper ? t.upper.hi : null, label: label(t) })) });
    }
    const edges = [2, 3].map((value) => ({ value, at: x.filter((_, k) => (kind?.[k] & 3) === value) }));
    for (const { value, at } of edges) if (at.length) layers.push({ kind: "points", x: at, y: at.map(() => 0), colour: css(palette.kinds[value]) });
    const index = axis === "h1" ? 1 : 2;
    plot(this.field, {
      x: { lo, hi, title: `*h*_${index} (${unit})` },
      y: { ...upward(rate), title: `growth rate (1/${unit})` },
      layers, label: `Growth rate along the cut, ${intervals?.length ?? 0} tongues`,
      probe: (at) => this.act.probe(at === null ? null : (at - lo) / (hi - lo)),
    });
    if (this.shown.along !== "ratio") {
      const lost = rate.filter((r) => r === null).length;
      this.below.replaceChildren(h("p.quiet", {}, `${x.length - lost} exact verdicts, evenly spaced; between them other ratios, and other tongues, lie.`, lost ? ` ${lost} would cost too much and are left out.` : ""));
      return;
    }
    const cells = intervals.map((t) => [String(t.m), minus(`(${t.a}, ${t.b})`), enclosure(t.lower), t.upper ? enclosure(t.upper) : "∞"]);
    this.below.replaceChildren(table(`${intervals.length} unstable intervals, certified edges`, [h("i", {}, "m"), "family", ["from ", step(index)], "to"], cells));
  }

  _strip({ rho, tongues, closings: told }) {
    const { palette, values } = this.shared();
    const closings = told ?? [];
    const most = Math.max(4.4, ...closings.map(({ s }) => Math.min(1.1 * s, 12)));
    const bands = tongues.map((t) => ({ kind: "band", x: rho, lower: t.lower, upper: t.upper, colour: css(family(palette, t.a)), label: label(t) }));
    const layers = [...bands, { kind: "upright", at: values.rho, colour: css(palette.ink) }];
    if (closings.length) {
      layers.push({ kind: "points", x: closings.map((c) => c.rho), y: closings.map((c) => c.s), colour: css(palette.ink), label: (k) => `m = ${closings[k].m} closes at s = ${number(closings[k].s, 6)}, ρ = ${number(closings[k].rho, 6)}` });
    }
    plot(this.field, {
      x: { lo: rho[0], hi: rho.at(-1), log: true, title: "*ρ* = *λ*_2/*λ*_1" },
      y: { lo: 0, hi: most, title: "*s* = *h*_1^2 *λ*_1" },
      layers, label: `Tongues over rho: ${tongues.length}; closings: ${closings.length}`,
      pick: (at) => this.act.rho(String(Number(at.toPrecision(3)))),
    });
    const cells = closings.map((c) => [String(c.m), c.exact?.[0] ? mathematics(c.exact[0]) : String(Number(c.s.toPrecision(12))), c.exact?.[1] ? mathematics(c.exact[1]) : String(Number(c.rho.toPrecision(12)))]);
    const said = h("p.quiet", {}, "A dashed line marks the map's ", h("i", {}, "ρ"), "; a click takes another. ", closings.length ? "Circles: the tongue closes, the resonance does not destabilize." : told ? "No tongue closes here." : "Closings are not looked for at so large p + q.");
    this.below.replaceChildren(said, ...(closings.length ? [table(closings.length === 1 ? "1 closing" : `${closings.length} closings`, [h("i", {}, "m"), h("i", {}, "s"), h("i", {}, "ρ")], cells)] : []));
  }

  _system({ outer, rate, stretches, lost, own, verdict, unit: named }) {
    const { palette } = this.shared();
    const unit = named ?? "time";
    this.range.placeholder = `${number(outer[0])}..${number(outer.at(-1))}`;
    // Proven unstable, and what the bounds do not decide; the rest is proven stable.
    const spans = (wanted, colour) => ({ kind: "spans", colour: css(colour), spans: (stretches ?? []).filter((own) => own.verdict === wanted).map(({ lo, hi, verdict: label }) => ({ lo, hi, label })) });
    const shades = [spans("unstable", palette.accent), spans("the data do not tell", palette.faint)];
    const layers = [...shades, { kind: "line", x: outer, y: rate, colour: css(palette.kinds[1]), below: true }, { kind: "upright", at: own, colour: css(palette.ink) }];
    const { modes } = this;
    if (modes) layers.push({ kind: "upright", at: modes.at, colour: css(palette.accent) });
    const begin = "Point at the curve to read it; a click tells the modes that grow there.";
    const pointed = h("p.quiet.number", {}, begin);
    const read = (x) => {
      const k = x === null ? null : Math.round(((x - outer[0]) / (outer.at(-1) - outer[0])) * (outer.length - 1));
      const rated = rate[k] === null ? "not told" : rate[k] > 0 ? `${number(rate[k], 3)} per ${unit}` : "none";
      pointed.textContent = k === null ? begin : `Outer step ${number(outer[k], 4)} ${unit}: growth ${rated}.`;
    };
    plot(this.field, {
      x: { lo: outer[0], hi: outer.at(-1), title: `outer step (${unit})` },
      y: { ...upward(rate), title: `growth rate (1/${unit})` },
      layers, label: "Growth rate against the outer step",
      probe: read, pick: (x) => this.act.at(String(Number(x.toPrecision(4)))),
    });
    const says = [`proven unstable on ${shades[0].spans.length}`, `not decided on ${shades[1].spans.length}`];
    const chosen = modes && (modes.error ? [h("p.quiet", { role: "status" }, modes.error)] : told("At the outer step that was chosen", modes.verdict, modes.at, unit));
    this.below.replaceChildren(
      pointed, ...told("The dashed line is the file's own outer step", verdict, own, unit), ...(chosen ?? []),
      ...(rate.length < SAMPLES ? [h("p.quiet", {}, `${rate.length} steps were decided, evenly spaced: more would cost too much at once. A narrower range shows more of it.`)] : []),
      h("p.quiet", { "data-said": "stretches" }, proven(stretches, lost, says)));
  }
}

/** Where growth is proven, as far as that is known. */
function proven(stretches, lost, says) {
  if (lost) return `Unstable intervals between these steps are not known: ${lost}. A narrower range costs less.`;
  if (stretches === undefined) return "Looking for unstable intervals between these steps …";
  return stretches ? `Of the intervals of outer steps it is ${says.join(" (red), ")} (grey); on the others it is proven stable.` : "";
}

/** What holds at an outer step: stable, or which modes grow. */
function told(place, verdict, at, unit) {
  const modes = (verdict?.parts ?? []).flatMap(({ instabilities }) => instabilities ?? []);
  const stable = verdict?.stable == null ? "" : verdict.stable ? "stable, " : "unstable, ";
  const said = h("p.quiet", {}, `${place}, ${at} ${unit}: ${stable}${verdict?.kind ?? "not decided"}.`);
  if (!modes.length) return [said];
  const rows = modes.map(({ growth_rate: rate, origin, resonance, shape }) => [
    rate ? enclosure(rate) : "–", origin ?? "–", resonance ? minus(`m = ${resonance.m}, (${resonance.family})`.replace(",", ", ")) : "–",
    resonance?.frequencies?.map((w) => number(w, 5)).join(", ") ?? "–", shape?.slice(0, 6).map((x) => number(x, 3)).join(", ") ?? "–",
  ]);
  return [said, table(modes.length === 1 ? "1 mode grows" : `${modes.length} modes grow`, ["growth rate", "origin", "resonance", "frequencies", "shape"], rows)];
}
