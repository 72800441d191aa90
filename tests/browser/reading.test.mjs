// What the page tells of a pair and of the map, and what people expect of a map in a browser.

import assert from "node:assert/strict";
import { test } from "node:test";
import { SPRINGS, card, kickdrift, picture, settled, spot, stage } from "./harness.mjs";

const { address, opened } = stage();

/** The nth number in a text, as the page writes it. */
const numbers = (text) => [...text.replace(/−/g, "-").replace(/,(?=\d{3})/g, "").matchAll(/-?\d+(?:\.\d+)?/g)].map(([digits]) => Number(digits));

/** Rounded to so many digits, as the page rounds. */
const near = (shown, value, digits) => assert.ok(Math.abs(shown / value - 1) <= 0.5 * 10 ** (1 - digits), `${shown} for ${value}`);

test("the pointer reads the exact pair, its verdict, growth and tenfold", async () => {
  // At zoom 0 a cell is a pixel.
  const page = await opened({ hash: "#d=1/1000&v=432,132,0,0,3" });
  const middle = await spot(page);
  const { at, pair } = await page.evaluate(([x, y]) => {
    const { map, input } = window.kickdrift;
    const { layer } = window.kickdrift.settings();
    for (let dy = -60; dy < 60; dy++) {
      for (let dx = -60; dx < 60; dx++) {
        const [px, py] = input.at({ clientX: x + dx, clientY: y + dy });
        const cells = [map.view.cell(px, 0), map.view.cell(py, 1)];
        if ((map.tiles.value(layer, map.view.level, cells) & 3) === 1) return { at: [x + dx, y + dy], pair: map.view.pair(px, py).map(([n, d]) => `${n}/${d}`) };
      }
    }
    return null;
  }, middle);
  await page.mouse.move(...at);
  await page.waitForFunction(() => /tenfold/.test(document.querySelector(".readout").textContent));
  const told = JSON.parse(kickdrift("verdict", ...SPRINGS, "--h1", pair[0], "--h2", pair[1], "--format", "json"));
  const [steps, verdict, ratio, growth] = await page.$$eval(".readout > div", (rows) => rows.map((row) => row.textContent));
  const value = (fraction) => fraction.split("/").map(Number).reduce((a, b) => a / b);
  const shown = await page.$$eval(".readout .pair b", (all) => all.map((own) => Number(own.textContent)));
  assert.deepEqual(shown, pair.map(value), steps);
  assert.match(verdict, /^Unstable exponential growth, hyperbolic/);
  assert.equal(told.kind, "hyperbolic");
  assert.ok(ratio.includes(` = ${told.p}/${told.q}, tongue m = ${told.resonance.m}, family (${told.resonance.a}, ${told.resonance.b})`.replace(/-/g, "−")), ratio);
  const rate = (told.growth_rate.lo + told.growth_rate.hi) / 2;
  const [grows, slow, time] = numbers(growth);
  near(grows, rate, 3);
  near(time, Math.LN10 / rate, 3);
  near(slow, Math.LN10 / rate / value(pair[1]), 3);
});

test("a card has the tongue's certified edges and the nearest others", async () => {
  const page = await opened({ hash: "#p=49/100,343/300" });
  await card(page);
  const rows = await page.$$eval(".card dt", (names) => names.map((name) => [name.textContent, name.nextSibling.textContent]));
  const row = (name) => rows.find(([own]) => own === name)?.[1] ?? assert.fail(`${name} among ${rows.map(([own]) => own)}`);
  const { tongues } = JSON.parse(kickdrift("tongues", ...SPRINGS, "--ratio", "7/3", "--columns", "edges", "--format", "json"));
  const at = tongues.findIndex(({ lower, upper }) => lower.h1.hi <= 0.49 && upper.h1.lo >= 0.49);
  assert.ok(at > 0 && at + 1 < tongues.length);
  const [below, own, above] = tongues.slice(at - 1, at + 2);
  // Digits that both ends share once rounded.
  const certain = (shown, { lo, hi }) => {
    const digits = String(shown).replace(/^0\.0*/, "").replace(".", "").length;
    assert.ok(digits >= 9, `${shown} is short`);
    for (const end of [lo, hi]) near(shown, end, digits);
  };
  assert.equal(row("h2/h1"), "7/3");
  assert.match(row("tongue"), new RegExp(`^m = ${own.m}, family \\(`));
  for (const axis of ["h1", "h2"]) {
    const [from, to] = numbers(row(`edges in ${axis}`));
    certain(from, own.lower[axis]);
    certain(to, own.upper[axis]);
  }
  for (const [name, tongue, edge] of [["tongue below", below, below.upper], ["tongue above", above, above.lower]]) {
    const [m, index, shown] = numbers(row(name));
    assert.deepEqual([m, index], [tongue.m, 1], row(name));
    certain(shown, edge.h1);
  }
  const told = JSON.parse(kickdrift("verdict", ...SPRINGS, "--h1", "49/100", "--h2", "343/300", "--format", "json"));
  certain(numbers(row("growth rate"))[0], told.growth_rate);
  certain(numbers(row("trace"))[0], told.trace);
  assert.ok(row("decided by").startsWith(told.decided_by), row("decided by"));
});

test("the grid that is sampled is said, and where it would cost too much, what is shown instead", async () => {
  const page = await opened();
  const said = async () => (await page.textContent(".said")).replace(/\u00a0/g, " ");
  const grid = await page.evaluate(() => {
    const { view } = window.kickdrift.map;
    return [0, 1].map((axis) => view.coordinate(1n, axis).join("/"));
  });
  assert.equal(await said().then((words) => words.split(".")[0]), `Every cell is one exact verdict: multiples of d1 = ${grid[0]} and d2 = ${grid[1]}`);
  await page.fill("#go-h1", "12/25");
  await page.fill("#go-h2", "1.12");
  await page.click("text=Go to this pair");
  await page.focus("canvas");
  for (let k = 0; k < 110; k++) await page.keyboard.press("+");
  await settled(page);
  await page.waitForFunction(() => /Shown instead/.test(document.querySelector(".said").textContent), null, { timeout: 60_000 });
  const words = await said();
  assert.match(words, /^A tile of d1 = \S+ would cost \S+ kicks \(limit \S+\)\. Shown instead: certified tongues wider than a cell, all ratios with p \+ q ≤ [\d,]+\./);
  // As many as it says: the program lays out the same ratios.
  const sum = await page.evaluate(() => window.kickdrift.map.vectors.tongues.data.max_sum);
  assert.ok(words.includes(`p + q ≤ ${String(sum).replace(/\B(?=(\d{3})+$)/g, ",")}.`));
});

test("labels can be ticked where there is a line that they stand at, and say so where there is none", async () => {
  const page = await opened();
  const labels = page.getByLabel("Labels", { exact: true });
  assert.deepEqual([await labels.isDisabled(), await labels.isChecked()], [true, false]);
  assert.match(await page.locator("label", { hasText: /^Labels$/ }).getAttribute("title"), /curves/);
  await page.locator("label", { hasText: "Curves" }).click();
  await settled(page);
  assert.deepEqual([await labels.isDisabled(), await labels.isChecked()], [false, true]);
});

test("curves, tongues and labels come on request and go again", async () => {
  const page = await opened({ hash: "#b=0" });
  const plain = await picture(page);
  const after = async (act) => {
    await act();
    await page.mouse.move(3, 3);
    // Lines are asked for, too.
    await page.waitForFunction(() => (({ state, map: { vectors } }) => (!state.curves || vectors.curves) && (state.tongues !== "on" || vectors.tongues))(window.kickdrift), null, { timeout: 60_000 });
    await settled(page);
    return picture(page);
  };
  const curves = page.locator("label", { hasText: "of the Proposition" });
  const withCurves = await after(() => curves.click());
  const labelled = await after(() => page.locator("label", { hasText: /^Labels$/ }).click());
  const tongues = await after(() => page.selectOption("#tongues", "on"));
  assert.equal(new Set([plain, withCurves, labelled, tongues]).size, 4);
  await page.selectOption("#tongues", "auto");
  await page.locator("label", { hasText: /^Labels$/ }).click();
  assert.equal(await after(() => curves.click()), plain);
});

test("the slider of rho moves the springs", async () => {
  const page = await opened();
  const before = await picture(page);
  await page.focus("input[type=range]");
  for (let k = 0; k < 5; k++) await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => window.kickdrift.state.rho !== "1/25");
  await settled(page);
  // Five hundredths of a decade above 1/25, to two digits.
  assert.equal(await page.evaluate(() => window.kickdrift.state.rho), "9/200");
  assert.equal(await page.inputValue("#lambda2"), "9*pi^2/200");
  await page.mouse.move(3, 3);
  await settled(page);
  assert.notEqual(await picture(page), before);
  await page.focus("canvas");
  await page.keyboard.press("Control+z");
  await page.waitForFunction(() => window.kickdrift.state.rho === "1/25");
});

test("a click into the strip takes its rho, and its field another ratio", async () => {
  const page = await opened({ hash: "#s=5/3" });
  await page.waitForSelector(".plot svg circle", { timeout: 60_000 });
  const box = await page.locator(".plot .frame").boundingBox();
  await page.mouse.click(box.x + 0.75 * box.width, box.y + 0.5 * box.height);
  // Four decades from 1/1000 to 10: three quarters of them are 1.
  await page.waitForFunction(() => window.kickdrift.state.rho !== "1/25");
  near(await page.evaluate(() => window.kickdrift.state.values.rho), 1, 2);
  await page.fill("[aria-label='Ratio p/q of the strip']", "7/3");
  await page.keyboard.press("Enter");
  await page.waitForFunction(() => window.kickdrift.drawer.data?.reply.tongues.length === 9, null, { timeout: 60_000 });
  assert.equal(await page.evaluate(() => window.kickdrift.state.strip), "7/3");
});

test("wheel, double click and Shift with a drag zoom where the pointer is", async () => {
  const page = await opened();
  const [x, y] = await spot(page, 130, -90);
  const below = () => page.evaluate(([clientX, clientY]) => {
    const { map, input } = window.kickdrift;
    const at = input.at({ clientX, clientY });
    return { zoom: map.view.zoom, pair: [0, 1].map((axis) => Number(map.view.cell(at[axis], axis, 20)) / 2 ** 20), pixel: 2 ** -map.view.zoom };
  }, [x, y]);
  const first = await below();
  const stays = async (levels) => {
    await settled(page);
    const now = await below();
    assert.ok(Math.abs(now.zoom - first.zoom - levels) < 1e-6, `${now.zoom - first.zoom} levels`);
    first.pair.forEach((value, axis) => assert.ok(Math.abs(value - now.pair[axis]) < 0.01 * now.pixel));
  };
  await page.mouse.move(x, y);
  await page.mouse.wheel(0, -360);
  await stays(1);
  await page.mouse.dblclick(x, y);
  await stays(2);
  assert.equal(await page.isVisible(".card .answer"), false);
  await page.keyboard.down("Shift");
  await page.mouse.dblclick(x, y);
  await page.keyboard.up("Shift");
  await stays(1);
  await page.mouse.wheel(0, 360);
  await stays(0);
  // A box drawn with Shift fills the map as far as its shape allows, and lies in its middle.
  const sides = (from, to) => page.evaluate(([from, to]) => {
    const { map: { view } } = window.kickdrift;
    const at = (px, axis) => Number(view.cell(px, axis, 30)) / 2 ** 30;
    return [0, 1].map((axis) => {
      const [lo, hi] = [at(from ? from[axis] : axis * view.height, axis), at(to ? to[axis] : (1 - axis) * view.width, axis)];
      return { middle: (lo + hi) / 2, width: hi - lo };
    });
  }, [from, to]);
  const pixel = (dx, dy) => page.evaluate(([clientX, clientY]) => window.kickdrift.input.at({ clientX, clientY }), [x + dx, y + dy]);
  const drawn = await sides(await pixel(-100, 60), await pixel(60, -40));
  await page.keyboard.down("Shift");
  await page.mouse.move(x - 100, y + 60);
  await page.mouse.down();
  await page.mouse.move(x + 60, y - 40, { steps: 4 });
  await page.mouse.up();
  await page.keyboard.up("Shift");
  await settled(page);
  const shown = await sides(null, null);
  const shares = drawn.map(({ width }, axis) => width / shown[axis].width);
  assert.ok(Math.abs(Math.max(...shares) - 1) < 1e-6 && Math.min(...shares) > 0.3, `${shares}`);
  shown.forEach(({ middle, width }, axis) => assert.ok(Math.abs(middle - drawn[axis].middle) < 1e-6 * width, `axis ${axis}: ${middle}`));
});

test("the view's address and the command are copied", async () => {
  const page = await opened({ hash: "#p=49/100,343/300&w=growth" });
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await card(page);
  const kept = () => page.evaluate(() => navigator.clipboard.readText());
  await page.click("text=Copy link");
  await page.waitForFunction(() => [...document.querySelectorAll("[role=status]")].some((own) => own.textContent === "copied"));
  assert.equal(await kept(), await page.evaluate(() => location.href));
  await page.click("[aria-label='Copy the command']");
  await page.waitForFunction(() => document.querySelector("[aria-live]").textContent === "copied");
  assert.equal(await kept(), "kickdrift verdict --lambda1 pi^2 --lambda2 pi^2/25 --h1 49/100 --h2 343/300");
});

for (const [name, width, height] of [["wide", 1280, 860], ["narrow", 390, 844]]) {
  test(`nothing jumps while the page opens and is pointed at, and the map stays where it is when a pair is pinned: ${name}`, async () => {
    const page = await opened({ address: "about:blank", ready: false, width, height });
    // Before any script of the page.
    await page.addInitScript(() => {
      window.jumps = [];
      new PerformanceObserver((list) => window.jumps.push(...list.getEntries().map((entry) => [entry.value, ...entry.sources.map(({ node }) => node?.className ?? "?")]))).observe({ type: "layout-shift", buffered: true });
    });
    await page.goto(address());
    await page.evaluate(() => window.kickdrift.ready);
    await settled(page);
    const frame = () => page.evaluate(() => JSON.stringify(document.querySelector(".frame").getBoundingClientRect()));
    const before = await frame();
    for (const [dx, dy] of [[40, 10], [-30, 60], [0, -80]]) await page.mouse.move(...(await spot(page, dx, dy)));
    await settled(page);
    assert.deepEqual(await page.evaluate(() => window.jumps), []);
    await page.mouse.click(...(await spot(page)));
    await card(page);
    assert.equal(await frame(), before);
  });
}
