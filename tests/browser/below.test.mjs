// What is drawn below the map: cuts, strips, a system; and the springs that all of it is about.

import assert from "node:assert/strict";
import { test } from "node:test";
import { SPRINGS, kickdrift, picture, serve, settled, shot, spot, stage } from "./harness.mjs";

const { opened } = stage();

for (const [kind, title] of [["h1", "Cut at fixed h1"], ["h2", "Cut at fixed h2"], ["ratio", "Cut along a ratio h2/h1"]]) {
  test(`a stroke over the map is a cut of fixed ${kind}`, async () => {
    const page = await opened();
    await page.click(`label[title='${title}']`);
    const [from, to] = [await spot(page, -140, 60), await spot(page, 150, -90)];
    const pairs = await page.evaluate(([from, to]) => {
      const { map, input } = window.kickdrift;
      return [from, to].map(([clientX, clientY]) => map.view.pair(...input.at({ clientX, clientY })).map((h) => h.join("/")));
    }, [from, to]);
    await page.mouse.move(...from);
    await page.mouse.down();
    await page.mouse.move(...to, { steps: 6 });
    await page.mouse.up();
    await page.waitForSelector(".plot svg", { timeout: 60_000 });
    const { cut, tool } = await page.evaluate(() => ({ cut: window.kickdrift.state.cut, tool: window.kickdrift.tool }));
    assert.deepEqual([cut.kind, tool], [kind, "move"]);
    const exact = (text) => text.replace(/\/1$/, "");
    const [h1, h2] = [0, 1].map((axis) => pairs.map((pair) => exact(pair[axis])));
    if (kind === "h1") assert.deepEqual([cut.value, cut.lo, cut.hi], [h1[0], ...h2]);
    if (kind === "h2") assert.deepEqual([cut.value, cut.lo, cut.hi], [h2[0], ...h1]);
    // The simplest ratio within three pixels of where the stroke begins; each pixel is 8/1000 of h2.
    const value = (text) => text.split("/").map(Number).reduce((a, b) => a / b);
    if (kind === "ratio") assert.ok(Math.abs(value(cut.value) * value(h1[0]) - value(h2[0])) <= 0.03, `${cut.value} at ${h1[0]}, ${h2[0]}`);
    const said = await page.textContent(".below");
    assert.match(said, kind === "ratio" ? /unstable intervals, certified edges/ : /401 exact verdicts/);
  });
}

test("a cut shows growth with certified edges", async () => {
  const page = await opened({ hash: "#x=ratio,7/3,1/10,63/100" });
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
  const page = await opened({ hash: "#s=5/3" });
  await page.waitForSelector(".plot svg circle", { timeout: 60_000 });
  const cells = await page.$$eval(".below tbody td", (cells) => cells.map((cell) => cell.textContent));
  // The page may write fractions or twelve digits of them.
  const value = (text) => text.split("/").map(Number).reduce((a, b) => a / b);
  assert.equal(cells[0], "4");
  assert.ok(Math.abs(value(cells[1]) - 11 / 4) < 1e-11 && Math.abs(value(cells[2]) - 114 / 55) < 1e-11, String(cells));
});

test("a new rho is read exactly, a bad one is told", async () => {
  const page = await opened();
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

test("a system of many degrees of freedom shows growth, whatever its unstable intervals cost", async () => {
  for (const name of ["flexible-water.json", "bar-resonant.json"]) {
    const own = await serve(process.env.KICKDRIFT_SYSTEM.replace("two-bars.json", name));
    const page = await opened({ address: own.address, ready: false });
    await page.waitForSelector(".plot polyline", { timeout: 60_000 });
    assert.match(await page.textContent(".below"), /outer step, \S+ [a-z]+: (un)?stable/);
    await shot(page, name.replace(".json", ""));
    await page.close();
    own.stop();
  }
});

test("a system's growth is the program's, at its own step and where it is proven unstable", async () => {
  const path = process.env.KICKDRIFT_SYSTEM;
  const own = await serve(path);
  const told = JSON.parse(kickdrift("system", path, "--format", "json"));
  const page = await opened({ address: own.address, hash: "#y=1" });
  await page.waitForSelector(".plot svg", { timeout: 30_000 });
  assert.match(await page.textContent(".below"), new RegExp(`outer step, [\\d.]+ [a-z]+: ${told.stable ? "stable" : "unstable"}`));
  await page.waitForFunction(() => window.kickdrift.drawer.data.reply.stretches, null, { timeout: 60_000 });
  const { reply, shades } = await page.evaluate(() => ({ reply: window.kickdrift.drawer.data.reply, shades: document.querySelectorAll(".plot svg svg rect").length }));
  const kept = (name) => reply.stretches.filter(({ verdict }) => verdict === name).length;
  assert.ok(kept("unstable") > 0 && shades === kept("unstable") + kept("the data do not tell"), `${shades} shades`);
  const words = await page.textContent(".below");
  assert.ok(words.includes(`proven unstable on ${kept("unstable")} `), words);
  // One that is thinner than a pixel is to be seen, too.
  const widths = await page.evaluate(() => [...document.querySelectorAll(".plot svg svg rect")].map((rect) => Number(rect.getAttribute("width"))));
  assert.ok(widths.every((width) => width >= 3), widths.join(" "));
  // A sample in a stretch that is proven unstable grows, one where it is proven stable does not.
  const at = (x) => reply.stretches.find(({ lo, hi }) => lo < x && x < hi)?.verdict;
  const wrong = reply.outer.filter((x, k) => (at(x) === "unstable" && !(reply.rate[k] > 0)) || (at(x) === "stable" && reply.rate[k] > 0));
  assert.deepEqual(wrong, []);
  // Where it grows most a click tells the modes, and the address has them.
  const box = await page.locator(".plot .frame").boundingBox();
  const most = reply.rate.indexOf(Math.max(...reply.rate));
  const share = (reply.outer[most] - reply.outer[0]) / (reply.outer.at(-1) - reply.outer[0]);
  const peak = [box.x + share * box.width, box.y + 0.5 * box.height];
  await page.mouse.move(...peak);
  assert.match(await page.textContent(".below p"), /^Outer step \S+ \S+: growth (\S+ per|none)/);
  await page.mouse.click(...peak);
  await page.waitForFunction(() => window.kickdrift.drawer.modes);
  const { at: chosen, verdict } = await page.evaluate(() => window.kickdrift.drawer.modes);
  assert.ok(Math.abs(chosen / reply.outer[most] - 1) < 0.01 && !verdict.stable, `${chosen}: ${verdict.kind}`);
  const growing = verdict.parts.flatMap(({ instabilities }) => instabilities);
  assert.ok(growing.length > 0);
  assert.match(await page.textContent(".below"), new RegExp(`At the outer step that was chosen, ${chosen} [a-z]+: unstable, .*${growing.length} modes? grows?`));
  await page.waitForFunction((chosen) => new URLSearchParams(location.hash.slice(1)).get("a") === String(chosen), chosen);
  own.stop();
});
