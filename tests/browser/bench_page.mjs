// Measures the page in headless Chromium against the real server, with software WebGL: time to the first picture, pictures per second, and
// the time of each pass, and the processor time of the browser per picture, which depends little on what else runs on the machine. `npm run bench:page` in web-client builds the page and calls this. The server must be built (`./dev build`).
//   bench_page.mjs [--scenes A,B] [--qualities minimal,high,automatic] [--seconds S] [--size 1280x720]
import { rmSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { parseArgs } from "node:util";

import { chromium } from "playwright-core";

import { executable, kChromiumArgs } from "./chromium.mjs";
import { cpuSecondsOf } from "./cpu_time.mjs";
import { startServer, temporaryFolder } from "./server.mjs";

const kWaitMs = 120_000;
/** The browser is open before the page is asked for, as a visitor's: its own start takes half a second more. */
const kBrowserStartMs = 3000;
/** Programs are compiled, and the water begins to move. */
const kSettleMs = 5000;
const kSamplesPerS = 2;
const kTiers = ["minimal", "low", "medium", "high", "highest", "automatic"];
const kPassPictures = 12;

const { values } = parseArgs({
  options: {
    scenes: { type: "string", default: "harbor,dam_break" },
    qualities: { type: "string", default: "minimal" },
    seconds: { type: "string", default: "10" },
    size: { type: "string", default: "1280x720" },
  },
});
const seconds = Number(values.seconds);
const [width, height] = values.size.split("x").map(Number);
const qualities = values.qualities.split(",");
const unknown = qualities.find((quality) => !kTiers.includes(quality));
if (unknown !== undefined) console.error(`there is no quality "${unknown}": ${kTiers.join(", ")}`);
if (unknown !== undefined || !(seconds > 0 && width > 0 && height > 0)) {
  console.error("usage: bench_page.mjs [--scenes A,B] [--qualities minimal,high] [--seconds S] [--size WIDTHxHEIGHT]");
  process.exit(2);
}

for (const scene of values.scenes.split(",")) {
  const server = await startServer(0, ["--scene", scene]);
  try {
    for (const quality of qualities) await measure(scene, quality, server.url);
  } finally {
    await server.stop("SIGTERM");
  }
}

async function measure(scene, quality, url) {
  const profile = temporaryFolder("chromium");
  const context = await chromium.launchPersistentContext(profile, { executablePath: executable, headless: true, viewport: { width, height }, args: kChromiumArgs });
  try {
    const page = await context.newPage();
    await sleep(kBrowserStartMs);
    const begunMs = performance.now();
    await page.goto(`${url}?quality=${quality}`);
    await page.waitForFunction(() => (window.spindrift?.stats().shownTimeS ?? null) !== null, undefined, { timeout: kWaitMs, polling: 20 });
    const firstS = (performance.now() - begunMs) / 1000;
    await sleep(kSettleMs);
    const rates = [];
    await page.evaluate(() => {
      window.picturesCount = 0;
      const count = () => (++window.picturesCount, requestAnimationFrame(count));
      count();
    });
    const cpuNow = async () => ({ picturesCount: await page.evaluate(() => window.picturesCount), cpuS: cpuSecondsOf(profile) });
    const cpuBefore = await cpuNow();
    for (let i = 0; i < seconds * kSamplesPerS; ++i) {
      await sleep(1000 / kSamplesPerS);
      rates.push(await page.evaluate(() => window.spindrift.stats().displayFps));
    }
    const cpuAfter = await cpuNow();
    const perPictureMs = Object.entries(cpuAfter.cpuS).map(([kind, cpuS]) => [kind, (1000 * (cpuS - (cpuBefore.cpuS[kind] ?? 0))) / (cpuAfter.picturesCount - cpuBefore.picturesCount)]);
    rates.sort((a, b) => a - b);
    const { pixelRatio } = await page.evaluate(() => window.spindrift.stats());
    const timesMs = await page.evaluate((count) => window.spindrift.passTimesMs(count), kPassPictures);
    const { "read back": readBackMs, ...passes } = timesMs;
    const rate = (share) => rates[Math.floor(share * (rates.length - 1))].toFixed(1);
    console.log(`${scene}, ${quality}, ${width} x ${height} at pixel ratio ${pixelRatio.toFixed(2)}: first picture with water after ${firstS.toFixed(2)} s, ` +
      `${rate(0.5)} pictures/s (lowest ${rate(0)})`);
    const cpuMs = perPictureMs.reduce((sum, [, ms]) => sum + ms, 0);
    console.log(`  processor time per picture ${cpuMs.toFixed(0)} ms: ${perPictureMs.filter(([, ms]) => ms >= 1).map(([kind, ms]) => `${kind} ${ms.toFixed(0)}`).join(", ")}`);
    for (const [name, ms] of Object.entries(passes)) console.log(`  ${name.padEnd(16)} ${ms.toFixed(1).padStart(7)} ms`);
    console.log(`  ${"(each wait".padEnd(16)} ${readBackMs.toFixed(1).padStart(7)} ms, subtracted)`);
  } finally {
    await context.close();
    rmSync(profile, { recursive: true, force: true, maxRetries: 10 });
  }
}
