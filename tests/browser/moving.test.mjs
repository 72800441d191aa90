// Moving over the map and pointing at it.

import assert from "node:assert/strict";
import { test } from "node:test";
import { agreesWithTheProgram, card, file, kickdrift, settled, shot, spot, stage } from "./harness.mjs";

const { opened } = stage();

test("a drag moves the map by the pixels dragged", async () => {
  const page = await opened();
  const [x, y] = await spot(page);
  const centre = () => page.evaluate(() => [0, 1].map((axis) => Number(window.kickdrift.map.view.middle(axis)[0]) / Number(window.kickdrift.map.view.middle(axis)[1])));
  const [before, size] = [await centre(), await page.evaluate(() => [0, 1].map((axis) => 10 ** window.kickdrift.map.view.logPixel(axis)))];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 60, y + 20, { steps: 6 });
  await page.mouse.move(x - 120, y + 50, { steps: 6 });
  await page.mouse.up();
  await settled(page);
  const after = await centre();
  // A pixel is one part in 10^3 of the window, doubles have 16 digits: a thousandth of a pixel is generous.
  assert.ok(Math.abs((after[0] - before[0]) / size[0] - 120) < 1e-3, `${after} after ${before}`);
  assert.ok(Math.abs((after[1] - before[1]) / size[1] - 50) < 1e-3, `${after} after ${before}`);
});

test("a click pins the exact pair with the program's verdict", async () => {
  const page = await opened();
  for (const [dx, dy] of [[-100, 0], [37, -141], [180, 60]]) {
    await page.mouse.click(...(await spot(page, dx, dy)));
    const { shown, told } = await agreesWithTheProgram(page);
    const again = kickdrift(...shown.command.replace(/^kickdrift /, "").replace(/'/g, "").split(" "), "--format", "json");
    assert.equal(JSON.parse(again).kind, told.kind);
    await page.click(".card [aria-label='Remove the pin']");
  }
});

test("the card's files are the program's", async () => {
  // Certificates are for rational numbers.
  const page = await opened({ hash: "#l1=10&l2=2/5&p=49/100,343/300" });
  await card(page);
  const program = kickdrift("verdict", "--lambda1", "10", "--lambda2", "2/5", "--h1", "49/100", "--h2", "343/300", "--format", "json");
  assert.deepEqual(JSON.parse(await file(page, ".card >> text=JSON")), JSON.parse(program));
  assert.match(String(await file(page, ".card >> text=Certificate")), /Theorem kickdrift_verdict/);
});

test("two fingers zoom about the point between them", async () => {
  const page = await opened();
  const [x, y] = await spot(page);
  const session = await page.context().newCDPSession(page);
  const fingers = (apart) => [{ x: x - apart, y, id: 0 }, { x: x + apart, y, id: 1 }];
  const zoom = () => page.evaluate(() => window.kickdrift.map.view.zoom);
  const before = await zoom();
  await session.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: fingers(40) });
  for (const apart of [60, 80, 120, 160]) await session.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: fingers(apart) });
  await session.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  await settled(page);
  // Four times as far apart are two levels; the first move only begins the gesture.
  const levels = (await zoom()) - before;
  assert.ok(levels > 1.3 && levels <= 2.001, `${levels} levels`);
});

test("drags and a zoom of two hundred levels away, a click on a tongue is exact", async () => {
  const page = await opened({ hash: "#t=on&n=12" });
  // Onto a tongue as one does: a drag, the wheel, a click on its line, and its pair to the centre.
  const [x, y] = await spot(page);
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 70, y - 90, { steps: 5 });
  await page.mouse.up();
  await page.mouse.wheel(0, -500);
  await settled(page);
  await page.waitForFunction(() => window.kickdrift.map.vectors.tongues);
  await clickTongue(page);
  const { told: first } = await agreesWithTheProgram(page);
  await page.click("text=Centre here");
  for (let k = 0; k < 202; k++) await page.keyboard.press("+");
  await settled(page);
  assert.ok((await page.evaluate(() => window.kickdrift.map.view.level)) >= 200);
  await page.waitForFunction(() => window.kickdrift.map.vectors.lines(window.kickdrift.map.view).length > 0, null, { timeout: 60_000 });
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 90, y + 40, { steps: 5 });
  await page.mouse.up();
  await settled(page);
  await page.click("[aria-label='Remove the pin']");
  const ratio = await clickTongue(page);
  const { shown, told } = await agreesWithTheProgram(page);
  assert.deepEqual([told.p, told.q, told.kind], [first.p, first.q, "hyperbolic"]);
  assert.equal(`${told.p}/${told.q}`, ratio);
  // d / 2^200 in lowest terms has some 190 bits left: what was clicked is no coarser pair.
  assert.ok(shown.h1.length > 55, shown.h1);
  await shot(page, "deep-light");
});

/** Clicks on the line of which most is seen, off its middle; its ratio. */
async function clickTongue(page) {
  const line = await page.evaluate(() => {
    const { vectors, view } = window.kickdrift.map;
    const seen = vectors.lines(view).map(({ segment, x0, y0, x1, y1 }) => {
      const points = Array.from({ length: 41 }, (_, k) => [x0 + (k / 40) * (x1 - x0), y0 + (k / 40) * (y1 - y0)]);
      const inside = points.filter(([x, y]) => x > 40 && x < view.width - 180 && y > 40 && y < view.height - 20);
      return { ratio: segment.ratio, at: inside[Math.floor(0.4 * inside.length)], long: (inside.length * Math.hypot(x1 - x0, y1 - y0)) / 40 };
    });
    const { ratio, at: [x, y] } = seen.sort((a, b) => b.long - a.long)[0];
    return { ratio, off: [x - view.width / 2, y - view.height / 2] };
  });
  await page.mouse.click(...(await spot(page, ...line.off)).map(Math.round));
  return line.ratio;
}

test("sixty levels down every cell is decided, as the program decides its pair", async () => {
  const page = await opened();
  await page.fill("#go-h1", "0.3127");
  await page.fill("#go-h2", "1.4142");
  await page.click("text=Go to this pair");
  await page.focus("canvas");
  for (let k = 0; k < 60; k++) await page.keyboard.press("+");
  await settled(page);
  await page.waitForFunction(() => window.kickdrift.status.cells && !window.kickdrift.status.waiting, null, { timeout: 120_000 });
  const { level, thin, costly } = await page.evaluate(() => ({ level: window.kickdrift.map.view.level, ...window.kickdrift.status }));
  assert.ok(level >= 60 && thin > 0 && !costly, `${level} ${thin}`);
  await page.mouse.click(...(await spot(page, 40, 30)));
  const { shown, told } = await agreesWithTheProgram(page);
  assert.ok(BigInt(told.q) > 1n << 50n, `${shown.h1} ${told.q}`);
});

test("where no cell can be decided a click takes the simplest ratio within half a cell", async () => {
  const page = await opened();
  await page.fill("#go-h1", "0.3127");
  await page.fill("#go-h2", "1.4142");
  await page.click("text=Go to this pair");
  await page.focus("canvas");
  for (let k = 0; k < 110; k++) await page.keyboard.press("+");
  await settled(page);
  await page.waitForFunction(() => window.kickdrift.status.costly && !window.kickdrift.status.cells && window.kickdrift.map.vectors.tongues);
  // A pixel of no line.
  const places = await Promise.all([[60, 80], [-90, 40], [30, -120], [150, 110]].map(([dx, dy]) => spot(page, dx, dy)));
  const asked = await page.evaluate((places) => {
    const { map, input } = window.kickdrift;
    const at = ([clientX, clientY]) => input.at({ clientX, clientY });
    const free = places.find((place) => !map.vectors.nearest(map.view, ...at(place), 12));
    const half = map.view.coordinate(1n, 1, map.view.level + 1);
    return { free, numbers: [...map.view.pair(...at(free)), half].map((x) => x.map(String)) };
  }, places);
  await page.mouse.click(...asked.free);
  const { shown } = await agreesWithTheProgram(page);
  const [h1, h2, half] = asked.numbers.map((pair) => pair.map(BigInt));
  const [own1, own2] = [shown.h1, shown.h2].map((text) => text.split("/").map(BigInt));
  assert.equal(own1[0] * h1[1], h1[0] * own1[1]);
  // |h2 - own| <= half, in integers.
  const off = own2[0] * h2[1] - h2[0] * own2[1];
  assert.ok(off !== 0n && (off < 0n ? -off : off) * half[1] <= half[0] * own2[1] * h2[1], shown.h2);
});

test("the keyboard does what the pointer does", async () => {
  const page = await opened();
  await page.focus("canvas");
  const view = () => page.evaluate(() => window.kickdrift.map.view.save());
  const home = await view();
  for (const key of ["ArrowLeft", "ArrowUp", "+"]) await page.keyboard.press(key);
  await settled(page);
  assert.notEqual(await view(), home);
  await page.keyboard.press("Enter");
  await agreesWithTheProgram(page);
  await page.waitForFunction(() => document.querySelector("[aria-live]").textContent.includes("h1"));
  await page.keyboard.press("Escape");
  assert.equal(await page.isVisible(".card .answer"), false);
  await page.keyboard.press("0");
  await settled(page);
  assert.equal(await view(), home);
  const order = [];
  await page.evaluate(() => document.activeElement.blur());
  for (let k = 0; k < 40; k++) {
    await page.keyboard.press("Tab");
    order.push(await page.evaluate(() => document.activeElement.tagName + (document.activeElement.id || document.activeElement.getAttribute("aria-label")?.slice(0, 8) || "")));
  }
  for (const stop of ["CANVAS", "#rho", "#go-h1"].map((name) => name.replace("#", "INPUT"))) assert.ok(order.some((at) => at.startsWith(stop)), `${stop} in ${order}`);
});
