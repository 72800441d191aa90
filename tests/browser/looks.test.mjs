// How it looks, to people and to assistive techniques.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { axe, card, shot, spot, stage } from "./harness.mjs";

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

/** The screenshot of a program that opens the address and waits until the page has loaded. */
function taken(address, width, height) {
  const profile = mkdtempSync(join(tmpdir(), "kickdrift-profile-"));
  const path = join(profile, "shot.png");
  const flags = ["--headless", "--no-sandbox", `--user-data-dir=${profile}`, `--screenshot=${path}`, `--window-size=${width},${height}`];
  execFileSync("/usr/bin/chromium", [...flags, address], { stdio: "ignore", timeout: 60_000 });
  const bytes = readFileSync(path);
  rmSync(profile, { recursive: true, force: true });
  return `data:image/png;base64,${bytes.toString("base64")}`;
}

// The canvas was black where a frame of another size was taken, and hatched where tiles were on their way.
for (const [width, height] of [[390, 844], [1400, 900], [1920, 1080]]) {
  test(`a screenshot of the address alone shows the map: ${width} x ${height}`, async () => {
    const shown = taken(address(), width, height);
    const page = await opened();
    // Along the diagonal of the picture's map, of colours that no verdict has: shares of 1.
    const strange = await page.evaluate(async ([shown, narrow]) => {
      const image = Object.assign(new Image(), { src: shown });
      await image.decode();
      const canvas = new OffscreenCanvas(image.width, image.height);
      const context = canvas.getContext("2d");
      context.drawImage(image, 0, 0);
      const [left, top, right, bottom] = narrow ? [64, 170, image.width - 45, 500] : [100, 90, image.width - 480, image.height - 160];
      const { data } = context.getImageData(left, top, right - left, bottom - top);
      const count = data.length / 4;
      let [dark, blue] = [0, 0];
      for (let n = 0; n < data.length; n += 4) {
        dark += data[n] + data[n + 1] + data[n + 2] < 60;
        blue += data[n + 2] - data[n] > 40;
      }
      return [dark / count, blue / count];
    }, [shown, width < 860]);
    assert.ok(strange[0] < 0.01 && strange[1] > 0.02, `black ${strange[0]}, unstable ${strange[1]}`);
  });
}

test("on a phone the tools lie beside the map, and the answer of a pinned pair comes into view", async () => {
  const page = await opened({ width: 390, height: 600 });
  const box = (selector) => page.evaluate((selector) => document.querySelector(selector).getBoundingClientRect().toJSON(), selector);
  const [tools, frame] = [await box(".controls"), await box(".stage .frame")];
  assert.ok(tools.bottom <= frame.top, `tools end at ${tools.bottom}, the map begins at ${frame.top}`);
  await page.mouse.click(...(await spot(page)));
  await card(page);
  const seen = () => {
    const { top, bottom } = document.querySelector(".card .answer").getBoundingClientRect();
    // A page scrolls by whole pixels, and boxes end between them.
    return top > -1 && bottom < innerHeight + 1;
  };
  await page.waitForFunction(seen, null, { timeout: 5_000 });
});

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
