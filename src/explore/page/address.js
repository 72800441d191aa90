// The state in the address, so that a view can be shared, undone and brought back bit for bit.

const KEYS = { lambda1: "l1", lambda2: "l2", step: "d", view: "v", what: "w", tongues: "t", maxSum: "n", curves: "c", labels: "b", pin: "p", cut: "x", strip: "s", system: "y", outer: "o", at: "a" };

/** `state`: texts; what is empty is left out. */
export function written(state) {
  const query = new URLSearchParams();
  for (const [key, short] of Object.entries(KEYS)) if (state[key]) query.set(short, state[key]);
  return `#${query}`.replace(/%2F/g, "/").replace(/%2C/g, ",").replace(/%5E/g, "^");
}

export function read(hash) {
  const query = new URLSearchParams(hash.replace(/^#/, ""));
  return Object.fromEntries(Object.entries(KEYS).map(([key, short]) => [key, query.get(short) ?? ""]));
}

/** Undo and redo over the browser's own history until `signal`, or over a list where the page is a guest and the address not ours. */
export class Past {
  constructor(own, restore, signal) {
    Object.assign(this, { own, restore, list: [], at: -1, timer: null });
    if (own) addEventListener("popstate", () => restore(read(location.hash)), { signal });
  }

  get #place() {
    return this.own ? (history.state?.kickdrift ?? 0) : this.at;
  }

  /** Takes a state down once nothing has changed for a moment. */
  record(state, now = false) {
    clearTimeout(this.timer);
    if (now) this.#write(state());
    else this.timer = setTimeout(() => this.#write(state()), 350);
  }

  #write(state) {
    const hash = written(state);
    if (!this.own) {
      if (this.list[this.at] === hash) return;
      this.list = [...this.list.slice(0, this.at + 1), hash];
      this.at += 1;
    } else if (!location.hash) history.replaceState({ kickdrift: 0 }, "", hash);
    else if (location.hash !== hash) history.pushState({ kickdrift: this.#place + 1 }, "", hash);
  }

  /** The same state in another form: what was taken down of it is written again. */
  rewrite(state) {
    const hash = written(state);
    if (this.own && location.hash) history.replaceState(history.state, "", hash);
    if (!this.own && this.at >= 0) this.list[this.at] = hash;
  }

  undo() {
    if (this.#place < 1) return;
    if (this.own) history.back();
    else this.restore(read(this.list[--this.at]));
  }

  redo() {
    if (this.own) history.forward();
    else if (this.at + 1 < this.list.length) this.restore(read(this.list[++this.at]));
  }
}
