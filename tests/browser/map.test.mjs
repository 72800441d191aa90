// What the map shows.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { SPRINGS, kickdrift, pixels, settled, stage } from "./harness.mjs";

const { address, opened } = stage();

test("cells are those of the program's own picture", async () => {
  // At zoom 0 a cell is a pixel: d1 = 1/1000, d2 = 8/1000.
  const page = await opened({ hash: "#d=1/1000&v=432,132,0,0,3" });
  const [first, count] = [[400, 100], 64];
  const folder = mkdtempSync(join(tmpdir(), "kickdrift-map-"));
  const range = (start, unit) => `${start}/${unit}..${start + count - 1}/${unit}`;
  const map = (name) => kickdrift("map", ...SPRINGS, "--step1", "1/1000", "--step2", "1/125", "--h1-range", range(first[0], 1000), "--h2-range", range(first[1], 125), "--quiet", "--output", join(folder, name));
  map("map.png");
  map("map.svg");
  const [svg, png] = [readFileSync(join(folder, "map.svg"), "utf8"), readFileSync(join(folder, "map.png"))];
  rmSync(folder, { recursive: true });
  const side = Number(/viewBox="0 0 ([\d.]+)/.exec(svg)[1]);
  const [left, top, width, height] = /<clipPath id="box1"><rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)" height="([\d.]+)"/.exec(svg).slice(1).map(Number);
  const paper = await page.evaluate(async ([data, side, box, count]) => {
    const bytes = Uint8Array.from(atob(data), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const [left, top, width, height] = box.map((x) => (x * image.width) / side);
    const found = [];
    for (let j = 0; j < count; j++) for (let i = 0; i < count; i++) {
      const at = [left + ((i + 0.5) / count) * width, top + height - ((j + 0.5) / count) * height];
      found.push([...context.getImageData(Math.floor(at[0]), Math.floor(at[1]), 1, 1).data.slice(0, 3)]);
    }
    return found;
  }, [png.toString("base64"), side, [left, top, width, height], count]);
  const places = await page.evaluate(([first, count]) => {
    const { view } = window.kickdrift.map;
    const found = [];
    for (let j = 0; j < count; j++) for (let i = 0; i < count; i++) found.push([view.pixel(0, BigInt(first[0] + i), 0), view.pixel(1, BigInt(first[1] + j), 0)]);
    return found;
  }, [first, count]);
  const screen = await pixels(page, places);
  const classes = new Set(paper.map(String));
  assert.ok(classes.has("255,255,255") && classes.has("39,60,117"), "the window has stable and unstable pairs");
  const differing = screen.map((colour, k) => [k, String(colour), String(paper[k])]).filter(([, a, b]) => a !== b);
  assert.deepEqual(differing, [], `of ${count * count} cells`);
});

test("lines of tongues lie on unstable cells", async () => {
  // Cells of 1/8000 along h1, and d2 = d1: multiples of both steps lie on every simple ray.
  const page = await opened({ hash: "#d=1/1000&v=490,1145,0,3,0&t=on&n=40&b=0" });
  await page.waitForFunction(() => window.kickdrift.map.vectors.tongues);
  const cells = await page.evaluate(() => {
    const { map } = window.kickdrift;
    const { view, tiles, vectors } = map;
    const found = [];
    for (const { segment, x0, y0, x1, y1 } of vectors.lines(view)) {
      // Multiples of the ray's own pair (q, p) of cells, inside the line and inside the screen.
      const [p, q] = [BigInt(segment.p), BigInt(segment.q)];
      for (let px = Math.max(0, x0); px < Math.min(view.width, x1); px += 1) {
        const k = view.cell(px, 0) / q;
        const at = [view.pixel(0, k * q, view.level), view.pixel(1, k * p, view.level)];
        if (at[0] <= x0 + 0.01 || at[0] >= x1 - 0.01 || at[1] < 0 || at[1] > view.height) continue;
        const value = tiles.value(window.kickdrift.settings().layer, view.level, [k * q, k * p]);
        if (value !== undefined) found.push([segment.p, segment.q, Number(k), value & 3, ...at]);
      }
    }
    return found;
  });
  const distinct = new Set(cells.map(String));
  assert.ok(distinct.size > 30, `${distinct.size} cells lie on lines`);
  assert.deepEqual(cells.filter(([, , , kind]) => kind !== 1), []);
  // And so are the pixels there, once no line covers them.
  await page.selectOption("#tongues", "off");
  await settled(page);
  const colours = await pixels(page, cells.map((cell) => cell.slice(4)));
  assert.deepEqual(colours.filter((colour) => String(colour) !== "39,60,117"), []);
});

test("no tile is asked for twice", async () => {
  const page = await opened({ address: "about:blank", ready: false });
  const asked = [];
  page.on("request", (request) => request.url().includes("/tile?") && asked.push(request.url()));
  await page.goto(address());
  await page.evaluate(() => window.kickdrift.ready);
  await settled(page);
  await page.focus("canvas");
  await page.keyboard.press("+");
  await settled(page);
  assert.ok(asked.length >= 12, `${asked.length} tiles`);
  assert.equal(new Set(asked).size, asked.length);
});

test("what nobody looks at any more is no longer asked for", async () => {
  const page = await opened();
  const ended = new Map();
  page.on("requestfailed", (request) => ended.set(request.url(), request.failure().errorText));
  // Held back, as by a server that takes long.
  const held = [];
  await page.route("**/tile?*", (route) => held.push(route));
  await page.focus("canvas");
  await page.keyboard.press("PageUp");
  while (held.length < 3) await page.waitForTimeout(20);
  await page.click('label[title="Family"]');
  // Of which layer each question is, in the order in which they were asked: verdicts may follow until the click is handled.
  const url = (route) => route.request().url();
  const layers = () => held.map((route) => new URL(url(route)).searchParams.get("what"));
  while (!layers().includes("family")) await page.waitForTimeout(20);
  const first = layers().indexOf("family");
  const stale = held.slice(0, first).map(url);
  for (let waited = 0; !stale.every((url) => ended.has(url)) && waited < 10_000; waited += 20) await page.waitForTimeout(20);
  assert.ok(stale.length >= 3);
  assert.deepEqual(stale.map((url) => ended.get(url)), stale.map(() => "net::ERR_ABORTED"));
  assert.deepEqual([...new Set(layers().slice(first))], ["family"]);
  await page.unroute("**/tile?*");
  for (const route of held) await route.continue().catch(() => {});
  await settled(page);
});

test("what is not decided yet is hatched, not of the colour of stable", async () => {
  const page = await opened();
  const colours = async () => new Set((await pixels(page, Array.from({ length: 24 }, (_, k) => [200 + k, 200]))).map(String));
  await page.evaluate(() => {
    const { map } = window.kickdrift;
    map.tiles.want = () => {};
    map.tiles.layers.clear();
    map.stale = null;
    map.redraw();
  });
  await page.waitForFunction(() => !window.kickdrift.map.due);
  const shown = await colours();
  assert.ok(shown.size > 1, [...shown].join(" "));
});

test("the theme is the system's until one is chosen", async () => {
  const page = await opened({ hash: "#x=ratio,7/3,1/10,63/100", scheme: "dark" });
  await page.waitForSelector(".plot svg");
  // The lower left corner of the map is stable: it has the paper's colour.
  const paper = async () => (await pixels(page, [[2, (await page.evaluate(() => window.kickdrift.map.view.height)) - 3]])).join();
  const written = () => page.evaluate(() => getComputedStyle(document.querySelector(".plot text")).fill);
  const [dark, words] = [await paper(), await written()];
  assert.equal(dark, "18,19,24");
  await page.click("[aria-label='Light or dark']");
  await page.mouse.move(3, 3);
  await settled(page);
  assert.deepEqual([await paper(), (await written()) === words], ["255,255,255", false]);
  await page.click("[aria-label='Light or dark']");
  await settled(page);
  assert.deepEqual([await paper(), await written()], [dark, words]);
});
