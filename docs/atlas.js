// The atlas: the page of `kickdrift explore` without a program. What it asks is answered from what was recorded.

(() => {
  const held = JSON.parse(document.getElementById("held").textContent);

  const inflated = async (id) => {
    const packed = Uint8Array.from(atob(document.getElementById(id).textContent), (letter) => letter.charCodeAt(0));
    return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
  };
  let tiles = null;
  let tongues = null;

  const json = (body, status = 200) => new Response(JSON.stringify(body), { status, headers: { "content-type": "application/json" } });
  const refuse = (message) => json({ error: { message } }, 400);
  const GOES_ON = "kickdrift explore goes on from here.";

  /** An exact text as [numerator, denominator]. */
  const exact = (text) => {
    const [n, d = "1"] = text.split("/");
    return [BigInt(n), BigInt(d)];
  };
  const number = (text) => exact(text).map(Number).reduce((n, d) => n / d);
  const range = (text) => text.split("..").map(number);

  async function tile({ what, unit2, level, x, y }) {
    const at = held.tiles[[what, unit2, level, x, y].join(" ")];
    if (at === undefined) {
      const inside = what === "verdict" && Number(level) <= held.deepest && held.stretched.includes(unit2);
      const words = inside ? "The atlas ends here." : `The atlas holds verdicts down to d₁\u00a0=\u00a0${held.finest}, at scales of 1 : 4 and 1 : 8.`;
      return json({ too_costly: { cost: null, words: `${words} ${GOES_ON}` } }, 422);
    }
    tiles ??= inflated("tiles");
    return new Response((await tiles).slice(at * held.bytes, (at + 1) * held.bytes));
  }

  /** Every tongue: p, q, m, a, b, and its edges in h1 (the last one has no end). */
  async function list() {
    const all = await inflated("tongues");
    const n = held.tongues;
    const edges = new Float64Array(all, 0, 2 * n);
    const labels = new Int16Array(all, 16 * n, 5 * n);
    return Array.from({ length: n }, (_, k) => [...labels.subarray(5 * k, 5 * k + 5), edges[2 * k], edges[2 * k + 1]]);
  }
  const every = () => (tongues ??= list());

  async function lines({ h1, h2, max_sum: asked, min_width: least }) {
    const [[x0, x1], [y0, y1]] = [range(h1), range(h2)];
    const [wide, high] = [x1 - x0, y1 - y0];
    if (!(wide > 1e-9 * x1 && high > 1e-9 * y1)) return refuse(`The atlas has no more digits of these edges. ${GOES_ON}`);
    const narrow = least ? number(least) : 0;
    const found = (await every()).flatMap(([p, q, m, a, b, lower, upper]) => {
      const slope = p / q;
      const left = Math.max(x0 - wide / 2, (y0 - high / 2) / slope, 0);
      const right = Math.min(x1 + wide / 2, (y1 + high / 2) / slope);
      const [from, to] = [Math.max(lower, left), Math.min(upper, right)];
      if (from > to || upper - lower < narrow) return [];
      const place = (h) => [(h - x0) / wide, (h * slope - y0) / high];
      const end = Number.isFinite(upper) ? [upper, upper * slope] : null;
      return [{ p, q, ratio: `${p}/${q}`, m, a, b, closed: false, from: [lower, lower * slope], to: end, line: [...place(from), ...place(to)], ends: [lower >= left, upper <= right] }];
    });
    const most = asked ? Math.min(Number(asked), held.sum) : held.sum;
    const sums = [6, 8, 12, 16, 24, 32, 40, 48].filter((sum) => sum < most).concat(most);
    const within = (sum) => found.filter(({ p, q }) => p + q <= sum);
    const sum = sums.findLast((sum) => within(sum).length <= 3000) ?? sums[0];
    return json({ segments: within(sum), max_sum: sum, complete: !asked || Number(asked) <= sum, ratios: 0, narrower: 0 });
  }

  /** 1/T½ = a/h1 + b/h2 with T½ = π h1/θ, sin θ/2 = h1 √λ1/2. */
  function curves({ h1, h2, a: as, b: bs }) {
    const [[x0, x1], [y0, y1], [a0, a1], [b0, b1]] = [range(h1), range(h2), range(as), range(bs)];
    const limit = 2 / Math.sqrt(held.lambda1);
    const [from, to] = [Math.max(0, x0 - (x1 - x0) / 2), Math.min(limit, x1 + (x1 - x0) / 2)];
    const far = (y) => y < y0 - (y1 - y0) / 2 || y > y1 + (y1 - y0) / 2;
    const all = [];
    for (let a = a0; a <= a1; a++) {
      for (let b = b0; b <= b1; b++) {
        const [pieces, open] = [[], []];
        for (let k = 0; k <= 320 && to > from; k++) {
          const h = from + ((to - from) * k) / 320;
          const turn = (2 * Math.asin(Math.min(1, h / limit))) / Math.PI - a;
          const y = (b * h) / turn;
          if (b && h > 0 && y > 0 && !far(y)) open.push((h - x0) / (x1 - x0), (y - y0) / (y1 - y0));
          else if (open.length) pieces.push(open.splice(0));
        }
        if (open.length) pieces.push(open);
        const long = pieces.filter((piece) => piece.length > 2);
        if (long.length) all.push({ a, b, lines: long });
      }
    }
    return json({ curves: all });
  }

  /** What is known of a pair without a program: its tongue, if its ratio is short. */
  async function point({ h1, h2 }) {
    const [[n1, d1], [n2, d2]] = [exact(h1), exact(h2)];
    let [p, q] = [n2 * d1, d2 * n1];
    for (let [a, b] = [p, q]; ; [a, b] = [b, a % b]) {
      if (b) continue;
      [p, q] = [p / a, q / a];
      break;
    }
    if (p + q > BigInt(held.sum)) return refuse(`h₂/h₁ is beyond p + q ≤ ${held.sum}. ${GOES_ON}`);
    const h = number(h1);
    const found = (await every()).find(([P, Q, , , , lower, upper]) => BigInt(P) === p && BigInt(Q) === q && lower < h && h < upper);
    if (!found) return refuse(`In no tongue of h₂/h₁ = ${p}/${q}.`);
    const [, , m, a, b] = found;
    return refuse(`In tongue m = ${m} of h₂/h₁ = ${p}/${q}, family (${a}, ${b}).`.replace(/-/g, "−"));
  }

  const answers = { tile, tongues: lines, curves, point };
  window.fetch = async (asked, { signal } = {}) => {
    const [path, query = ""] = String(asked).split("?");
    const answer = answers[path];
    const reply = answer ? await answer(Object.fromEntries(new URLSearchParams(query))) : refuse(`An atlas has no program behind it. ${GOES_ON}`);
    signal?.throwIfAborted();
    return reply;
  };
})();
