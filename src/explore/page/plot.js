// Small plots below the map, as SVG in the figures' manner: lines, bands, points over two axes.

import { h } from "./dom.js";
import { number, raised } from "./writing.js";

/** The least width of an interval, in pixels: one that is thinner is still to be seen. */
const LEAST = 3;

const MARGIN = { left: 74, right: 18, top: 12, bottom: 50 };

/** Round numbers over [lo, hi]: at most about `most`. */
function linear(lo, hi, most) {
  const wanted = (hi - lo) / most;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const step = [1, 2, 5, 10].map((digit) => digit * power).find((s) => s >= wanted * (1 - 1e-9));
  const ticks = [];
  for (let k = Math.ceil(lo / step - 1e-9); k * step <= hi + 1e-9 * step; k++) ticks.push(k * step);
  const places = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const write = places <= 6 ? (x) => x.toFixed(places).replace("-", "−") : (x) => number(x, 6);
  return ticks.map((at) => ({ at, label: write(at) }));
}

function logarithmic(lo, hi, most) {
  const [a, b] = [Math.ceil(Math.log10(lo) - 1e-9), Math.floor(Math.log10(hi) + 1e-9)];
  const every = Math.max(1, Math.ceil((b - a) / most));
  const ticks = [];
  for (let k = a; k <= b; k += every) ticks.push({ at: 10 ** k, label: `10${raised(k)}` });
  return ticks;
}

/** An axis: {lo, hi, log, title: [pieces of svg text]}. */
function scale(axis, from, to) {
  const f = axis.log ? Math.log10 : (x) => x;
  const [a, b] = [f(axis.lo), f(axis.hi)];
  return (x) => from + ((f(x) - a) / (b - a || 1)) * (to - from);
}

/** Italic letters with indices in an SVG text, from `*h*_1 (time)`. */
export function words(source) {
  return source.split(/(\*[^*]+\*|[_^][0-9])/).filter(Boolean).map((part) => {
    if (part.startsWith("*")) return h("tspan", { "font-style": "italic" }, part.slice(1, -1));
    if (/^[_^]/.test(part)) return h("tspan", { "font-size": "0.72em", "baseline-shift": part[0] === "_" ? "-0.22em" : "0.5em" }, part.slice(1));
    return h("tspan", {}, part);
  });
}

/**
 * Draws into `host`. `layers`: {kind: "line" | "band" | "points" | "upright" | "spans", colour, ...}, drawn in order.
 * `probe(x | null)` is told the value below the pointer, `pick(x, y)` of a click.
 */
export function plot(host, { x, y, layers, label, probe, pick }) {
  const width = Math.max(260, host.clientWidth);
  const height = Math.max(150, host.clientHeight);
  const narrow = width < 520;
  const left = narrow ? 58 : MARGIN.left;
  const box = { left, right: width - MARGIN.right, top: MARGIN.top, bottom: height - MARGIN.bottom };
  const at = [scale(x, box.left, box.right), scale(y, box.bottom, box.top)];
  const svg = h("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": label });
  const inner = h("svg", { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top, viewBox: `${box.left} ${box.top} ${box.right - box.left} ${box.bottom - box.top}` });
  layers.forEach((layer) => DRAW[layer.kind](inner, layer, at, box));
  svg.append(inner, h("rect", { x: box.left - 0.5, y: box.top - 0.5, width: box.right - box.left + 1, height: box.bottom - box.top + 1, class: "frame" }));
  const ticks = (axis, most) => (axis.log ? logarithmic : linear)(axis.lo, axis.hi, most);
  for (const tick of ticks(x, narrow ? 4 : 8)) {
    const px = Math.round(at[0](tick.at)) + 0.5;
    svg.append(h("line", { x1: px, x2: px, y1: box.bottom + 1, y2: box.bottom + 6, class: "tick" }), h("text", { x: px, y: box.bottom + 20, "text-anchor": "middle" }, tick.label));
  }
  for (const tick of ticks(y, Math.max(2, Math.floor((box.bottom - box.top) / 34)))) {
    const py = Math.round(at[1](tick.at)) + 0.5;
    svg.append(h("line", { y1: py, y2: py, x1: box.left - 1, x2: box.left - 6, class: "tick" }), h("text", { x: box.left - 10, y: py + 4.5, "text-anchor": "end" }, tick.label));
  }
  svg.append(
    h("text", { x: (box.left + box.right) / 2, y: height - 9, "text-anchor": "middle", class: "title" }, ...words(x.title)),
    h("text", { transform: `translate(${narrow ? 13 : 18} ${(box.top + box.bottom) / 2}) rotate(-90)`, "text-anchor": "middle", class: "title" }, ...words(y.title)),
  );
  if (probe) pointer(svg, box, x, probe);
  if (pick) {
    svg.addEventListener("click", (event) => {
      const { left: from } = svg.getBoundingClientRect();
      const px = event.clientX - from;
      if (px >= box.left && px <= box.right) pick(inverse(x, (px - box.left) / (box.right - box.left)));
    });
  }
  host.replaceChildren(svg);
}

const inverse = (axis, t) => (axis.log ? axis.lo * (axis.hi / axis.lo) ** t : axis.lo + t * (axis.hi - axis.lo));

function pointer(svg, box, axis, probe) {
  const line = h("line", { y1: box.top, y2: box.bottom, class: "probe", visibility: "hidden" });
  svg.append(line);
  svg.addEventListener("pointermove", (event) => {
    const px = event.clientX - svg.getBoundingClientRect().left;
    const inside = px >= box.left && px <= box.right;
    line.setAttribute("visibility", inside ? "visible" : "hidden");
    line.setAttribute("x1", px);
    line.setAttribute("x2", px);
    probe(inside ? inverse(axis, (px - box.left) / (box.right - box.left)) : null);
  });
  svg.addEventListener("pointerleave", () => {
    line.setAttribute("visibility", "hidden");
    probe(null);
  });
}

const DRAW = {
  /** {x: [], y: []}; null breaks the line; `below`: filled down to the axis. */
  line(svg, { x, y, colour, below, wide = 1.6 }, [fx, fy], box) {
    let run = [];
    const flush = () => {
      if (run.length && below) svg.append(h("path", { d: `M${run[0][0]} ${box.bottom}L${run.map((p) => p.join(" ")).join("L")}L${run.at(-1)[0]} ${box.bottom}Z`, fill: colour, "fill-opacity": 0.16 }));
      if (run.length) svg.append(h("polyline", { points: run.map((p) => p.join(",")).join(" "), fill: "none", stroke: colour, "stroke-width": wide, "stroke-linejoin": "round" }));
      run = [];
    };
    x.forEach((at, k) => (y[k] === null ? flush() : run.push([fx(at).toFixed(2), fy(y[k]).toFixed(2)])));
    flush();
  },
  /** Between `lower` and `upper` over x. */
  band(svg, { x, lower, upper, colour, label }, [fx, fy], box) {
    const up = x.map((at, k) => `${fx(at).toFixed(2)},${(upper[k] === null ? box.top - 9 : fy(upper[k])).toFixed(2)}`);
    const down = x.map((at, k) => `${fx(at).toFixed(2)},${fy(lower[k]).toFixed(2)}`).reverse();
    svg.append(h("polygon", { points: [...up, ...down].join(" "), fill: colour, "fill-opacity": 0.75, stroke: colour, "stroke-width": 1 }, label ? h("title", {}, label) : null));
  },
  points(svg, { x, y, colour, label }, [fx, fy]) {
    x.forEach((at, k) => svg.append(h("circle", { cx: fx(at), cy: fy(y[k]), r: 4.5, fill: "var(--paper)", stroke: colour, "stroke-width": 2 }, label ? h("title", {}, label(k)) : null)));
  },
  upright(svg, { at, colour }, [fx], box) {
    svg.append(h("line", { x1: fx(at), x2: fx(at), y1: box.top, y2: box.bottom, stroke: colour, "stroke-width": 1.2, "stroke-dasharray": "4 3" }));
  },
  /** Intervals of x as shaded columns; what is thinner than `LEAST` is as wide as that, and darker. */
  spans(svg, { spans, colour }, [fx], box) {
    for (const { lo, hi, label } of spans) {
      const [a, b] = [Math.max(box.left, fx(lo)), Math.min(box.right, hi === null ? box.right : fx(hi))];
      if (b < box.left || a > box.right) continue;
      const thin = b - a < LEAST;
      const from = thin ? Math.min(box.right - LEAST, Math.max(box.left, (a + b - LEAST) / 2)) : a;
      svg.append(h("rect", { x: from, y: box.top, width: thin ? LEAST : b - a, height: box.bottom - box.top, fill: colour, "fill-opacity": thin ? 0.55 : 0.16 }, h("title", {}, label)));
      if (b - a > 7.5 * label.length) svg.append(h("text", { x: (a + b) / 2, y: box.top + 16, "text-anchor": "middle" }, label));
    }
  },
};
