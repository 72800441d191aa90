// `kickdrift explore` in a real browser.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, afterEach, before, test } from "node:test";
import { axe, browser, card, kickdrift, open, picture, pixels, serve, settled, shot, spot } from "./harness.mjs";

const SPRINGS = ["--lambda1", "pi^2", "--lambda2", "pi^2/25"];
let server, chrome, page;

const opened = async (options) => (page = await open(chrome.context, server.address, options));

before(async () => {
  server = await serve();
  chrome = await browser();
});
after(async () => {
  await chrome?.close();
  server?.stop();
});
afterEach(async () => {
  assert.deepEqual(page?.faults ?? [], [], "the page threw, or asked for what its policy forbids");
  await page?.close();
  page = null;
});

/** Is what the card says what the program says about that very pair? */
async function agreesWithTheProgram() {
  const shown = await card(page);
  const told = JSON.parse(kickdrift("verdict", ...SPRINGS, "--h1", shown.h1, "--h2", shown.h2, "--format", "json"));
  assert.deepEqual([told.input.h1, told.input.h2, told.kind], [shown.h1, shown.h2, shown.kind]);
  return { shown, told };
}

test("a drag moves the map by the pixels dragged", async () => {
  await opened();
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
  await opened();
  for (const [dx, dy] of [[-100, 0], [37, -141], [180, 60]]) {
    await page.mouse.click(...(await spot(page, dx, dy)));
    const { shown, told } = await agreesWithTheProgram();
    const again = kickdrift(...shown.command.replace(/^kickdrift /, "").replace(/'/g, "").split(" "), "--format", "json");
    assert.equal(JSON.parse(again).kind, told.kind);
    await page.click(".card [aria-label='Remove the pin']");
  }
});

test("the card's files are the program's", async () => {
  // Certificates are for rational numbers.
  await opened({ hash: "#l1=10&l2=2/5&p=49/100,343/300" });
  await card(page);
  const file = async (label) => {
    const [download] = await Promise.all([page.waitForEvent("download"), page.click(`.card >> text=${label}`)]);
    return readFileSync(await download.path(), "utf8");
  };
  const program = kickdrift("verdict", "--lambda1", "10", "--lambda2", "2/5", "--h1", "49/100", "--h2", "343/300", "--format", "json");
  assert.deepEqual(JSON.parse(await file("JSON")), JSON.parse(program));
  assert.match(await file("Certificate"), /Theorem kickdrift_verdict/);
});

test("two fingers zoom about the point between them", async () => {
  await opened();
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

test("two hundred levels down a click on a tongue is still exact", async () => {
  await opened();
  await page.fill("#go-h1", "49/100");
  await page.fill("#go-h2", "343/300");
  await page.click("text=Go to this pair");
  await page.focus("canvas");
  for (let k = 0; k < 202; k++) await page.keyboard.press("+");
  await settled(page);
  assert.ok((await page.evaluate(() => window.kickdrift.map.view.level)) >= 200);
  await page.waitForFunction(() => window.kickdrift.map.vectors.lines(window.kickdrift.map.view).length > 0, null, { timeout: 60_000 });
  const line = await page.evaluate(() => {
    const { map } = window.kickdrift;
    const { x0, y0, x1, y1, segment } = map.vectors.lines(map.view)[0];
    const x = map.view.width * 0.3;
    return { ratio: [segment.p, segment.q], x, y: y0 + ((x - x0) / (x1 - x0)) * (y1 - y0), middle: [map.view.width / 2, map.view.height / 2] };
  });
  assert.deepEqual(line.ratio, [7, 3]);
  const [x, y] = await spot(page, line.x - line.middle[0], line.y - line.middle[1]);
  await page.mouse.click(Math.round(x), Math.round(y));
  const { shown, told } = await agreesWithTheProgram();
  assert.deepEqual([told.p, told.q, told.kind], [7, 3, "hyperbolic"]);
  // d / 2^200 in lowest terms has some 190 bits left: what was clicked is no coarser pair.
  assert.ok(shown.h1.length > 55, shown.h1);
  await shot(page, "deep-light");
});

test("cells are those of the program's own picture", async () => {
  // At zoom 0 a cell is a pixel: d1 = 1/1000, d2 = 8/1000.
  await opened({ hash: "#d=1/1000&v=432,132,0,0,3" });
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

test("a shared address brings back the same picture", async () => {
  await opened();
  await page.mouse.move(...(await spot(page, 90, 70)));
  await page.mouse.wheel(0, -700);
  await settled(page);
  await page.mouse.click(...(await spot(page, 30, 30)));
  await page.click('label[title="Growth"]');
  await page.mouse.move(3, 3);
  await settled(page);
  await card(page);
  await page.waitForTimeout(600);
  const [there, hash] = [await picture(page), await page.evaluate(() => location.hash)];
  const other = await open(chrome.context, server.address, { hash });
  await other.mouse.move(3, 3);
  await settled(other);
  assert.equal(await picture(other), there);
  assert.deepEqual(await card(other), await card(page));
  assert.deepEqual(other.faults, []);
  await other.close();
});

test("undo and redo go back and forth", async () => {
  await opened();
  const before = await picture(page);
  await page.focus("canvas");
  await page.keyboard.press("+");
  await page.mouse.move(3, 3);
  await settled(page);
  await page.evaluate(() => document.activeElement.blur());
  await settled(page);
  const after = await picture(page);
  assert.notEqual(after, before);
  await page.click("[aria-label^=Undo]");
  await page.mouse.move(3, 3);
  await settled(page);
  assert.equal(await picture(page), before);
  await page.click("[aria-label^=Redo]");
  await page.mouse.move(3, 3);
  await settled(page);
  assert.equal(await picture(page), after);
});

test("lines of tongues lie on unstable cells", async () => {
  // Cells of 1/8000 along h1, and d2 = d1: multiples of both steps lie on every simple ray.
  await opened({ hash: "#d=1/1000&v=490,1145,0,3,0&t=on&n=40&b=0" });
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
        if (value !== undefined) found.push([segment.p, segment.q, Number(k), value & 3]);
      }
    }
    return found;
  });
  const distinct = new Set(cells.map(String));
  assert.ok(distinct.size > 30, `${distinct.size} cells lie on lines`);
  assert.deepEqual(cells.filter(([, , , kind]) => kind !== 1), []);
});

test("the keyboard does what the pointer does", async () => {
  await opened();
  await page.focus("canvas");
  const view = () => page.evaluate(() => window.kickdrift.map.view.save());
  const home = await view();
  for (const key of ["ArrowLeft", "ArrowUp", "+"]) await page.keyboard.press(key);
  await settled(page);
  assert.notEqual(await view(), home);
  await page.keyboard.press("Enter");
  await agreesWithTheProgram();
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

test("a cut shows growth with certified edges", async () => {
  await opened({ hash: "#x=ratio,7/3,1/10,63/100" });
  await page.waitForSelector(".plot svg", { timeout: 60_000 });
  const rows = await page.$$eval(".below tbody tr", (rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent)));
  const told = JSON.parse(kickdrift("tongues", ...SPRINGS, "--ratio", "7/3", "--columns", "edges", "--format", "json")).tongues.filter((t) => t.lower.h1.lo < 0.63);
  assert.equal(rows.length, told.length);
  told.forEach((tongue, k) => {
    assert.equal(rows[k][0], String(tongue.m));
    // Eight digits of the enclosure are on the page at least.
    assert.ok(rows[k][2].startsWith(tongue.lower.h1.lo.toFixed(9).slice(0, 9)), rows[k][2]);
  });
});

test("a strip marks the closing of 5/3", async () => {
  await opened({ hash: "#s=5/3" });
  await page.waitForSelector(".plot svg circle", { timeout: 60_000 });
  const cells = await page.$$eval(".below tbody td", (cells) => cells.map((cell) => cell.textContent));
  // The page may write fractions or twelve digits of them.
  const value = (text) => text.split("/").map(Number).reduce((a, b) => a / b);
  assert.equal(cells[0], "4");
  assert.ok(Math.abs(value(cells[1]) - 11 / 4) < 1e-11 && Math.abs(value(cells[2]) - 114 / 55) < 1e-11, String(cells));
});

test("a new rho is read exactly, a bad one is told", async () => {
  await opened();
  const before = await picture(page);
  await page.fill("#rho", "7/2");
  await page.keyboard.press("Enter");
  await settled(page);
  assert.notEqual(await picture(page), before);
  assert.equal(await page.inputValue("#lambda2"), "7*pi^2/2");
  await page.fill("#rho", "3//");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => document.querySelector(".error[role=alert]").textContent.length > 0);
});

for (const scheme of ["light", "dark"]) {
  for (const [name, width, height] of [["wide", 1400, 900], ["narrow", 390, 844]]) {
    test(`no serious fault for assistive techniques: ${scheme}, ${name}`, async () => {
      await opened({ hash: "#p=49/100,343/300&x=ratio,7/3,1/10,63/100&c=1", scheme, width, height });
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
        await opened({ hash, scheme, width, height });
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

test("figures: first tile, frames while dragging", async (t) => {
  await opened();
  const marks = await page.evaluate(() => {
    const entries = performance.getEntriesByType("resource").filter(({ name }) => name.includes("/tile?"));
    return { first: Math.min(...entries.map((e) => e.responseEnd)), all: Math.max(...entries.map((e) => e.responseEnd)), paint: performance.getEntriesByName("first-contentful-paint")[0]?.startTime };
  });
  t.diagnostic(`first paint ${marks.paint?.toFixed(0)} ms, first tile ${marks.first.toFixed(0)} ms, all tiles ${marks.all.toFixed(0)} ms after opening`);
  const [x, y] = await spot(page);
  await page.evaluate(() => {
    window.times = [];
    const note = (time) => (window.times.push(time), (window.noting = requestAnimationFrame(note)));
    window.noting = requestAnimationFrame(note);
  });
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let k = 0; k < 120; k++) await page.mouse.move(x + 60 * Math.sin(k / 10), y + 40 * Math.cos(k / 10));
  await page.mouse.up();
  const gaps = await page.evaluate(() => {
    cancelAnimationFrame(window.noting);
    return window.times.slice(1).map((time, k) => time - window.times[k]).sort((a, b) => a - b);
  });
  const cost = await page.evaluate(() => {
    const { map } = window.kickdrift;
    const begun = performance.now();
    for (let k = 0; k < 50; k++) map.paint();
    return (performance.now() - begun) / 50;
  });
  t.diagnostic(`${gaps.length} frames while dragging: median ${gaps[gaps.length >> 1].toFixed(1)} ms, 95 % within ${gaps[Math.floor(0.95 * gaps.length)].toFixed(1)} ms; a picture takes ${cost.toFixed(1)} ms of script`);
  assert.ok(gaps.length > 10);
});
