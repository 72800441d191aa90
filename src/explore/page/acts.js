// What can be done: on the map, on a card, below the map, beside it.

import { written } from "./address.js";
import { latest } from "./ask.js";
import { DARK } from "./colours.js";
import { download } from "./dom.js";
import { multiply, powerOfTwo, text } from "./exact.js";
import { readout } from "./card.js";
import { cutOf, cutThrough, pick, typed } from "./picking.js";
import { ratio, summed } from "./state.js";

/** Bits that a centre is known to beyond the zoom at which it was chosen: levels that one may go down and still find it. */
const DEEPER = 256;

/** Two clicks within so many milliseconds are a double one. */
const DOUBLE = 500;

/** Kinds as a tile of each layer tells them; undefined where it does not. */
const KIND = ["elliptic", "hyperbolic", "parabolic", "coexistence"];
const kindOf = (what, value) => {
  if (value === undefined) return undefined;
  if (what === "verdict") return KIND[value & 3];
  return (what === "growth" ? value > 0 : value[0] !== -32768) ? "hyperbolic" : undefined;
};

/** The pair below a pixel, with the cell's value where its tile is here; of a cell that cannot be decided, half its height as `within`. */
function picked(explorer, at, reach) {
  const { map, state, status } = explorer;
  const { view } = map;
  const cells = [view.cell(at[0], 0), view.cell(at[1], 1)];
  const value = map.tiles.value(explorer.settings().layer, view.level, cells);
  // A line is picked where one sees it: over cells that were asked for too, or where there are none.
  const found = pick(map, at, reach, Boolean(status?.vectors) && (state.tongues === "on" || value === undefined));
  if (!found) return null;
  const lost = !found.line && status?.costly && value === undefined;
  return { ...found, value: found.line ? undefined : value, within: lost ? text(multiply(view.unit(1), powerOfTwo(-view.level - 1))) : null };
}

export function onMap(explorer) {
  const { map, pairs, page } = explorer;
  let clicked = { at: -Infinity, before: null };
  let stroke = null;
  return {
    moved: () => map.redraw(),
    settled: () => {
      map.redraw();
      explorer.record();
    },
    hover: (at) => {
      const found = picked(explorer, at, 7);
      map.cursor = found && at;
      map.redraw();
      if (!found) return;
      found.kind = kindOf(explorer.state.what, found.value);
      readout(page.readout, found.pair, found.kind, null, explorer.settings().unit);
      if (!map.moving) pairs.askHover(found);
    },
    leave: () => {
      map.cursor = null;
      pairs.askHover.stop();
      map.redraw();
    },
    click: (at, reach) => {
      const found = picked(explorer, at, reach);
      if (!found) return;
      const now = performance.now();
      if (now - clicked.at > DOUBLE) clicked.before = pairs.pin;
      clicked.at = now;
      pairs.take(found.pair, found.within, new Promise((resolve) => setTimeout(resolve, DOUBLE)));
      explorer.change();
    },
    // A double click zooms: what it pinned on the way is taken back.
    unclick: () => {
      pairs.take(clicked.before?.pair ?? null);
      explorer.change();
    },
    home: () => explorer.home(),
    draw: (from, to) => {
      stroke = cutOf(map, explorer.tool, from, to);
      map.draft = stroke && map.cutLine(stroke);
      map.redraw();
    },
    // With Shift a drag draws a box to zoom to.
    frame: (box) => {
      map.framed = box;
      map.redraw();
    },
    drawn: () => {
      map.draft = null;
      explorer.tool = "move";
      explorer.change(stroke ? { cut: stroke } : {});
      stroke = null;
    },
    escape: () => {
      explorer.tool = "move";
      pairs.take(null);
      explorer.change({ cut: null, strip: null });
    },
  };
}

export function onCard(explorer, pin) {
  const { map, pairs, page } = explorer;
  const save = async (question, name) => {
    const [h1, h2] = pin.text;
    const { bytes, type } = await explorer.questions.bytes(question, { ...explorer.springs(), h1, h2 });
    download(name, type, bytes);
  };
  return {
    copy: (words) => navigator.clipboard?.writeText(words).then(() => (page.live.textContent = "copied")),
    certificate: () => pairs.said(pin, save("certificate", "verdict.v")),
    document: () => pairs.said(pin, save("document", "verdict.json")),
    centre: () => {
      map.view.centreOn(pin.pair, DEEPER);
      explorer.change();
      page.canvas.focus();
    },
    cut: (kind) => explorer.change({ cut: cutThrough(map, kind, pin.pair) }),
    strip: () => explorer.change({ cut: null, strip: `${pin.told.p}/${pin.told.q}` }),
    close: () => {
      pairs.take(null);
      explorer.change();
    },
  };
}

export function onDrawer(explorer) {
  const { map } = explorer;
  const none = { cut: { cut: null }, strip: { strip: null }, system: { system: false } };
  return {
    outer: (outer) => explorer.change({ outer }),
    at: (at) => explorer.change({ at }),
    close: (kind) => explorer.change(none[kind]),
    probe: (t) => {
      map.probe = explorer.state.cut ? t : null;
      map.redraw();
    },
    rho: (rho) => explorer.enter({ rho }),
    ratio: (source) => ratio(source) && explorer.change({ strip: ratio(source) }),
  };
}

export function onPanels(explorer) {
  const change = (name, of = (value) => value) => (value) => explorer.change({ [name]: of(value) });
  return {
    what: change("what"), tongues: change("tongues"), maxSum: change("maxSum", summed), curves: change("curves"), labels: change("labels"),
    stretch: (stretch) => {
      explorer.map.view.restretch(stretch);
      explorer.change();
    },
    springs: (entered) => explorer.enter(entered),
    slide: latest((rho) => explorer.enter({ rho }), 80),
    go: (first, second) => {
      const pair = typed(first, second);
      if (!pair) return false;
      explorer.map.view.centreOn(pair, DEEPER);
      explorer.pairs.take(pair, null, Promise.resolve());
      explorer.change();
      return true;
    },
    tool: (tool) => {
      explorer.tool = tool;
      explorer.refresh();
    },
    zoom: (levels) => explorer.input.zoomBy(levels), home: () => explorer.home(),
    undo: () => explorer.past.undo(), redo: () => explorer.past.redo(),
    theme: () => explorer.themed(explorer.palette === DARK ? "light" : "dark"),
    system: () => explorer.change({ system: !explorer.state.system, cut: null, strip: null }),
    picture: (format) => save(explorer, "picture", format), scene: () => save(explorer, "scene", "json"),
    link: async () => {
      await navigator.clipboard.writeText(`${location.href.split("#")[0]}${written(explorer.saved())}`);
      return "copied";
    },
  };
}

/** The picture or scene of the window shown, on the grid shown; deep down the picture is what the canvas has. */
async function save({ map: { view }, state, questions, page, springs }, question, format) {
  const [h1, h2] = view.window().map(({ lo, hi }) => `${text(lo)}..${text(hi)}`);
  const [step, step2] = [0, 1].map((axis) => text(multiply(view.unit(axis), powerOfTwo(-view.level))));
  const params = { ...springs(), h1, h2, step, step2, what: state.what, ...(state.curves ? { curves: 1 } : {}), ...(question === "picture" ? { format } : {}) };
  try {
    const { bytes, type } = await questions.bytes(question, params);
    download(question === "picture" ? `kickdrift.${format}` : "scene.json", type, bytes);
    return "saved";
  } catch (error) {
    if (format !== "png") return error.message;
    const blob = await new Promise((done) => page.canvas.toBlob(done));
    download("kickdrift.png", "image/png", blob);
    return "saved as it stands on the screen";
  }
}
