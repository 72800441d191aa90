// Letters of figures stand where the layout has them, in Chromium and in librsvg, which reads no fonts in a document.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { SPRINGS, browser, kickdrift } from "./harness.mjs";

const SCALE = 4;
const folder = mkdtempSync(join(tmpdir(), "kickdrift-letters-"));
let chrome;
before(async () => (chrome = await browser()));
after(async () => {
  await chrome?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** In a page: the words within boxes of two pictures, [left, right, top, bottom] in pixels each; a gap of 0.15 of the height parts them. */
async function words([pictures, boxes, scale]) {
  const pixels = async (url) => {
    const image = Object.assign(new Image(), { src: url });
    await image.decode();
    const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, image.width, image.height);
  };
  const split = ({ data, width }, box) => {
    const [left, right, top, bottom] = box.map((x) => Math.round(x * scale));
    const rows = (x) => {
      const inked = [];
      for (let y = top; y < bottom; y++) if (data[4 * (y * width + x) + 1] < 128) inked.push(y);
      return inked;
    };
    const found = [];
    let last = -Infinity;
    for (let x = left; x < right; x++) {
      const inked = rows(x);
      if (inked.length === 0) continue;
      const ends = [x, x, inked[0], inked.at(-1)];
      if (x - last > 0.15 * (bottom - top)) found.push(ends);
      const own = found.at(-1);
      found[found.length - 1] = [own[0], x, Math.min(own[2], ends[2]), Math.max(own[3], ends[3])];
      last = x;
    }
    return found;
  };
  const all = await Promise.all(pictures.map(pixels));
  return boxes.map(({ name, box }) => ({ name, found: all.map((own) => split(own, box)) }));
}

test("words stand in the same boxes in Chromium and in librsvg", async (t) => {
  const file = join(folder, "map.svg");
  const scene = ["--step", "1/20", "--h1-range", "1/20..3/5", "--h2-range", "1/20..7/2", "--curves"];
  kickdrift("map", ...SPRINGS, ...scene, "--title", "Curves *T*_{1/2} = *a*/*h*_1 + *b*/*h*_2", "--quiet", "--output", file);
  const other = execFileSync("rsvg-convert", ["--zoom", String(SCALE), file], { maxBuffer: 1 << 28 });
  const page = await chrome.context.newPage();
  await page.setContent(`<body style="margin:0">${readFileSync(file, "utf8")}</body>`);
  const { size, boxes } = await page.evaluate(() => {
    const own = document.querySelector("svg").getBoundingClientRect();
    // A little room about the letters, in which nothing else stands beside axes and titles.
    const box = (at) => [at.left - 1, at.right + 1, at.top - 0.5, at.bottom + 0.5];
    const labels = [...document.querySelectorAll("g[role=img], text")].filter((label) => !label.getAttribute("transform")?.includes("rotate"));
    const name = (label) => label.getAttribute("aria-label") ?? label.textContent;
    return { size: [own.width, own.height], boxes: labels.map((label) => ({ name: name(label), box: box(label.getBoundingClientRect()) })) };
  });
  // Chromium draws it by itself, as many pixels to a length as librsvg has.
  await page.setViewportSize({ width: Math.ceil(SCALE * size[0]), height: Math.ceil(SCALE * size[1]) });
  await page.evaluate(([width, height]) => Object.assign(document.querySelector("svg").style, { width: `${width}px`, height: `${height}px`, display: "block" }), size.map((x) => SCALE * x));
  const pictures = [await page.screenshot(), other].map((png) => `data:image/png;base64,${png.toString("base64")}`);
  const found = await page.evaluate(words, [pictures, boxes, SCALE]);
  assert.ok(found.length > 10 && found.some(({ found: [own] }) => own.length > 4), "labels of several words");
  let most = 0;
  for (const { name, found: [chromium, librsvg] } of found) {
    assert.equal(librsvg.length, chromium.length, `${name}: as many words`);
    chromium.forEach((own, k) => own.forEach((end, i) => {
      // Of the word's size, and the pixel that a rounding moves an edge by.
      const length = i < 2 ? own[1] - own[0] : own[3] - own[2];
      const off = Math.abs(end - librsvg[k][i]);
      most = Math.max(most, off);
      assert.ok(off <= 0.02 * length + 1, `${name}, word ${k + 1}: ${own} in Chromium, ${librsvg[k]} in librsvg`);
    }));
  }
  t.diagnostic(`${found.length} labels, at most ${most} of ${SCALE} pixels a CSS pixel apart`);
});
