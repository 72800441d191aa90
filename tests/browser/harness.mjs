// The program, the browser, and what the tests read from both.

import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, mkdtempSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, afterEach, before } from "node:test";
import { chromium } from "playwright-core";

export const PROGRAM = process.env.KICKDRIFT;
export const SHOTS = process.env.SCREENSHOTS ?? join(tmpdir(), "kickdrift-screenshots");
mkdirSync(SHOTS, { recursive: true });

const FLAGS = [
  "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];

/** `kickdrift ARGUMENTS...`: what it prints. */
export const kickdrift = (...args) => execFileSync(PROGRAM, args, { encoding: "utf8", maxBuffer: 1 << 28 });

/** Starts `kickdrift explore`; resolves to its address once it has printed it. KICKDRIFT_PAGE: one that runs already. */
export function serve(...args) {
  if (process.env.KICKDRIFT_PAGE && args.length === 0) return Promise.resolve({ address: process.env.KICKDRIFT_PAGE, stop() {} });
  const child = spawn(PROGRAM, ["explore", "--no-open", ...args], { stdio: ["ignore", "pipe", "pipe"] });
  return new Promise((resolve, reject) => {
    let said = "";
    const read = (data) => {
      said += data;
      const address = /http:\/\/127\.0\.0\.1:\d+\/[0-9a-f]{32}\//.exec(said)?.[0];
      if (address) resolve({ address, child, stop: () => child.kill("SIGINT") });
    };
    child.stdout.on("data", read);
    child.stderr.on("data", read);
    child.on("exit", (code) => reject(new Error(`the program ended with ${code}: ${said}`)));
  });
}

export async function browser() {
  const profile = mkdtempSync(join(tmpdir(), "kickdrift-profile-"));
  const context = await chromium.launchPersistentContext(profile, { executablePath: "/usr/bin/chromium", headless: true, args: FLAGS, acceptDownloads: true });
  return { context, close: async () => (await context.close(), rmSync(profile, { recursive: true, force: true })) };
}

/** A page on the address; `faults` collects what went wrong in it by itself. */
export async function open(context, address, { hash = "", width = 1280, height = 860, scheme = "light", motion = "reduce", ready = true } = {}) {
  const page = await context.newPage();
  await page.setViewportSize({ width, height });
  await page.emulateMedia({ colorScheme: scheme, reducedMotion: motion });
  page.faults = [];
  page.on("pageerror", (error) => page.faults.push(error.stack));
  page.on("console", (message) => /Content Security Policy/i.test(message.text()) && page.faults.push(message.text()));
  await page.goto(address + hash);
  if (!ready) return page;
  await page.evaluate(() => window.kickdrift.ready);
  await settled(page);
  return page;
}

export const SPRINGS = ["--lambda1", "pi^2", "--lambda2", "pi^2/25"];

/**
 * For the tests of a file one program and one browser. `opened(options)`: a page on it, closed after the test; a test whose page threw, or
 * asked for what its policy forbids, fails. `beside(options)`: another, for the caller to close.
 */
export function stage() {
  let server, chrome, page;
  before(async () => ([server, chrome] = await Promise.all([serve(), browser()])));
  after(async () => {
    await chrome?.close();
    server?.stop();
  });
  afterEach(async () => {
    const faults = page?.faults ?? [];
    await page?.close();
    page = null;
    assert.deepEqual(faults, []);
  });
  const beside = ({ address = server.address, ...options } = {}) => open(chrome.context, address, options);
  return { address: () => server.address, beside, opened: async (options) => (page = await beside(options)) };
}

/** Is what the card says what the program says about that very pair? */
export async function agreesWithTheProgram(page) {
  const shown = await card(page);
  const told = JSON.parse(kickdrift("verdict", ...SPRINGS, "--h1", shown.h1, "--h2", shown.h2, "--format", "json"));
  assert.deepEqual([told.input.h1, told.input.h2, told.kind], [shown.h1, shown.h2, shown.kind]);
  return { shown, told };
}

/** The file that a click hands out. */
export async function file(page, selector) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(selector)]);
  return readFileSync(await download.path());
}

/** Waits until no tile that the screen shows is on its way, and past the delay after which lines are asked for and addresses written. */
export async function settled(page) {
  const quiet = () => {
    const { map, status } = window.kickdrift;
    return status && map.lettered && !status.waiting && !map.moving && !map.due;
  };
  await page.waitForFunction(quiet, null, { timeout: 180_000 });
  await page.waitForTimeout(450);
  await page.waitForFunction(quiet, null, { timeout: 180_000 });
}

/** The pixels [r, g, b] of the map's canvas at CSS pixels of the plot. */
export const pixels = (page, places) =>
  page.evaluate((places) => {
    const { map } = window.kickdrift;
    const { data, width } = map.context.getImageData(0, 0, map.canvas.width, map.canvas.height);
    return places.map(([x, y]) => {
      const at = 4 * (Math.floor((y + map.box[1]) * map.ratio) * width + Math.floor((x + map.box[0]) * map.ratio));
      return [...data.slice(at, at + 3)];
    });
  }, places);

/** The canvas as a whole: a digest of its pixels. */
export const picture = (page) =>
  page.evaluate(async () => {
    const { map } = window.kickdrift;
    const { data } = map.context.getImageData(0, 0, map.canvas.width, map.canvas.height);
    const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", data));
    return [...hash].map((byte) => byte.toString(16).padStart(2, "0")).join("");
  });

/** The middle of the canvas's plot in pixels of the page, moved by (dx, dy). */
export async function spot(page, dx = 0, dy = 0) {
  const { left, top, box } = await page.evaluate(() => {
    const { left, top } = window.kickdrift.map.canvas.getBoundingClientRect();
    return { left, top, box: window.kickdrift.map.box };
  });
  return [Math.round(left + box[0] + box[2] / 2) + dx, Math.round(top + box[1] + box[3] / 2) + dy];
}

/** The card once it has its verdict: exact h1, h2 and kind. */
export async function card(page) {
  await page.waitForSelector(".card .answer", { timeout: 180_000 });
  return page.evaluate(() => ({
    h1: document.querySelector('.card [data-exact="h1"]').textContent,
    h2: document.querySelector('.card [data-exact="h2"]').textContent,
    kind: document.querySelector(".card .answer").dataset.kind,
    command: document.querySelector(".card code").textContent,
  }));
}

export const shot = (page, name) => page.screenshot({ path: join(SHOTS, `${name}.png`) });

export const axe = readFileSync(new URL("./node_modules/axe-core/axe.min.js", import.meta.url), "utf8");
