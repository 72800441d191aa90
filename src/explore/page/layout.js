// The page's frame: what stands where.

import { begin, formulas, h, iconButton, segmented } from "./dom.js";
import { colours, going, over, saving, springs } from "./panels.js";

const TOOLS = [["move", "Move the map", "move"], ["h1", "Cut at fixed h1", "upright"], ["h2", "Cut at fixed h2", "level"], ["ratio", "Cut along a ratio h2/h1", "ratio"]];

/** Builds the page into `element`, whose address it may share if it is its `own`; returns its parts. */
export function layout(element, state, act, own) {
  begin();
  const canvas = h("canvas", { tabindex: 0, role: "application", "aria-roledescription": "map", "aria-label": "Map of the step pairs h1, h2. Arrows move, plus and minus zoom, 0 shows all, Enter pins the pair at the centre.", "data-tool": "move" });
  const frame = h("div.frame", {}, canvas);
  const words = h("p.words", {}), offsets = h("p.offsets.number", {}), where = h("span.where.number", {});
  let [noted, counted] = ["", ""];
  const live = h("div.unseen", { "aria-live": "polite", role: "status" });
  const readout = h("div.readout", {}, h("p.quiet", {}, "Point at the map, or move it by the arrow keys, to read a pair. A click pins it."));
  const cardHost = h("div.card", {});
  const cardPanel = h("section.panel.pinned", { hidden: true, "aria-label": "Pinned pair" }, cardHost);
  const tools = segmented("What a drag does", "tool", TOOLS, "move", act.tool);
  const systemButton = h("button", { type: "button", onclick: act.system, hidden: true }, "Growth of the system");
  const parts = { colours: colours(state, act), over: over(state, act), springs: springs(act), going: going(act), saving: saving(act, own) };
  const subject = h("p.subject", {});
  const head = h("header", {}, h("h1", {}, "kickdrift ", h("span", {}, "explore")), subject,
    h("div.actions", {}, systemButton, iconButton("undo", "Undo (Ctrl-Z)", act.undo), iconButton("redo", "Redo (Ctrl-Shift-Z)", act.redo), iconButton("theme", "Light or dark", act.theme)));
  const controls = h("div.controls", {}, tools, h("div.zooms", {}, iconButton("plus", "Zoom in", () => act.zoom(1)), iconButton("minus", "Zoom out", () => act.zoom(-1)), iconButton("home", "Show all", act.home)));
  const drawer = h("section.drawer", { hidden: true, "aria-label": "Plot" });
  const note = h("div.note", {}, words, where);
  const main = h("main", {}, h("div.stage", {}, frame, controls), h("div.said", {}, note, offsets), drawer);
  const side = h("aside", { "aria-label": "Readings and settings" },
    h("section.panel.pointer", {}, h("h2", {}, "Under the pointer"), readout), cardPanel,
    parts.colours.element, parts.over.element, parts.springs.element, parts.going.element, parts.saving.element);
  const root = h("div.explore", {}, head, h("div.body", {}, main, side), live);
  root.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || /^(INPUT|TEXTAREA)$/.test(event.target.tagName) && event.target.type !== "radio") return;
    event.preventDefault();
    if (event.shiftKey) act.redo();
    else act.undo();
  });
  // Widths are those of the element, which may be a cell of a notebook. There keys are ours, not the notebook's.
  element.classList.add("explore-host");
  if (!own) {
    element.dataset.lmSuppressShortcuts = "true";
    root.addEventListener("keydown", (event) => event.stopPropagation());
  }
  element.replaceChildren(root);
  return {
    root, canvas, frame, live, readout, card: cardHost, drawer, tools, systemButton, where, said: words, ...parts,
    pinned: (shown) => (cardPanel.hidden = !shown),
    note: { say: (said) => said !== noted && words.replaceChildren(...formulas((noted = said))) },
    offsets: (bases) => {
      const said = (bases ?? []).map((base, axis) => base && `Along h${"₁₂"[axis]} the numbers count from ${base}.`).filter(Boolean).join(" ");
      if (said !== counted) offsets.replaceChildren(...formulas((counted = said)));
    },
    subject: (title, lambda1, lambda2, rho, unit) => {
      const greek = (name, index, value) => [h("i", {}, name), index ? h("sub", {}, index) : "", ` = ${value}`];
      const all = [title ? h("span.name", {}, title) : null, ...(lambda1 ? [h("span", {}, ...greek("λ", "1", lambda1)), h("span", {}, ...greek("λ", "2", lambda2)), h("span", {}, ...greek("ρ", "", rho))] : []), unit ? h("span", {}, `in ${unit}`) : null];
      subject.replaceChildren(...all.filter(Boolean));
    },
  };
}
