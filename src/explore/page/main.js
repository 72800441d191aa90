// `kickdrift explore` in a browser: what is shown, and how it changes.

import { Past, read, written } from "./address.js";
import { fetched, latest, questions } from "./ask.js";
import { card, pinned, readout, spoken } from "./card.js";
import { DARK, LIGHT } from "./colours.js";
import { download } from "./dom.js";
import { Drawer } from "./drawer.js";
import { multiply, parse, powerOfTwo, text } from "./exact.js";
import { Input } from "./input.js";
import { layout } from "./layout.js";
import { StabilityMap } from "./map.js";
import { legend } from "./panels.js";
import { cutOf, cutThrough, pick, typed } from "./picking.js";
import { exactly, grouped, mathematics, number, spacing } from "./writing.js";

/** Bits that a centre is known to beyond the zoom at which it was chosen: levels that one may go down and still find it. */
const DEEPER = 256;

/** Kinds as a tile of each layer tells them; undefined where it does not. */
const KIND = ["elliptic", "hyperbolic", "parabolic", "coexistence"];
const kindOf = (what, value) => {
  if (value === undefined) return undefined;
  if (what === "verdict") return KIND[value & 3];
  return (what === "growth" ? value > 0 : value[0] !== -32768) ? "hyperbolic" : undefined;
};

/** Why there is no verdict. */
const costs = (error) => {
  if (!error.tooCostly) return error.message;
  const { cost, unit } = error.tooCostly;
  return cost === null ? "This verdict would cost too much." : `This verdict would cost ${number(Number(cost), 2)} ${unit ?? "kicks"}.`;
};

/**
 * Puts the page into an element. `ask(path, params, signal)` reaches the server and resolves to {status, type, bytes};
 * `own`: the page is ours, with its address and history. Returns the explorer, with `ready` (a promise) and `remove()`.
 */
export function mount(element, { ask = fetched, own = ask === fetched } = {}) {
  return new Explorer(element, ask, own);
}

class Explorer {
  constructor(element, ask, own) {
    Object.assign(this, { questions: questions(ask), own, tool: "move" });
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.dark.addEventListener("change", () => this.themed());
    this.state = { what: "verdict", tongues: "auto", maxSum: 40, curves: false, labels: true, pin: null, cut: null, strip: null, system: false };
    this.page = layout(element, this.state, this.#acts());
    this.past = new Past(own, (saved) => this.restore(saved));
    this.ready = this.#start().catch((error) => this.page.said.append(error.message));
  }

  async #start() {
    const saved = this.own ? read(location.hash) : {};
    const springs = saved.lambda1 && saved.lambda2 ? { lambda1: saved.lambda1, lambda2: saved.lambda2 } : {};
    this.begun = await this.questions.json("start", springs);
    this.#springs(this.begun);
    this.state.step = (saved.step && parse(saved.step) ? saved.step : this.begun.step) ?? "1/1000";
    const step = parse(this.state.step);
    this.map = new StabilityMap(this.page.canvas, this.questions, step, () => this.settings(), (status) => this.#told(status));
    // A system of other than two springs has no plane of step pairs.
    const alone = Boolean(this.begun.system && !this.begun.lambda1);
    this.map.idle = alone;
    this.page.root.dataset.alone = String(alone);
    this.state.system = alone;
    this.drawer = new Drawer(this.page.drawer, this.questions, () => this.settings(), this.#drawerActs());
    this.input = new Input(this.map, this.#inputActs(), () => this.tool);
    this.#questionsOfPoints();
    // Numbers of the axes in the right face from the first picture on.
    const faces = document.fonts ? [document.fonts.load('15px "Libertinus Serif"'), document.fonts.load('italic 15px "Libertinus Serif"')] : [];
    Promise.all(faces).then(() => this.map.redraw(), () => {});
    this.#measure();
    new ResizeObserver(() => this.#measure()).observe(this.page.frame);
    this.map.home = () => this.map.view.fit(this.begun.window ?? [0, 1, 0, 1]);
    if (!this.map.view.restore(saved.view)) this.map.home();
    this.#take(saved);
    this.past.record(() => this.saved(), true);
    this.#refresh();
  }

  /** What the pictures need to know. */
  settings() {
    const { state, map } = this;
    const palette = this.palette;
    const frequency = Math.sqrt(Math.abs(state.values?.lambda1 ?? 1) + Math.abs(state.values?.lambda2 ?? 0)) || 1;
    const layer = { lambda1: state.lambda1, lambda2: state.lambda2, what: state.what, step: state.step, exactStep: map?.view.step, stretch: map?.view.stretch ?? 0, frequency };
    return { ...state, layer, palette, frequency, unit: this.begun?.unit ?? "time", pin: state.pin?.pair ?? null };
  }

  get palette() {
    const chosen = this.page.root.dataset.theme;
    return (chosen ? chosen === "dark" : this.dark.matches) ? DARK : LIGHT;
  }

  themed(choice) {
    if (choice) this.page.root.dataset.theme = choice;
    this.#refresh();
    this.drawer?.paint();
  }

  #springs({ lambda1, lambda2, rho, values }) {
    Object.assign(this.state, { lambda1, lambda2, rho: rho ?? number(values?.rho, 6), values: values ?? { lambda1: 1, lambda2: 0, rho: 0 } });
  }

  /** All that the address says. */
  saved() {
    const { state, map } = this;
    const { lambda1, lambda2, step, what, pin, cut, strip } = state;
    return {
      lambda1, lambda2, step, view: map.view.save(), what: what === "verdict" ? "" : what, tongues: state.tongues === "auto" ? "" : state.tongues,
      maxSum: state.maxSum === 40 ? "" : String(state.maxSum), curves: state.curves ? "1" : "", labels: state.labels ? "" : "0",
      pin: pin ? pin.text.join(",") : "", cut: cut ? [cut.kind, cut.value, cut.lo, cut.hi].join(",") : "", strip: strip ?? "", system: state.system ? "1" : "",
    };
  }

  #take(saved) {
    const { state } = this;
    state.what = KINDS_OF_COLOUR.includes(saved.what) ? saved.what : "verdict";
    state.tongues = ["on", "off"].includes(saved.tongues) ? saved.tongues : "auto";
    state.maxSum = Math.min(400, Math.max(2, Number(saved.maxSum) || 40));
    Object.assign(state, { curves: saved.curves === "1", labels: saved.labels !== "0", system: saved.system === "1" || this.map.idle });
    const pair = saved.pin ? typed(...saved.pin.split(",")) : null;
    this.#pin(pair);
    const [kind, value, lo, hi] = (saved.cut ?? "").split(",");
    state.cut = ["h1", "h2", "ratio"].includes(kind) && [value, lo, hi].every(parse) ? { kind, value, lo, hi } : null;
    state.strip = /^\d{1,9}\/\d{1,9}$/.test(saved.strip ?? "") ? saved.strip : null;
  }

  /** Goes where an address says: undo, redo, a shared link. */
  async restore(saved) {
    if (!this.map) return;
    const { state } = this;
    if (saved.lambda1 && saved.lambda2 && (saved.lambda1 !== state.lambda1 || saved.lambda2 !== state.lambda2)) {
      this.#springs(await this.questions.json("start", { lambda1: saved.lambda1, lambda2: saved.lambda2 }));
    }
    if (saved.step && parse(saved.step)) [state.step, this.map.view.step] = [saved.step, parse(saved.step)];
    this.input.halt();
    if (!this.map.view.restore(saved.view)) this.map.home();
    this.#take(saved);
    this.#refresh();
  }

  /** Brings every part in line with the state. */
  #refresh() {
    if (!this.map) return;
    const now = this.settings();
    const { page, state } = this;
    page.colours.choice.choose(state.what);
    legend(page.colours.host, now);
    page.over.set(state, this.map.view);
    page.springs.set(state);
    const [a, b] = [state.lambda1, state.lambda2].map((x) => mathematics(x ?? ""));
    page.subject(this.begun.title, a, b, mathematics(state.rho), this.begun.unit);
    page.systemButton.hidden = !this.begun.system || this.map.idle;
    this.drawer.show(state.cut ? { ...state.cut, kind: "cut", along: state.cut.kind } : state.strip ? { kind: "strip", ratio: state.strip } : state.system ? { kind: "system", outer: state.outer } : null);
    page.tools.choose(this.tool);
    page.canvas.dataset.tool = this.tool;
    this.map.redraw();
  }

  /** Something was changed by hand. */
  #change(values = {}) {
    Object.assign(this.state, values);
    this.#refresh();
    this.past.record(() => this.saved());
  }

  #measure() {
    const { clientWidth, clientHeight } = this.page.frame;
    if (clientWidth && clientHeight) this.map.resize(clientWidth, clientHeight);
  }

  /** The grid in words, or what is shown instead of it. */
  #told(status) {
    const { view } = this.map;
    const [d1, d2] = [0, 1].map((axis) => spacing(view.unit(axis), status.level));
    this.status = status;
    const parts = [];
    if (!status.costly) parts.push(`Every cell is one exact verdict: multiples of d₁ = ${d1} and d₂ = ${d2}.`);
    else {
      const { cost, limit, unit } = status.costly;
      parts.push(cost === null ? `Cells of d₁ = ${d1} would cost too much.` : `A tile of d₁ = ${d1} would cost ${number(Number(cost), 2)} ${unit ?? "kicks"} (limit ${number(Number(limit), 2)}).`);
      if (!status.vectors) parts.push("Tongues as lines are switched off.");
      else if (status.sum) parts.push(`Shown instead: certified tongues wider than a cell, all ratios with p + q ≤ ${grouped(status.sum)}.`);
      else parts.push("Asking for certified tongues instead …");
      if (status.pale !== null) parts.push(`Pale: verdicts on a coarser grid, d₁ = ${spacing(view.unit(0), status.pale)}.`);
    }
    if (!status.costly && status.vectors && status.sum) parts.push(`Lines: tongues with p + q ≤ ${status.sum}.`);
    if (status.refused && status.vectors) parts.push(status.refused);
    if (status.fault) parts.push(status.fault);
    this.page.note.say(parts.join(" "));
    this.page.where.textContent = `zoom ${status.level}`.replace("-", "−");
    this.page.offsets(status.offsets);
    this.page.root.dataset.busy = String(Boolean(status.waiting));
  }

  // --- one pair -------------------------------------------------------------------------------------------------

  #where() {
    return { lambda1: this.state.lambda1, lambda2: this.state.lambda2 };
  }

  #questionsOfPoints() {
    const point = async (picked, signal) => {
      const [h1, h2] = picked.pair.map(text);
      // Where cells cost too much no pair of theirs can be decided: the simplest ratio within half a cell stands for it.
      return this.questions.json("point", { ...this.#where(), h1, h2, ...(picked.within ? { within: picked.within } : {}) }, signal);
    };
    this.askHover = latest(async (picked, signal) => {
      const told = await point(picked, signal).catch((error) => {
        if (signal.aborted) throw error;
        return { said: costs(error) };
      });
      const { unit } = this.settings();
      // What was decided is said, also where it is another pair of the same cell.
      const pair = told.input ? [told.input.h1, told.input.h2].map(parse) : picked.pair;
      readout(this.page.readout, pair, told.kind, told.said ? null : told, unit, told.said);
      this.#speak(pair, told);
    }, 70);
    this.askPin = latest(async (pin, signal) => {
      const told = await point(pin, signal).catch((error) => {
        if (signal.aborted) throw error;
        return { error: costs(error) };
      });
      if (told.input) Object.assign(pin, pinned([told.input.h1, told.input.h2].map(parse)), { within: null });
      pin.told = told;
      this.#card();
      this.map.redraw();
      this.past.record(() => this.saved());
    });
  }

  /** The live region hears of a pair once the pointer rests. */
  #speak(pair, told) {
    clearTimeout(this.speaking);
    this.speaking = setTimeout(() => {
      this.page.live.textContent = `h1 ${exactly(pair[0])}, h2 ${exactly(pair[1])}: ${told.said ?? spoken(told.kind)}`;
    }, 500);
  }

  #pin(pair, within = null) {
    const same = pair && this.state.pin && pinned(pair).text.join() === this.state.pin.text.join() && this.state.pin.springs === `${this.state.lambda1}|${this.state.lambda2}`;
    if (same) return;
    this.state.pin = pair ? { ...pinned(pair), springs: `${this.state.lambda1}|${this.state.lambda2}`, within, told: null } : null;
    if (this.state.pin && this.askPin) this.askPin(this.state.pin);
    this.#card();
  }

  #card() {
    const { pin } = this.state;
    this.page.pinned(Boolean(pin));
    if (pin) card(this.page.card, pin, pin.told, this.settings().unit, this.#cardActs(pin));
  }

  // --- what can be done -----------------------------------------------------------------------------------------

  #inputActs() {
    const redraw = () => this.map.redraw();
    const pickAt = (at, reach) => {
      const picked = pick(this.map, at, reach, Boolean(this.status?.vectors));
      const { view } = this.map;
      if (picked && !picked.line && this.status?.costly) picked.within = text(multiply(view.unit(1), powerOfTwo(-view.level - 1)));
      return picked;
    };
    return {
      moved: redraw,
      settled: () => {
        redraw();
        this.past.record(() => this.saved());
      },
      hover: (at) => {
        const picked = pickAt(at, 7);
        this.map.cursor = picked && at;
        redraw();
        if (!picked) return;
        const { view } = this.map;
        const value = picked.cells && this.map.tiles.value(this.settings().layer, view.level, picked.cells);
        readout(this.page.readout, picked.pair, kindOf(this.state.what, value ?? undefined), null, this.settings().unit);
        if (!this.map.moving) this.askHover(picked);
      },
      leave: () => {
        this.map.cursor = null;
        this.askHover.stop();
        redraw();
      },
      click: (at, reach) => {
        const picked = pickAt(at, reach);
        if (!picked) return;
        const now = performance.now();
        if (!(now - this.clicked < 500)) this.unclicked = this.state.pin;
        this.clicked = now;
        this.#pin(picked.pair, picked.within);
        this.#change();
      },
      // A double click zooms: what it pinned on the way is taken back.
      unclick: () => {
        this.#pin(this.unclicked?.pair ?? null);
        this.#change();
      },
      home: () => this.home(),
      draw: (from, to) => {
        this.drawn = cutOf(this.map, this.tool, from, to);
        this.map.draft = this.drawn && this.map.cutLine(this.drawn);
        redraw();
      },
      drawn: () => {
        this.map.draft = null;
        this.tool = "move";
        this.#change(this.drawn ? { cut: this.drawn } : {});
        this.drawn = null;
      },
      escape: () => {
        this.tool = "move";
        this.#pin(null);
        this.#change({ cut: null, strip: null });
      },
    };
  }

  home() {
    this.input.halt();
    this.map.home();
    this.#change();
  }

  #cardActs(pin) {
    const [h1, h2] = pin.text;
    const save = async (question, name) => {
      const { bytes, type } = await this.questions.bytes(question, { ...this.#where(), h1, h2 });
      download(name, type, bytes);
    };
    // Why there is no file, such as no certificate for numbers with pi, stands on the card.
    const said = async (work) => {
      pin.said = await work.then(() => null, (error) => error.message);
      this.#card();
    };
    return {
      copy: (words) => navigator.clipboard?.writeText(words).then(() => (this.page.live.textContent = "copied")),
      certificate: () => said(save("certificate", "verdict.v")),
      document: () => said(save("document", "verdict.json")),
      centre: () => {
        this.map.view.centreOn(pin.pair, DEEPER);
        this.#change();
        this.page.canvas.focus();
      },
      cut: (kind) => this.#change({ cut: cutThrough(this.map, kind, pin.pair) }),
      strip: () => this.#change({ cut: null, strip: `${pin.told.p}/${pin.told.q}` }),
      close: () => {
        this.#pin(null);
        this.#change();
      },
    };
  }

  #drawerActs() {
    return {
      outer: (outer) => this.#change({ outer }),
      close: (kind) => this.#change(kind === "cut" ? { cut: null } : kind === "strip" ? { strip: null } : { system: false }),
      probe: (t) => {
        this.map.probe = this.state.cut ? t : null;
        this.map.redraw();
      },
      rho: (value) => this.springs({ rho: value }),
      ratio: (value) => /^\d+\/\d+$/.test(value.trim()) && this.#change({ strip: value.trim() }),
    };
  }

  /** Takes new springs once the program has read them. */
  async springs(entered) {
    const { lambda1, lambda2 } = this.state;
    const params = entered.rho !== undefined ? { lambda1, rho: entered.rho } : { lambda1, lambda2, ...entered };
    try {
      const said = await this.questions.json("start", params);
      this.#springs(said);
      if (this.state.pin) this.#pin(this.state.pin.pair);
      this.#change();
    } catch (error) {
      this.page.springs.refuse(Object.assign(error, { asked: Object.keys(entered)[0] }));
    }
  }

  #acts() {
    const slide = latest(async (rho) => this.springs({ rho }), 80);
    return {
      what: (what) => this.#change({ what }), tongues: (tongues) => this.#change({ tongues }),
      maxSum: (maxSum) => this.#change({ maxSum: Math.min(400, Math.max(2, Math.round(maxSum) || 40)) }),
      curves: (curves) => this.#change({ curves }), labels: (labels) => this.#change({ labels }),
      stretch: (stretch) => {
        this.map.view.restretch(stretch);
        this.#change();
      },
      springs: (entered) => this.springs(entered), slide,
      go: (first, second) => {
        const pair = typed(first, second);
        if (!pair) return false;
        this.map.view.centreOn(pair, DEEPER);
        this.#pin(pair);
        this.#change();
        return true;
      },
      tool: (tool) => {
        this.tool = tool;
        this.#refresh();
      },
      zoom: (levels) => this.input.zoomBy(levels), home: () => this.home(),
      undo: () => this.past.undo(), redo: () => this.past.redo(),
      theme: () => this.themed(this.palette === DARK ? "light" : "dark"),
      system: () => this.#change({ system: !this.state.system, cut: null, strip: null }),
      picture: (format) => this.#save("picture", format), scene: () => this.#save("scene", "json"),
      link: async () => {
        await navigator.clipboard.writeText(`${location.href.split("#")[0]}${written(this.saved())}`);
        return "copied";
      },
    };
  }

  /** The picture or scene of the window shown, on the grid shown; deep down the picture is what the canvas has. */
  async #save(question, format) {
    const { view } = this.map;
    const [h1, h2] = view.window().map(({ lo, hi }) => `${text(lo)}..${text(hi)}`);
    const [step, step2] = [0, 1].map((axis) => text(multiply(view.unit(axis), powerOfTwo(-view.level))));
    const { state } = this;
    const params = { ...this.#where(), h1, h2, step, step2, what: state.what, ...(state.curves ? { curves: 1 } : {}), ...(question === "picture" ? { format } : {}) };
    try {
      const { bytes, type } = await this.questions.bytes(question, params);
      download(question === "picture" ? `kickdrift.${format}` : "scene.json", type, bytes);
      return "saved";
    } catch (error) {
      if (format !== "png") return error.message;
      const blob = await new Promise((done) => this.page.canvas.toBlob(done));
      download("kickdrift.png", "image/png", blob);
      return "saved as it stands on the screen";
    }
  }

  remove() {
    this.input?.halt();
    this.page.root.remove();
    removeEventListener("popstate", this.past.listen);
  }
}

const KINDS_OF_COLOUR = ["verdict", "growth", "family"];
