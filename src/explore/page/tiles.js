// Tiles: asked for, kept, cancelled, painted.

import { painter } from "./colours.js";
import { multiply, powerOfTwo, text } from "./exact.js";
import { COARSEST, SIZE } from "./view.js";

/** Tiles kept: at 256 x 256 cells some 300 MB with their pictures at worst. */
const KEPT = 500;
/** Questions under way at once: what a browser opens to one host. */
const AT_ONCE = 6;
/** Milliseconds before a failed question is asked again. */
const RETRY = 4000;
const HEADER = 16;
const ARRAYS = { verdict: [Uint8Array, 1], growth: [Float32Array, 1], family: [Int16Array, 2] };

/** What a picture is of: tiles of different layers never mix. */
export const layerKey = (l) => [l.lambda1, l.lambda2, l.step, l.stretch, l.what].join("|");
const placeKey = (t) => `${t.level}/${t.x}/${t.y}`;
const parent = (t, by = 1n) => ({ level: t.level - Number(by), x: t.x >> by, y: t.y >> by });

export class Tiles {
  /** `changed` is called when there is more to draw. */
  constructor(questions, changed) {
    Object.assign(this, { questions, changed, layers: new Map(), wanted: [], under: new Map(), clock: 0, pace: 100 });
  }

  /** The store of one layer. */
  #layer(layer) {
    const key = layerKey(layer);
    if (!this.layers.has(key)) this.layers.set(key, { tiles: new Map(), costly: new Map(), lost: new Map(), refused: [Infinity, -Infinity] });
    return this.layers.get(key);
  }

  get(layer, place) {
    const tile = this.#layer(layer).tiles.get(placeKey(place));
    if (tile) tile.used = ++this.clock;
    return tile;
  }

  /** What a tile would cost where the server refused it or one that it lies in; else null. */
  cost(layer, place) {
    const { costly, refused } = this.#layer(layer);
    if (costly.size === 0 || place.level < refused[0]) return null;
    let at = place.level > refused[1] ? parent(place, BigInt(place.level - refused[1])) : place;
    for (; at.level >= refused[0]; at = parent(at)) {
      const found = costly.get(placeKey(at));
      if (found) return found;
    }
    return null;
  }

  /** From now on these and no others are wanted; what is under way for others is cancelled. */
  want(layer, places) {
    const key = layerKey(layer);
    const store = this.#layer(layer);
    const lost = (p) => store.lost.get(placeKey(p)) > performance.now();
    const open = places.filter((p) => !store.tiles.has(placeKey(p)) && !this.cost(layer, p) && !lost(p));
    const asked = open.map((place) => ({ place, layer, id: `${key}/${placeKey(place)}` }));
    const ids = new Set(asked.map(({ id }) => id));
    for (const [id, controller] of this.under) if (!ids.has(id)) controller.abort();
    // What is under way stands in line no more: it would be asked for again when it has come.
    this.wanted = asked.filter(({ id }) => !this.under.has(id));
    this.#next();
  }

  /** Tiles come so quickly that some may be asked for before they are needed. */
  get quick() {
    return this.pace < 60;
  }

  /** Nothing is wanted that is not here. */
  get idle() {
    return this.under.size + this.wanted.length === 0;
  }

  #next() {
    while (this.under.size < AT_ONCE && this.wanted.length) {
      const { id, layer, place } = this.wanted.shift();
      this.#load(id, layer, place);
    }
  }

  async #load(id, layer, place) {
    const controller = new AbortController();
    this.under.set(id, controller);
    const begun = performance.now();
    try {
      this.#keep(layer, place, await this.#asked(layer, place, controller.signal));
      this.pace += (performance.now() - begun - this.pace) / 4;
    } catch (error) {
      if (error.tooCostly) {
        const store = this.#layer(layer);
        store.costly.set(placeKey(place), error.tooCostly);
        store.refused = [Math.min(store.refused[0], place.level), Math.max(store.refused[1], place.level)];
      } else if (!controller.signal.aborted) this.#lose(layer, place, error);
    }
    this.under.delete(id);
    this.#next();
    this.changed();
  }

  /** A question that went wrong is asked again only after a while. */
  #lose(layer, place, error) {
    this.#layer(layer).lost.set(placeKey(place), performance.now() + RETRY);
    this.failed?.(error);
    setTimeout(this.changed, RETRY + 50);
  }

  async #asked(layer, place, signal) {
    const { lambda1, lambda2, what, exactStep, stretch } = layer;
    const unit = multiply(exactStep, powerOfTwo(8 - COARSEST));
    const params = {
      lambda1, lambda2, what, size: SIZE,
      unit: text(unit), unit2: text(multiply(unit, powerOfTwo(stretch))),
      level: place.level - COARSEST, x: place.x, y: place.y,
    };
    return (await this.questions.bytes("tile", params, signal)).bytes;
  }

  #keep(layer, place, bytes) {
    const head = new DataView(bytes);
    const [Kind, each] = ARRAYS[layer.what];
    // Deep down a tile has fewer cells.
    const size = head.getUint32(4, true);
    if (String.fromCharCode(...new Uint8Array(bytes, 0, 4)) !== "KDT1" || SIZE % size !== 0) {
      throw new Error("a tile of a kind that this page does not know");
    }
    const values = new Kind(bytes, HEADER, size * size * each);
    const { tiles } = this.#layer(layer);
    tiles.set(placeKey(place), { place, values, each, size, picture: null, colours: null, used: ++this.clock });
    this.#forget();
  }

  /** Drops the tiles that were not looked at for longest. */
  #forget() {
    for (const [key, layer] of this.layers) if (layer.tiles.size + layer.costly.size + layer.lost.size === 0) this.layers.delete(key);
    const all = [...this.layers.values()].flatMap(({ tiles }) => [...tiles].map(([key, tile]) => [tile.used, tiles, key]));
    if (all.length <= KEPT) return;
    all.sort((a, b) => a[0] - b[0]).slice(0, all.length - KEPT + KEPT / 10).forEach(([, tiles, key]) => tiles.delete(key));
  }

  /** The value of a cell of a level, or undefined where its tile is not here or has no such cell. */
  value(layer, level, [i, j]) {
    const [a, b] = [i - 1n, j - 1n];
    const tile = this.#layer(layer).tiles.get(placeKey({ level, x: a >> 8n, y: b >> 8n }));
    if (!tile) return undefined;
    // Of k cells the last one stands for all.
    const k = SIZE / tile.size;
    const [column, row] = [a, b].map((n) => (Number(n & 255n) + 1) / k - 1);
    if (!Number.isInteger(column) || !Number.isInteger(row)) return undefined;
    const at = (row * tile.size + column) * tile.each;
    return tile.each === 1 ? tile.values[at] : [tile.values[at], tile.values[at + 1]];
  }

  /** A tile as a picture, its lowest row at the bottom; painted once for each palette. */
  picture(tile, layer, colours) {
    if (tile.picture && tile.colours === colours) return tile.picture;
    const { size } = tile;
    const image = new ImageData(size, size);
    painter(layer.what, colours, layer.frequency)(tile.values, new Uint32Array(image.data.buffer), size);
    tile.picture ??= Object.assign(document.createElement("canvas"), { width: size, height: size });
    tile.picture.getContext("2d").putImageData(image, 0, 0);
    tile.colours = colours;
    return tile.picture;
  }

  /** Tiles here that the screen shows, of the levels around `level`, with its own or without, coarse ones first. */
  around(layer, view, level, coarser, own, finer = 2) {
    const here = [...this.#layer(layer).tiles.values()].filter(({ place }) => {
      if (place.level < level - coarser || place.level > level + finer || (place.level === level && !own)) return false;
      const [l, t, r, b] = view.tileBox(place, layer.stretch);
      return r > 0 && l < view.width && b > 0 && t < view.height;
    });
    return here.sort((a, b) => a.place.level - b.place.level);
  }
}
