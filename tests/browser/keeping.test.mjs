// What is kept: in the address, in the past, in files, in a notebook.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { card, file, kickdrift, picture, serve, settled, spot, stage } from "./harness.mjs";

const { beside, opened } = stage();

test("a shared address brings back the same picture", async () => {
  const page = await opened();
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
  const other = await beside({ hash });
  await other.mouse.move(3, 3);
  await settled(other);
  assert.equal(await picture(other), there);
  assert.deepEqual(await card(other), await card(page));
  assert.deepEqual(other.faults, []);
  await other.close();
});

test("undo and redo go back and forth", async () => {
  const page = await opened();
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

test("what is saved is what the program makes of it, and reads again", async () => {
  const page = await opened({ hash: "#c=1", width: 640, height: 520 });
  const scene = JSON.parse(await file(page, "text=Scene file"));
  const folder = mkdtempSync(join(tmpdir(), "kickdrift-saved-"));
  const at = (name) => join(folder, name);
  const { step1, step2, h1, h2 } = scene.grid;
  for (const form of ["svg", "png"]) {
    kickdrift("map", "--lambda1", scene.lambda1, "--lambda2", scene.lambda2, "--step1", step1, "--step2", step2, "--h1-range", h1, "--h2-range", h2, "--curves", "--quiet", "--output", at(`map.${form}`));
    assert.ok((await file(page, `text=${form.toUpperCase()}`)).equals(readFileSync(at(`map.${form}`))), form);
  }
  // `run` makes the map of the scene, and the page begins where it was.
  writeFileSync(at("scene.json"), JSON.stringify(scene));
  kickdrift("run", at("scene.json"), "--quiet", "--output", at("out"));
  const cells = await page.evaluate(() => window.kickdrift.map.view.window().map(({ lo, hi }) => [lo, hi].map((end) => Number(end[0]) / Number(end[1]))));
  const map = JSON.parse(readFileSync(at("out/map.json")));
  assert.deepEqual([map.input.h1_range, map.input.h2_range], [h1, h2]);
  const own = await serve(at("scene.json"));
  const again = await beside({ address: own.address, width: 640, height: 520 });
  const window = await again.evaluate(() => window.kickdrift.begun.window);
  assert.deepEqual(window, cells.flat());
  assert.deepEqual(again.faults, []);
  await again.close();
  own.stop();
  rmSync(folder, { recursive: true });
});

test("as a guest in a notebook it asks by messages, and ends what it no longer needs", async () => {
  const page = await opened();
  const there = await page.evaluate(async () => {
    const { default: widget } = await import("./explore.js");
    // A model whose other end is this server.
    const handlers = new Set();
    const sent = (window.sent = []);
    const model = {
      get: () => 640, on: (_, handler) => handlers.add(handler), off: (_, handler) => handlers.delete(handler),
      send: async ({ id, path, query, stop }) => {
        sent.push(stop ? { stop } : { id, path });
        if (stop) return;
        if (path === "point" && window.held) return;
        const reply = await fetch(`${path}?${query}`);
        const bytes = new DataView(await reply.arrayBuffer());
        handlers.forEach((handler) => handler({ id, status: reply.status, type: reply.headers.get("content-type") }, [bytes]));
      },
    };
    const el = document.createElement("div");
    el.style.width = "1100px";
    document.body.append(el);
    window.leave = await widget.render({ model, el });
    return { faces: [...document.fonts].filter(({ family }) => family.includes("Libertinus")).length, hash: location.hash };
  });
  const [map, verdict] = [".explore >> nth=1 >> canvas >> nth=0", ".explore >> nth=1 >> .card .answer"];
  await page.waitForFunction(() => window.sent.filter(({ path }) => path === "tile").length > 0);
  await page.locator(map).scrollIntoViewIfNeeded();
  await page.locator(map).click({ position: { x: 300, y: 200 } });
  await page.waitForSelector(verdict);
  // The address is the notebook's, and so is no link offered to copy.
  assert.equal(await page.evaluate(() => location.hash), there.hash);
  assert.equal(await page.locator("text=Copy link").count(), 1);
  assert.equal(there.faces, 6);
  // A question that the pointer left behind is stopped, however long its answer takes.
  const { x, y } = await page.locator(map).boundingBox();
  const before = await page.evaluate(() => ((window.held = true), window.sent.length));
  await page.mouse.move(x + 200, y + 150);
  await page.waitForFunction((before) => window.sent.slice(before).some(({ path }) => path === "point"), before);
  const left = await page.evaluate(() => window.sent.findLast(({ path }) => path === "point").id);
  await page.mouse.move(x + 240, y + 150);
  await page.waitForFunction((left) => window.sent.some(({ stop }) => stop === left), left);
  await page.evaluate(() => window.leave());
  assert.equal(await page.locator(".explore").count(), 1);
});
