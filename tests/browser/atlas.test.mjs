// The atlas: the page in one file, without a program (docs/atlas.py). KICKDRIFT_ATLAS is that file.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { SPRINGS, browser, kickdrift, open, settled } from "./harness.mjs";

let chrome, page;
const reached = [];
before(async () => {
  chrome = await browser();
  chrome.context.on("request", (request) => request.url().startsWith("http") && reached.push(request.url()));
  page = await open(chrome.context, `file://${process.env.KICKDRIFT_ATLAS}`);
});
after(() => chrome?.close());

const said = () => page.evaluate(() => document.querySelector(".said").textContent);
const decided = (h1, h2) => JSON.parse(kickdrift("verdict", ...SPRINGS, "--h1", h1, "--h2", h2, "--format", "json"));

test("the first view shows all cells, and they are the program's verdicts", async () => {
  assert.match(await said(), /^Every cell is one exact verdict/);
  const cells = await page.evaluate(() => {
    const { map } = window.kickdrift;
    const { layer } = window.kickdrift.settings();
    const exact = ([n, d]) => `${n}/${d}`;
    return Array.from({ length: 40 }, (_, k) => {
      const at = [((k * 37) % 100) / 100, ((k * 61) % 100) / 100];
      const [x, y] = [at[0] * map.view.width, at[1] * map.view.height];
      const pair = map.view.pair(x, y);
      const value = map.tiles.value(layer, map.view.level, [map.view.cell(x, 0), map.view.cell(y, 1)]);
      return pair && { h1: exact(pair[0]), h2: exact(pair[1]), value };
    }).filter(Boolean);
  });
  assert.ok(cells.length > 30);
  const kinds = ["elliptic", "hyperbolic", "parabolic", "coexistence"];
  for (const { h1, h2, value } of cells) assert.equal(kinds[value & 3], decided(h1, h2).kind, `${h1} ${h2}`);
});

test("below its cells it shows tongues, and pointing at one names it as the program does", async () => {
  // The middle of tongue m = 4 of 7/3, which the program places.
  const [{ lower, upper }] = JSON.parse(kickdrift("tongues", "--ratio", "7/3", ...SPRINGS, "--m", "4", "--format", "json")).tongues;
  const middle = (lower.h1.lo + upper.h1.hi) / 2;
  await page.evaluate((h1) => {
    const { map } = window.kickdrift;
    map.view.zoomTo(6);
    const n = BigInt(Math.round(h1 * 1e9));
    map.view.centreOn([[n, 10n ** 9n], [n * 7n, 3n * 10n ** 9n]]);
    window.kickdrift.change();
  }, middle);
  await settled(page);
  await page.waitForFunction(() => /all ratios with p \+ q ≤ 60/.test(document.querySelector(".said").textContent));
  assert.match(await said(), /^The atlas holds verdicts down to/);
  const box = await page.locator("canvas").first().boundingBox();
  const [left, top, width, height] = await page.evaluate(() => window.kickdrift.map.box);
  await page.mouse.move(box.x + left + width / 2, box.y + top + height / 2);
  await page.waitForFunction(() => /In tongue m = 4 of h₂\/h₁ = 7\/3, family \(1, −1\)/.test(document.querySelector(".readout").textContent));
});

test("what needs the program says so", async () => {
  const reply = await page.evaluate(async () => {
    const answer = await fetch("certificate?h1=1&h2=1");
    return [answer.status, (await answer.json()).error.message];
  });
  assert.deepEqual([reply[0], /has no program/.test(reply[1])], [400, true]);
});

test("it reaches for nothing beyond its file", () => assert.deepEqual([reached, page.faults], [[], []]));
