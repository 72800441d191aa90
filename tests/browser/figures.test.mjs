// How quickly it opens and follows a drag, as the browser itself times and traces it; beside it, in the same run, what the machine does with a page
// that has one line of text, and with a bare canvas of the same size. Figures and no limits: a machine may be busy with other things.
// ROUNDS: how often each is measured.

import assert from "node:assert/strict";
import { loadavg } from "node:os";
import { test } from "node:test";
import { settled, spot, stage } from "./harness.mjs";

const ROUNDS = Number(process.env.ROUNDS ?? 1);
const { address, beside } = stage();

/** What happened while `work` ran: events with `name`, `ts` in microseconds, `args`. */
async function traced(page, work) {
  const session = await page.context().newCDPSession(page);
  const events = [];
  session.on("Tracing.dataCollected", ({ value }) => events.push(...value));
  const includedCategories = ["loading", "blink.user_timing", "devtools.timeline", "disabled-by-default-devtools.timeline.frame"];
  await session.send("Tracing.start", { transferMode: "ReportEvents", traceConfig: { includedCategories } });
  await work(session);
  const complete = new Promise((done) => session.once("Tracing.tracingComplete", done));
  await session.send("Tracing.end");
  await complete;
  return events.sort((a, b) => a.ts - b.ts);
}

/** Figures of several rounds by their names: least, median. */
function gathered() {
  const all = new Map();
  const add = (name, value) => all.set(name, [...(all.get(name) ?? []), value]);
  const said = () => [...all].map(([name, values]) => {
    const own = values.sort((a, b) => a - b);
    return `${name}: least ${own[0].toFixed(1)}, median ${own[own.length >> 1].toFixed(1)}`;
  });
  return { add, said };
}

const middle = (values, share = 0.5) => [...values].sort((a, b) => a - b)[Math.floor(share * (values.length - 1))];

test("milliseconds from opening to the first picture", async (t) => {
  const { add, said } = gathered();
  for (let round = 0; round < ROUNDS; round++) {
    // The server answers an address that it does not know with a line of text.
    for (const [name, place] of [["a line of text", `${address()}nothing`], ["the page", address()]]) {
      const page = await beside({ address: place, ready: false });
      // The first paint may be told later than the marks of what it shows.
      const named = ["first-contentful-paint", ...(place === address() ? ["first cells", "all cells"] : [])];
      const told = (names) => names.every((name) => performance.getEntriesByName(name).length > 0);
      await page.waitForFunction(told, named, { polling: 50 });
      const since = (names) => names.map((name) => performance.getEntriesByName(name)[0].startTime);
      (await page.evaluate(since, named)).forEach((value, k) => add(`${name}, ${named[k]}`, value));
      await page.close();
    }
  }
  for (const line of [...said(), `load ${loadavg()[0].toFixed(1)}`]) t.diagnostic(line);
});

/** In an empty page: a canvas of this size, on which a picture of its size follows the pointer. */
function bare([left, top, width, height]) {
  const canvas = Object.assign(document.createElement("canvas"), { width, height });
  document.body.replaceChildren(canvas);
  document.body.style.cssText = "margin: 0; overflow: hidden";
  canvas.style.cssText = `position: absolute; left: ${left}px; top: ${top}px`;
  const source = Object.assign(document.createElement("canvas"), { width, height });
  const [to, from] = [canvas, source].map((own) => own.getContext("2d", { alpha: false }));
  for (let k = 0; k < 4000; k++) {
    from.fillStyle = `hsl(${k} 50% 50%)`;
    from.fillRect((k * 37) % width, (k * 91) % height, 9, 9);
  }
  let [due, start] = [null, null];
  canvas.addEventListener("pointerdown", (event) => (start = event));
  canvas.addEventListener("pointermove", ({ clientX, clientY }) => {
    due ??= requestAnimationFrame(() => {
      due = null;
      to.fillRect(0, 0, width, height);
      to.drawImage(source, clientX - start.clientX, clientY - start.clientY);
    });
  });
}

/** A mouse that reports 125 times a second, whoever waits for whom, for two seconds. */
async function dragged(session, [x, y]) {
  const mouse = (type, dx, dy) => session.send("Input.dispatchMouseEvent", { type, x: x + dx, y: y + dy, button: "left", buttons: 1, clickCount: 1 });
  await mouse("mousePressed", 0, 0);
  const [begun, sent] = [performance.now(), []];
  while (performance.now() - begun < 2000) {
    const t = (performance.now() - begun) / 160;
    sent.push(mouse("mouseMoved", 60 * Math.sin(t), 40 * Math.sin(0.7 * t)));
    await new Promise((done) => setTimeout(done, 8));
  }
  await Promise.all(sent);
  await mouse("mouseReleased", 0, 0);
}

test("frames while dragging over tiles that are here", async (t) => {
  const { add, said } = gathered();
  for (let round = 0; round < ROUNDS; round++) {
    const page = await beside();
    // The ring of tiles around the screen comes after it is full.
    await page.waitForTimeout(500);
    await settled(page);
    const at = await spot(page);
    const box = await page.evaluate(() => (({ left, top, width, height }) => [left, top, width, height].map(Math.round))(window.kickdrift.page.canvas.getBoundingClientRect()));
    const empty = await beside({ address: `${address()}nothing`, ready: false });
    await empty.evaluate(bare, box);
    for (const [name, own] of [["a bare canvas", empty], ["the map", page]]) {
      await own.bringToFront();
      const events = await traced(own, (session) => dragged(session, at));
      const frames = events.filter(({ name }) => name === "DrawFrame").map(({ ts }) => ts / 1000);
      const gaps = frames.slice(1).map((time, k) => time - frames[k]);
      const script = events.filter(({ name, ph }) => name === "FireAnimationFrame" && ph === "X").map(({ dur }) => dur / 1000);
      assert.ok(frames.length > 10, `${frames.length} frames`);
      add(`${name}, median gap of frames in ms`, middle(gaps));
      add(`${name}, 95 % of gaps within`, middle(gaps, 0.95));
      add(`${name}, frames a second`, (1000 * gaps.length) / (frames.at(-1) - frames[0]));
      add(`${name}, script a frame in ms`, middle(script));
    }
    await page.close();
    await empty.close();
  }
  for (const line of [...said(), `load ${loadavg()[0].toFixed(1)}`]) t.diagnostic(line);
});
