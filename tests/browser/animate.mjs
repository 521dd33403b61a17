// node animate.mjs FOLDER: shoots the pictures of the README's animation into FOLDER, as 000.png, 001.png, ... `./dev animate` calls it.
// The room is paused and advances by the same number of ticks before each picture, so that the animation runs evenly however slow
// the machine is.
import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";

import { chromium } from "playwright-core";

import { executable, kChromiumArgs } from "./chromium.mjs";
import { startServer } from "./server.mjs";

const kScene = "harbor";
const kTickRateHz = 60;
/** The swell that the scene releases at 3 s is about to break on the rocks. */
const kStartTicks = 270;
const kTicksPerPicture = 4;
const kPictureCount = 75;
/** A splash of our own, `atPicture` pictures after the start. */
const kSplash = { atPicture: 24, splash: { x_m: 7, z_m: 6, radius_m: 1.6, depth_m: 1 } };
const kViewport = { width: 880, height: 560 };
/** The part of the page that is kept: the water without most of the floor and the sky. */
const kClip = { x: 60, y: 128, width: 760, height: 352 };
/** Turns of the wheel that bring the camera closer. */
const kWheelTurns = 5;
const kWaitMs = 600_000;
/** Not by animation frames: those wait for drawOnce(). */
const kPoll = { timeout: kWaitMs, polling: 100 };
/** The page's clock follows a single step at once only if the frame before is older than a second. */
const kGapMs = 1100;

const folder = process.argv[2];
if (!folder) {
  console.error("usage: node animate.mjs FOLDER");
  process.exit(2);
}
mkdirSync(folder, { recursive: true });
const server = await startServer(0, ["--scene", kScene]);
const profile = mkdtempSync(join(tmpdir(), "spindrift-chromium-"));
let context;
try {
  context = await chromium.launchPersistentContext(profile, { executablePath: executable, headless: true, viewport: kViewport, args: kChromiumArgs });
  await shoot(await context.newPage());
} finally {
  await context?.close();
  await server.stop("SIGTERM");
  rmSync(profile, { recursive: true, force: true, maxRetries: 10 });
}

async function shoot(page) {
  await command({ set_paused: { paused: true } });
  await command({ reset: {} });
  await page.addInitScript(drawOnRequest);
  await page.goto(`${server.url}?quality=high`, { timeout: kWaitMs });
  await page.addStyleTag({ content: "#card, #toast, #panel-toggle { visibility: hidden }" });
  await page.locator("#panel-toggle").evaluate((button) => button.click());
  await page.waitForFunction(() => window.spindrift.stats().connectionState === "live" && window.spindrift.stats().framesReceived.surface > 0, undefined, kPoll);
  await page.mouse.move(kViewport.width / 2, kViewport.height / 2);
  for (let turn = 0; turn < kWheelTurns; ++turn) {
    await page.mouse.wheel(0, -100);
    await page.evaluate(() => window.drawOnce());
  }
  await step(page, kStartTicks);
  for (let picture = 0; picture < kPictureCount; ++picture) {
    if (picture === kSplash.atPicture) await command({ splash: kSplash.splash });
    if (picture > 0) await step(page, kTicksPerPicture);
    const path = join(folder, `${String(picture).padStart(3, "0")}.png`);
    await page.screenshot({ path, clip: kClip, timeout: kWaitMs });
    console.log(path);
  }
}

/** Sends a command by REST; it has been applied when this returns. */
async function command(action) {
  const url = `${server.url}api/v1/rooms/main/commands`;
  const answer = await fetch(url, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(action) });
  assert.equal(answer.status, 200, `${JSON.stringify(action)}: ${await answer.text()}`);
}

/** Advances the paused room, and waits until the page has drawn the new state. */
async function step(page, ticks) {
  const before = await page.evaluate(() => window.spindrift.stats().simTime);
  await command({ step: { tick_count: ticks } });
  const wantedS = before + ticks / kTickRateHz - 1e-3;
  await page.waitForFunction((timeS) => window.spindrift.stats().simTime >= timeS, wantedS, kPoll);
  await sleep(kGapMs);
  await page.evaluate(() => window.drawOnce());
}

/** Runs in the page before its own code: animation frames wait for drawOnce(), because each takes seconds without a GPU. */
function drawOnRequest() {
  const nextFrame = window.requestAnimationFrame.bind(window);
  let waiting = [];
  window.requestAnimationFrame = (draw) => waiting.push(draw);
  window.drawOnce = () =>
    new Promise((drawn) => {
      nextFrame((timeMs) => {
        const callbacks = waiting;
        waiting = [];
        for (const draw of callbacks) draw(timeMs);
        nextFrame(drawn);
      });
    });
}
