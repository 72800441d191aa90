// The page's frame: what stands where.

import { begin, formulas, h, iconButton, segmented, whenNew } from "./dom.js";
import { colours, going, over, saving, springs } from "./panels.js";

const TOOLS = [["move", "Move the map", "move"], ["h1", "Cut at fixed h1", "upright"], ["h2", "Cut at fixed h2", "level"], ["ratio", "Cut along a ratio h2/h1", "ratio"]];

/**
 * Builds the page into `element`, whose address it may share if it is its `own`: first the map's place, which without any text takes no
 * time to lay out, so that tiles can be asked for; `furnish` adds the rest. Returns its parts.
 */
export function layout(element, own) {
  begin();
  const canvas = h("canvas", { tabindex: 0, role: "application", "aria-roledescription": "map", "aria-label": "Map of the step pairs h1, h2. Arrows move, plus and minus zoom, 0 shows all, Enter pins the pair at the centre.", "data-tool": "move" });
  const frame = h("div.frame", {}, canvas);
  const words = h("p.words", {}), offsets = h("p.offsets.number", {}), where = h("span.where.number", {});
  const live = h("div.unseen", { "aria-live": "polite", role: "status" });
  const [head, stage] = [h("header", {}), h("div.stage", {}, frame)];
  const drawer = h("section.drawer", { hidden: true, "aria-label": "Plot" });
  const main = h("main", {}, stage, h("div.said", {}, h("div.note", {}, words, where), offsets), drawer);
  const side = h("aside", { "aria-label": "Readings and settings" });
  const root = h("div.explore", {}, head, h("div.body", {}, main, side), live);
  // Widths are those of the element, which may be a cell of a notebook. There keys are ours, not the notebook's.
  element.classList.add("explore-host");
  if (!own) {
    element.dataset.lmSuppressShortcuts = "true";
    root.addEventListener("keydown", (event) => event.stopPropagation());
  }
  element.replaceChildren(root);
  const counted = whenNew((said) => offsets.replaceChildren(...formulas(said)));
  return {
    root, canvas, frame, live, drawer, said: words,
    furnish(state, act) {
      Object.assign(this, furnished({ root, head, stage, side }, state, act, own));
    },
    note: whenNew((said) => words.replaceChildren(...formulas(said))),
    where: whenNew((said) => (where.textContent = said)),
    busy: whenNew((waiting) => canvas.setAttribute("aria-busy", String(waiting))),
    offsets: (bases) => counted((bases ?? []).map((base, axis) => base && `Along h${"₁₂"[axis]} the numbers count from ${base}.`).filter(Boolean).join(" ")),
  };
}

/** What stands around the map. */
function furnished({ root, head, stage, side }, state, act, own) {
  const readout = h("div.readout", {}, h("p.quiet", {}, "Point at the map, or move it by the arrow keys, to read a pair. A click pins it."));
  const card = h("div.card", {});
  const cardPanel = h("section.panel.pinned", { hidden: true, "aria-label": "Pinned pair" }, card);
  const tools = segmented("What a drag does", "tool", TOOLS, "move", act.tool);
  const systemButton = h("button", { type: "button", onclick: act.system, hidden: true }, "Growth of the system");
  const parts = { colours: colours(state, act), over: over(state, act), springs: springs(act), going: going(act), saving: saving(act, own) };
  const subject = h("p.subject", {});
  head.append(h("h1", {}, "kickdrift ", h("span", {}, "explore")), subject,
    h("div.actions", {}, systemButton, iconButton("undo", "Undo (Ctrl-Z)", act.undo), iconButton("redo", "Redo (Ctrl-Shift-Z)", act.redo), iconButton("theme", "Light or dark", act.theme)));
  stage.append(h("div.controls", {}, tools, h("div.zooms", {}, iconButton("plus", "Zoom in", () => act.zoom(1)), iconButton("minus", "Zoom out", () => act.zoom(-1)), iconButton("home", "Show all", act.home))));
  side.append(h("section.panel.pointer", {}, h("h2", {}, "Under the pointer"), readout), cardPanel,
    parts.colours.element, parts.over.element, parts.springs.element, parts.going.element, parts.saving.element);
  root.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.key.toLowerCase() !== "z" || /^(INPUT|TEXTAREA)$/.test(event.target.tagName) && !["radio", "range", "checkbox"].includes(event.target.type)) return;
    event.preventDefault();
    if (event.shiftKey) act.redo();
    else act.undo();
  });
  return {
    readout, card, tools, systemButton, ...parts,
    pinned: (shown) => (cardPanel.hidden = !shown),
    subject: (title, lambda1, lambda2, rho, unit) => {
      const greek = (name, index, value) => [h("i", {}, name), index ? h("sub", {}, index) : "", ` = ${value}`];
      const all = [title ? h("span.name", {}, title) : null, ...(lambda1 ? [h("span", {}, ...greek("λ", "1", lambda1)), h("span", {}, ...greek("λ", "2", lambda2)), h("span", {}, ...greek("ρ", "", rho))] : []), unit ? h("span", {}, `in ${unit}`) : null];
      subject.replaceChildren(...all.filter(Boolean));
    },
  };
}
