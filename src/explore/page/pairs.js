// What is asked about one pair: the one under the pointer, and the one that is pinned.

import { latest } from "./ask.js";
import { card, pinned, readout, spoken } from "./card.js";
import { parse, text } from "./exact.js";
import { exactly, number } from "./writing.js";

/** Why there is no verdict. */
const costs = (error) => {
  if (!error.tooCostly) return error.message;
  const { cost, unit } = error.tooCostly;
  return cost === null ? "This verdict would cost too much." : `This verdict would cost ${number(Number(cost), 2)} ${unit ?? "kicks"}.`;
};

export class Pairs {
  /** `host`: {page, questions, settings(), springs(), redraw(), record(), cardActs(pin)}. */
  constructor(host) {
    Object.assign(this, { host, pin: null });
    this.askHover = latest((picked, signal) => this.#hovered(picked, signal), 70);
    this.askPin = latest((pin, signal) => this.#answered(pin, signal));
  }

  async #point({ pair, within }, signal) {
    const [h1, h2] = pair.map(text);
    // Where cells cost too much no pair of theirs can be decided: the simplest ratio within half a cell stands for it.
    return this.host.questions.json("point", { ...this.host.springs(), h1, h2, ...(within ? { within } : {}) }, signal).catch((error) => {
      if (signal.aborted) throw error;
      return { error: costs(error) };
    });
  }

  async #hovered(picked, signal) {
    const told = await this.#point(picked, signal);
    const { page } = this.host;
    // What was decided is said, also where it is another pair of the same cell.
    const pair = told.input ? [told.input.h1, told.input.h2].map(parse) : picked.pair;
    // Where nothing more is told the cell's verdict stays.
    readout(page.readout, pair, told.error ? picked.kind : told.kind, told.error ? null : told, this.host.settings().unit, told.error);
    this.#speak(pair, told);
  }

  /** The live region hears of a pair once the pointer rests. */
  #speak(pair, told) {
    clearTimeout(this.speaking);
    this.speaking = setTimeout(() => {
      this.host.page.live.textContent = `h1 ${exactly(pair[0])}, h2 ${exactly(pair[1])}: ${told.error ?? spoken(told.kind)}`;
    }, 500);
  }

  async #answered(pin, signal) {
    const told = await this.#point(pin, signal);
    if (told.input) Object.assign(pin, pinned([told.input.h1, told.input.h2].map(parse)), { within: null });
    pin.told = told;
    this.show();
    this.host.redraw();
    this.host.record();
    await pin.settled;
    if (pin.settled && this.pin === pin) this.host.page.card.querySelector(".answer, [role=status]")?.scrollIntoView({ block: "nearest" });
  }

  /** Pins a pair of exact rationals, or none; once `settled`, a promise, holds its answer comes into view. */
  take(pair, within = null, settled = null) {
    const springs = Object.values(this.host.springs()).join("|");
    if (pair && this.pin?.springs === springs && pinned(pair).text.join() === this.pin.text.join()) return;
    this.askPin.stop();
    this.pin = pair ? { ...pinned(pair), springs, within, settled, told: null } : null;
    if (this.pin) this.askPin(this.pin);
    this.show();
  }

  show() {
    const { page } = this.host;
    page.pinned(Boolean(this.pin));
    if (this.pin) card(page.card, this.pin, this.pin.told, this.host.settings().unit, this.host.cardActs(this.pin));
  }

  /** Why a file of the card was not made, such as no certificate for numbers with pi, stands on the card. */
  async said(pin, work) {
    pin.said = await work.then(() => null, (error) => error.message);
    this.show();
  }
}
