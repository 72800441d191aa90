// How it looks, to people and to assistive techniques, and how quickly.

import assert from "node:assert/strict";
import { test } from "node:test";
import { axe, card, settled, shot, spot, stage } from "./harness.mjs";

const { address, beside, opened } = stage();

for (const scheme of ["light", "dark"]) {
  for (const [name, width, height] of [["wide", 1400, 900], ["narrow", 390, 844]]) {
    test(`no serious fault for assistive techniques: ${scheme}, ${name}`, async () => {
      const page = await opened({ hash: "#p=49/100,343/300&x=ratio,7/3,1/10,63/100&c=1", scheme, width, height });
      await card(page);
      await page.waitForSelector(".plot svg", { timeout: 60_000 });
      await shot(page, `card-cut-${scheme}-${name}`);
      // The page's policy forbids foreign scripts in its own world; the driver's evaluation is not under it.
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => window.axe.run());
      const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
      assert.deepEqual(serious.map(({ id, nodes }) => [id, nodes.map(({ target }) => target.join(" "))]), []);
    });
  }
}

// For people to look at: only where a folder is named.
const unseen = process.env.SCREENSHOTS ? false : "name a folder in SCREENSHOTS";

test("screenshots of the main states", { skip: unseen }, async () => {
  const states = { home: "", curves: "#c=1", growth: "#w=growth", family: "#w=family&t=on&n=25", strip: "#s=5/3" };
  for (const scheme of ["light", "dark"]) {
    for (const [name, width, height] of [["wide", 1400, 900], ["narrow", 390, 844]]) {
      for (const [state, hash] of Object.entries(states)) {
        const page = await beside({ hash, scheme, width, height });
        if (state === "strip") await page.waitForSelector(".plot svg", { timeout: 60_000 });
        await shot(page, `${state}-${scheme}-${name}`);
        const overflow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
        assert.equal(overflow, 0, `${state} ${name} scrolls sideways`);
        assert.deepEqual(page.faults, []);
        await page.close();
      }
    }
  }
});

/** What happened while `work` ran, as the browser itself traces it: events with `name`, `ts` in microseconds, `args`. */
async function traced(page, work) {
  const session = await page.context().newCDPSession(page);
  const events = [];
  session.on("Tracing.dataCollected", ({ value }) => events.push(...value));
  const categories = ["loading", "blink.user_timing", "devtools.timeline", "disabled-by-default-devtools.timeline.frame", "cc", "benchmark"];
  await session.send("Tracing.start", { transferMode: "ReportEvents", traceConfig: { includedCategories: categories } });
  await work();
  const complete = new Promise((done) => session.once("Tracing.tracingComplete", done));
  await session.send("Tracing.end");
  await complete;
  return events.sort((a, b) => a.ts - b.ts);
}

// Figures and no limits: a machine may be busy with other things.
test("figures, traced by the browser: first picture, frames while dragging", async (t) => {
  const page = await opened({ address: "about:blank", ready: false });
  const opening = await traced(page, async () => {
    await page.goto(address());
    await page.waitForFunction(() => performance.getEntriesByName("all cells").length > 0);
  });
  const began = opening.findLast(({ name, args }) => name === "navigationStart" && args.data?.documentLoaderURL?.startsWith(address())).ts;
  const since = (named) => ((opening.find(({ name, ts }) => name === named && ts > began)?.ts - began) / 1000).toFixed(0);
  t.diagnostic(`after opening: first contentful paint ${since("firstContentfulPaint")} ms, first cells ${since("first cells")} ms, all cells ${since("all cells")} ms`);
  await settled(page);
  const [x, y] = await spot(page);
  const dragging = await traced(page, async () => {
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (let k = 0; k < 120; k++) await page.mouse.move(x + 60 * Math.sin(k / 10), y + 40 * Math.cos(k / 10));
    await page.mouse.up();
  });
  const frames = dragging.filter(({ name }) => name === "DrawFrame").map(({ ts }) => ts / 1000);
  const gaps = frames.slice(1).map((time, k) => time - frames[k]).sort((a, b) => a - b);
  const script = dragging.filter(({ name, ph }) => name === "FireAnimationFrame" && ph === "X").map(({ dur }) => dur / 1000).sort((a, b) => a - b);
  const part = (list, share) => (list[Math.floor(share * (list.length - 1))] ?? NaN).toFixed(1);
  t.diagnostic(`${frames.length} frames while dragging: median gap ${part(gaps, 0.5)} ms, 95 % within ${part(gaps, 0.95)} ms; script a frame: median ${part(script, 0.5)} ms, 95 % within ${part(script, 0.95)} ms`);
  assert.ok(frames.length > 10, `${frames.length} frames`);
});
