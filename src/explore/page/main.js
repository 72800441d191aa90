// `kickdrift explore`: what is shown, and how it changes.

import { Past, read } from "./address.js";
import { onCard, onDrawer, onMap, onPanels } from "./acts.js";
import { fetched, questions } from "./ask.js";
import { DARK, LIGHT } from "./colours.js";
import { Drawer } from "./drawer.js";
import { parse } from "./exact.js";
import { told } from "./grid.js";
import { Input } from "./input.js";
import { layout } from "./layout.js";
import { StabilityMap } from "./map.js";
import { Pairs } from "./pairs.js";
import { legend } from "./panels.js";
import { typed } from "./picking.js";
import { plain, saved, taken } from "./state.js";
import { mathematics, number } from "./writing.js";

/**
 * Puts the page into an element. `ask(path, params, signal)` reaches the program and resolves to {status, type, bytes};
 * `own`: the page is ours, with its address and history; `begun`: the answer to `start`, where the host has it. Returns the explorer,
 * with `ready` and `whole` (promises: all is there; the first picture has all its cells and letters) and `remove()`.
 */
export function mount(element, { ask = fetched, own = ask === fetched, begun = null } = {}) {
  return new Explorer(element, ask, own, begun);
}

class Explorer {
  constructor(element, ask, own, begun) {
    Object.assign(this, { questions: questions(ask), own, begun, tool: "move", state: plain() });
    this.springs = () => ({ lambda1: this.state.lambda1, lambda2: this.state.lambda2 });
    this.ended = new AbortController();
    this.dark = matchMedia("(prefers-color-scheme: dark)");
    this.dark.addEventListener("change", () => this.themed(), { signal: this.ended.signal });
    this.page = layout(element, own);
    this.past = new Past(own, (texts) => this.restore(texts), this.ended.signal);
    this.pairs = new Pairs({
      page: this.page, questions: this.questions, springs: this.springs, settings: () => this.settings(), redraw: () => this.map.redraw(),
      record: () => this.record(), cardActs: (pin) => onCard(this, pin),
    });
    this.whole = new Promise((resolve) => (this.drawn = resolve));
    this.ready = this.#start().catch((error) => this.page.said.append(error.message));
  }

  async #start() {
    const texts = this.own ? read(location.hash) : {};
    const springs = texts.lambda1 && texts.lambda2 ? { lambda1: texts.lambda1, lambda2: texts.lambda2 } : {};
    const known = this.begun && Object.entries(springs).every(([name, value]) => this.begun[name] === value);
    if (!known) this.begun = await this.questions.json("start", springs);
    this.#springs(this.begun);
    this.state.step = (texts.step && parse(texts.step) ? texts.step : this.begun.step) ?? "1/1000";
    this.map = new StabilityMap(this.page.canvas, this.questions, parse(this.state.step), () => this.settings(), (status) => this.#told(status));
    // A system of other than two springs has no plane of step pairs.
    const alone = Boolean(this.begun.system && !this.begun.lambda1);
    this.map.idle = alone;
    this.page.root.dataset.alone = String(alone);
    this.map.home = () => this.map.view.fit(this.begun.window ?? [0, 1, 0, 1]);
    Object.assign(this.state, taken(texts));
    this.#measure();
    const restored = this.map.view.restore(texts.view);
    if (!restored) this.map.home();
    // The program works on the first tiles while the rest of the page is built.
    if (!alone) this.map.ask();
    this.page.furnish(this.state, onPanels(this));
    this.drawer = new Drawer(this.page.drawer, this.questions, () => this.settings(), onDrawer(this));
    this.input = new Input(this.map, onMap(this), () => this.tool);
    this.#take(texts);
    this.refresh();
    this.resized = new ResizeObserver(() => this.#measure());
    this.resized.observe(this.page.frame);
    if (!restored) this.#fit();
    // Numbers of the axes are written once their face is here.
    const faces = ["15px", "italic 15px", "600 15px"].map((face) => document.fonts?.load(`${face} "Libertinus Serif"`));
    await Promise.all(faces).catch(() => {});
    this.map.lettered = true;
    this.page.root.dataset.lettered = "true";
    this.map.redraw();
    this.past.record(() => this.saved(), true);
  }

  /** What the pictures need to know. */
  settings() {
    const { state, map } = this;
    const frequency = Math.sqrt(Math.abs(state.values?.lambda1 ?? 1) + Math.abs(state.values?.lambda2 ?? 0)) || 1;
    const layer = { ...this.springs(), what: state.what, step: state.step, exactStep: map?.view.step, stretch: map?.view.stretch ?? 0, frequency };
    return { ...state, layer, palette: this.palette, frequency, unit: this.begun?.unit ?? "time", pin: this.pairs?.pin?.pair ?? null };
  }

  get palette() {
    const chosen = this.page.root.dataset.theme;
    return (chosen ? chosen === "dark" : this.dark.matches) ? DARK : LIGHT;
  }

  themed(choice) {
    if (choice) this.page.root.dataset.theme = choice;
    this.refresh();
    this.drawer?.paint();
  }

  #springs({ lambda1, lambda2, rho, values }) {
    Object.assign(this.state, { lambda1, lambda2, rho: rho ?? number(values?.rho, 6), values: values ?? { lambda1: 1, lambda2: 0, rho: 0 } });
  }

  saved() {
    return saved({ ...this.state, pin: this.pairs.pin }, this.map.view);
  }

  record() {
    this.past.record(() => this.saved());
  }

  #take(texts) {
    Object.assign(this.state, taken(texts));
    this.state.system ||= this.map.idle;
    this.pairs.take(texts.pin ? typed(...texts.pin.split(",")) : null);
  }

  /** Goes where an address says: undo, redo, a shared link. */
  async restore(texts) {
    if (!this.map) return;
    const { state } = this;
    if (texts.lambda1 && texts.lambda2 && (texts.lambda1 !== state.lambda1 || texts.lambda2 !== state.lambda2)) {
      this.#springs(await this.questions.json("start", { lambda1: texts.lambda1, lambda2: texts.lambda2 }));
    }
    if (texts.step && parse(texts.step)) [state.step, this.map.view.step] = [texts.step, parse(texts.step)];
    this.input.halt();
    if (!this.map.view.restore(texts.view)) this.#fit();
    this.#take(texts);
    this.refresh();
  }

  /** Brings every part in line with the state. */
  refresh() {
    if (!this.map) return;
    const now = this.settings();
    const { page, state } = this;
    page.colours.choice.choose(state.what);
    legend(page.colours.host, now);
    page.over.set(state, this.map.view, this.status?.vectors);
    page.springs.set(state);
    const [a, b] = [state.lambda1, state.lambda2].map((x) => mathematics(x ?? ""));
    page.subject(this.begun.title, a, b, mathematics(state.rho), this.begun.unit);
    page.systemButton.hidden = !this.begun.system || this.map.idle;
    this.drawer.show(state.cut ? { ...state.cut, kind: "cut", along: state.cut.kind } : state.strip ? { kind: "strip", ratio: state.strip } : state.system ? { kind: "system", outer: state.outer, at: state.at } : null);
    page.tools.choose(this.tool);
    page.canvas.dataset.tool = this.tool;
    this.map.redraw();
  }

  /** Something was changed by hand. */
  change(values = {}) {
    Object.assign(this.state, values);
    this.refresh();
    this.record();
  }

  home() {
    this.input.halt();
    this.#fit();
    this.change();
  }

  #fit() {
    this.map.home();
    this.fitted = this.map.view.save();
    this.page.over.set(this.state, this.map.view, this.status?.vectors);
  }

  /** Takes the frame's size; a view that shows the whole window goes on doing so. */
  #measure() {
    const { clientWidth, clientHeight } = this.page.frame;
    if (!clientWidth || !clientHeight) return;
    const whole = this.fitted === this.map.view.save();
    const lost = this.map.resize(clientWidth, clientHeight);
    if (whole) {
      this.#fit();
      this.past.rewrite(this.saved());
    }
    if (lost) this.map.repaint();
  }

  #told(status) {
    const { page, state } = this;
    if (status.vectors !== this.status?.vectors) page.over?.set(state, this.map.view, status.vectors);
    this.status = status;
    page.note(told(status, this.map.view));
    page.where(`zoom ${status.level}`.replace("-", "−"));
    page.offsets(status.offsets);
    page.busy(Boolean(status.waiting));
    if (status.whole) this.drawn();
  }

  /** Takes new springs once the program has read them. */
  async enter(entered) {
    const { lambda1 } = this.state;
    const params = entered.rho !== undefined ? { lambda1, rho: entered.rho } : { ...this.springs(), ...entered };
    try {
      this.#springs(await this.questions.json("start", params));
      if (this.pairs.pin) this.pairs.take(this.pairs.pin.pair);
      this.change();
    } catch (error) {
      this.page.springs.refuse(Object.assign(error, { asked: Object.keys(entered)[0] }));
    }
  }

  remove() {
    this.ended.abort();
    this.input?.halt();
    this.resized?.disconnect();
    this.page.root.remove();
  }
}
