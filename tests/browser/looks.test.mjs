// How it looks, to people and to assistive techniques.

import assert from "node:assert/strict";
import { test } from "node:test";
import { axe, card, shot, stage } from "./harness.mjs";

const { beside, opened } = stage();

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
