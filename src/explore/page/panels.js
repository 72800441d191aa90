// The panels beside the map: colours and legend, lines over the map, the springs, going to a pair, saving.

import { css, DECADES } from "./colours.js";
import { checkbox, h, segmented, step, unique } from "./dom.js";
import { raised } from "./writing.js";

const section = (title, ...children) => h("section.panel", {}, h("h2", {}, title), ...children);

/** What the colours mean. */
export function legend(host, { what, palette, frequency, unit }) {
  const key = (colour, ...words) => h("li", {}, Object.assign(h("span.swatch", {}), {}), h("span", {}, ...words));
  const list = (entries) => {
    const items = entries.map(([colour, ...words]) => {
      const item = key(colour, ...words);
      item.firstChild.style.background = css(colour);
      return item;
    });
    return h("ul.legend", {}, ...items);
  };
  if (what === "growth") {
    const bar = h("canvas.bar", { width: 256, height: 1, role: "img", "aria-label": "Growth rate, from weak to strong" });
    const context = bar.getContext("2d");
    palette.growth.forEach((colour, k) => {
      context.fillStyle = css(colour);
      context.fillRect(k, 0, 1, 1);
    });
    const [lo, hi] = DECADES.map((d) => d + Math.log10(frequency));
    const ticks = [];
    for (let k = Math.ceil(lo); k <= hi; k++) {
      const tick = h("span", {}, `10${raised(k)}`);
      tick.style.left = `${(100 * (k - lo)) / (hi - lo)}%`;
      ticks.push(tick);
    }
    host.replaceChildren(h("div.scale", {}, bar, h("div.ticks", {}, ...ticks), h("div.quiet", {}, `growth rate (1/${unit}); stable: as the paper`)));
    return;
  }
  if (what === "family") {
    const order = [0, 1, -1, 2, -2, 3, -3];
    const families = order.map((a, k) => [palette.families[k], h("i", {}, "a"), ` = ${a}`.replace("-", "−")]);
    host.replaceChildren(list([...families, [palette.families.at(-1), "others"], [palette.paper, "stable"]]));
    host.firstChild.classList.add("columns");
    return;
  }
  const names = ["stable", "exponential growth (hyperbolic)", "linear growth (parabolic)", "closed tongue (coexistence)"];
  host.replaceChildren(list(names.map((name, kind) => [palette.kinds[kind], name])));
}

export function colours(state, act) {
  const host = h("div.keys", {});
  const choice = segmented("What the colours show", "what", [["verdict", "Verdict"], ["growth", "Growth"], ["family", "Family"]], state.what, act.what);
  return { element: section("Colours", choice, host), host, choice };
}

export function over(state, act) {
  const tongues = h("select", { id: unique("tongues"), "aria-label": "Tongues as lines", onchange: () => act.tongues(tongues.value) },
    ...[["auto", "where cells end"], ["on", "always"], ["off", "never"]].map(([value, label]) => h("option", { value }, label)));
  tongues.value = state.tongues;
  const sum = h("input", { type: "number", min: 2, max: 400, id: unique("max-sum"), value: String(state.maxSum), onchange: () => act.maxSum(Number(sum.value)) });
  const curves = checkbox("", state.curves, act.curves);
  curves.lastChild.append("Curves ", h("i", {}, "(a, b)"), " of the Proposition");
  const labels = checkbox("Labels", state.labels, act.labels);
  const stretch = h("select", { id: unique("stretch"), onchange: () => act.stretch(Number(stretch.value)) },
    ...Array.from({ length: 15 }, (_, k) => k - 5).map((e) => h("option", { value: e }, e >= 0 ? `1 : ${2 ** e}` : `${2 ** -e} : 1`)));
  const element = section("Over the map",
    h("div.entry", {}, h("label", { for: tongues.id }, "Tongues as lines"), tongues),
    h("div.entry", {}, h("label", { for: sum.id }, "ratios up to ", h("i", {}, "p"), " + ", h("i", {}, "q"), " ="), sum),
    curves, labels,
    h("div.entry", {}, h("label", { for: stretch.id }, "Scale of ", step(1), " : ", step(2)), stretch));
  const set = (now, view, lines) => {
    tongues.value = now.tongues;
    sum.value = String(now.maxSum);
    // Where cells end, lines are chosen by their width.
    sum.disabled = now.tongues !== "on";
    curves.set(now.curves);
    labels.set(now.labels, now.curves || lines ? "" : "Labels stand at lines: show the curves, or tongues as lines");
    stretch.value = String(view.stretch);
  };
  return { element, set };
}

const greek = (name, index) => [h("i", {}, name), index ? h("sub", {}, index) : ""];

export function springs(act) {
  const field = (name, label, apply) => {
    const id = unique(name);
    const input = h("input", { id, "data-field": name, spellcheck: "false", autocomplete: "off", autocapitalize: "off", onchange: () => apply(input.value) });
    return { input, element: h("div.entry", {}, h("label", { for: id }, ...label), input) };
  };
  const lambda1 = field("lambda1", ["fast ", ...greek("λ", "1")], (value) => act.springs({ lambda1: value }));
  const lambda2 = field("lambda2", ["slow ", ...greek("λ", "2")], (value) => act.springs({ lambda2: value }));
  const rho = field("rho", [...greek("ρ"), " = ", ...greek("λ", "2"), "/", ...greek("λ", "1")], (value) => act.springs({ rho: value }));
  const slider = h("input", { type: "range", min: -4, max: 1, step: 0.01, "aria-label": "rho, from 1/10,000 to 10", oninput: () => act.slide(String(Number((10 ** slider.value).toPrecision(2)))) });
  const said = h("p.error", { role: "alert" });
  const element = section("Springs", rho.element, slider, lambda1.element, lambda2.element, said);
  const set = (now) => {
    for (const [input, value] of [[lambda1.input, now.lambda1], [lambda2.input, now.lambda2], [rho.input, now.rho]]) if (document.activeElement !== input) input.value = value;
    if (document.activeElement !== slider && now.values.rho > 0) slider.value = String(Math.log10(now.values.rho));
    slider.setAttribute("aria-valuetext", now.rho);
    refuse(null);
  };
  const refuse = (error) => {
    said.textContent = error?.message ?? "";
    for (const input of [lambda1.input, lambda2.input, rho.input]) input.setAttribute("aria-invalid", String(Boolean(error && [error.field, error.asked].includes(input.dataset.field))));
  };
  return { element, set, refuse };
}

export function going(act) {
  const field = (index) => h("input", { id: unique(`go-h${index}`), spellcheck: "false", autocomplete: "off", placeholder: index === 1 ? "12/25" : "1.12" });
  const [first, second] = [field(1), field(2)];
  const said = h("p.error", { role: "alert" });
  const go = (event) => {
    event.preventDefault();
    said.textContent = act.go(first.value, second.value) ? "" : "Two positive rationals, please: 12/25, 0.48 or 1e-3.";
  };
  const form = h("form", { onsubmit: go },
    h("div.entry", {}, h("label", { for: first.id }, step(1)), first), h("div.entry", {}, h("label", { for: second.id }, step(2)), second),
    h("div.row", {}, h("button", { type: "submit" }, "Go to this pair")));
  return { element: section("Go to", form, said) };
}

export function saving(act, own) {
  const said = h("p.quiet", { role: "status" });
  const button = (label, title, work) => h("button", { type: "button", title, onclick: async () => (said.textContent = (await work()) ?? "") }, label);
  return {
    element: section("Save and share",
      h("div.row", {},
        button("SVG", "The picture, drawn by the program", () => act.picture("svg")), button("PNG", "The picture as pixels", () => act.picture("png")),
        button("Scene file", "What is shown, for kickdrift run", act.scene),
        own ? button("Copy link", "The address of this view", act.link) : null),
      said),
  };
}
