// Pointer, wheel, pinch and keys on the map.

const CLICK = 4;
const still = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

export class Input {
  /** `act`: {moved, settled, hover, leave, click, unclick, home, draw, drawn, frame, escape}; `tool()`: "move" or a kind of cut. */
  constructor(map, act, tool) {
    Object.assign(this, { map, act, tool, pointers: new Map(), glide: null });
    const { canvas } = map;
    const on = (name, handler, options) => canvas.addEventListener(name, handler.bind(this), options);
    on("pointerdown", this.down);
    on("pointermove", this.move);
    on("pointerup", this.up);
    on("pointercancel", this.up);
    on("pointerleave", () => act.leave());
    on("wheel", this.wheel, { passive: false });
    on("dblclick", (event) => {
      act.unclick();
      this.zoomBy(event.shiftKey ? -1 : 1, ...this.at(event));
    });
    on("keydown", this.key);
    on("blur", () => act.leave());
  }

  at(event) {
    const { left, top } = this.map.canvas.getBoundingClientRect();
    return [event.clientX - left - this.map.box[0], event.clientY - top - this.map.box[1]];
  }

  down(event) {
    if (event.button !== 0) return;
    this.map.canvas.setPointerCapture(event.pointerId);
    this.halt();
    const at = this.at(event);
    this.pointers.set(event.pointerId, at);
    this.start = { at, moved: this.pointers.size > 1, trail: [], frames: event.shiftKey && this.tool() === "move" };
    this.map.moving = true;
  }

  move(event) {
    const at = this.at(event);
    const before = this.pointers.get(event.pointerId);
    if (!before) {
      this.act.hover(at);
      return;
    }
    if (Math.hypot(at[0] - this.start.at[0], at[1] - this.start.at[1]) > CLICK) this.start.moved = true;
    if (!this.start.moved) return;
    if (this.pointers.size === 2) this.pinch(event.pointerId, before, at);
    else if (this.start.frames) this.act.frame([...this.start.at, ...at]);
    else if (this.tool() === "move") {
      this.map.view.pan(at[0] - before[0], at[1] - before[1]);
      this.start.trail = [...this.start.trail.slice(-4), { at, time: event.timeStamp }];
      this.act.moved();
    } else this.act.draw(this.start.at, at);
    this.pointers.set(event.pointerId, at);
  }

  pinch(id, before, at) {
    const [other] = [...this.pointers].filter(([key]) => key !== id).map(([, place]) => place);
    const apart = (p) => Math.max(8, Math.hypot(p[0] - other[0], p[1] - other[1]));
    const { view } = this.map;
    view.zoomTo(view.zoom + Math.log2(apart(at) / apart(before)), (at[0] + other[0]) / 2, (at[1] + other[1]) / 2);
    view.pan((at[0] - before[0]) / 2, (at[1] - before[1]) / 2);
    this.act.moved();
  }

  up(event) {
    if (!this.pointers.delete(event.pointerId) || this.pointers.size) return;
    this.map.moving = false;
    const at = this.at(event);
    const { moved, trail, frames } = this.start;
    if (moved && frames) this.fill(this.start.at, at);
    else if (!moved && event.type === "pointerup") this.act.click(at, event.pointerType === "touch" ? 16 : 7);
    else if (this.tool() !== "move") this.act.drawn();
    else this.coast(trail, event.timeStamp);
    this.act.settled();
  }

  /** The box between two pixels fills the map, as far as its shape allows. */
  fill([x0, y0], [x1, y1]) {
    const { view } = this.map;
    this.act.frame(null);
    const [width, height] = [Math.max(8, Math.abs(x1 - x0)), Math.max(8, Math.abs(y1 - y0))];
    view.pan((view.width - x0 - x1) / 2, (view.height - y0 - y1) / 2);
    view.zoomTo(view.zoom + Math.log2(Math.min(view.width / width, view.height / height)));
    this.act.moved();
  }

  /** A drag let go in motion runs out slowly. */
  coast(trail, now) {
    const [first, last] = [trail[0], trail.at(-1)];
    if (still() || !first || last.time - first.time < 8 || now - last.time > 40) return;
    const pace = last.time - first.time;
    let [vx, vy] = [(last.at[0] - first.at[0]) / pace, (last.at[1] - first.at[1]) / pace];
    let time = performance.now();
    this.animate((next) => {
      const dt = Math.min(50, next - time);
      time = next;
      this.map.view.pan(vx * dt, vy * dt);
      [vx, vy] = [vx * Math.exp(-dt / 180), vy * Math.exp(-dt / 180)];
      return Math.hypot(vx, vy) > 0.02;
    });
  }

  /** Calls `step(time)` before each frame until it says false. */
  animate(step) {
    this.halt();
    const run = (time) => {
      const more = step(time);
      this.act.moved();
      this.glide = more ? requestAnimationFrame(run) : null;
      this.map.moving = Boolean(more);
      if (more) return;
      this.goal = null;
      this.act.settled();
    };
    this.map.moving = true;
    this.glide = requestAnimationFrame(run);
  }

  halt() {
    if (this.glide) cancelAnimationFrame(this.glide);
    this.glide = null;
    this.goal = null;
    this.map.moving = false;
  }

  wheel(event) {
    event.preventDefault();
    const lines = [1, 16, 400][event.deltaMode];
    // Browsers report a pinch on a touchpad as a wheel with Ctrl, in smaller steps.
    const by = Math.max(-1.5, Math.min(1.5, (-event.deltaY * lines * (event.ctrlKey ? 10 : 1)) / 360));
    const at = this.at(event);
    this.halt();
    this.map.view.zoomTo(this.map.view.zoom + by, ...at);
    this.act.moved();
    this.act.hover(at);
    this.act.settled();
  }

  /** Zooms by levels about a pixel; a second call on the way adds to the first. */
  zoomBy(levels, x = this.map.view.width / 2, y = this.map.view.height / 2) {
    const { view } = this.map;
    const goal = (this.goal ?? view.zoom) + levels;
    if (still()) {
      view.zoomTo(goal, x, y);
      this.act.moved();
      this.act.settled();
      return;
    }
    const [from, begun] = [view.zoom, performance.now()];
    this.animate((time) => {
      const t = Math.min(1, Math.max(0, (time - begun) / 180));
      view.zoomTo(t === 1 ? goal : from + (goal - from) * t * (2 - t), x, y);
      return t < 1;
    });
    this.goal = goal;
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const far = event.shiftKey ? 1 : 80;
    const { view } = this.map;
    const pan = (dx, dy) => {
      this.halt();
      view.pan(dx, dy);
      this.act.moved();
      this.act.hover([view.width / 2, view.height / 2]);
      this.act.settled();
    };
    const keys = {
      ArrowLeft: () => pan(far, 0), ArrowRight: () => pan(-far, 0), ArrowUp: () => pan(0, far), ArrowDown: () => pan(0, -far),
      "+": () => this.zoomBy(1), "=": () => this.zoomBy(1), "-": () => this.zoomBy(-1), _: () => this.zoomBy(-1),
      PageUp: () => this.zoomBy(3), PageDown: () => this.zoomBy(-3),
      0: () => this.act.home(), Home: () => this.act.home(),
      Enter: () => this.act.click([view.width / 2, view.height / 2], 7), " ": () => this.act.click([view.width / 2, view.height / 2], 7),
      Escape: () => this.act.escape(),
    };
    const act = keys[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }
}
