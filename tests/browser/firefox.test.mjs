// The page in Firefox: it draws water that moves, and a click makes a splash that is seen.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { PNG } from "pngjs";

import { FirefoxPage, skip } from "./firefox.mjs";
import { ended, repository, startServer } from "./server.mjs";

const WAIT_MS = 120_000;

describe("the page in Firefox", { skip, timeout: 6 * WAIT_MS, concurrency: 1 }, () => {
  let server;
  let page;

  before(async () => {
    server = await startServer(0, ["--scene", `${repository}/tests/browser/scene.textproto`]);
    page = await FirefoxPage.open({ width: 900, height: 600 });
    await page.goto(`${server.url}?quality=minimal&lang=en`);
  });
  after(() => ended(page, server));

  /** Waits until the page's numbers are as wanted, and returns them. */
  async function waitFor(what, accept) {
    let stats;
    for (const begin = Date.now(); Date.now() - begin < WAIT_MS; await sleep(100)) {
      stats = await page.evaluate("window.spindrift?.stats()");
      if (stats && accept(stats)) return stats;
    }
    assert.fail(`waited ${WAIT_MS / 1000} s for ${what}; stats: ${JSON.stringify(stats)}; errors: ${page.complaints.join("; ")}`);
  }

  /** The part of the water that no control covers. */
  async function waterNow() {
    const { data, width } = PNG.sync.read(await page.screenshot());
    const out = [];
    for (let y = 250; y < 500; ++y) for (let x = 100; x < 540; ++x) out.push(data.subarray(4 * (y * width + x), 4 * (y * width + x) + 3));
    return out;
  }
  const coloursOf = (pixels) => new Set(pixels.map(([red, green, blue]) => (red << 16) | (green << 8) | blue)).size;

  it("goes live and draws water in many colours", async () => {
    const first = await waitFor("a picture", ({ connectionState, shownTimeS }) => connectionState === "live" && shownTimeS !== null);
    await waitFor("newer water to be drawn", ({ shownTimeS }) => shownTimeS > first.shownTimeS + 1);
    const picture = await waterNow();
    assert.ok(coloursOf(picture) > 100, `${coloursOf(picture)} colours`);
  });

  it("shows the splash of a click", async () => {
    const { simTime } = await waitFor("still water", ({ maxElevationM }) => maxElevationM < 0.01);
    const still = await waterNow();
    await page.click(320, 380);
    const { lastCommand } = await waitFor("the splash", (stats) => stats.lastCommand?.case === "splash" && stats.lastAck);
    const at = await page.evaluate(`window.spindrift.pixelOf(${lastCommand.value.xM}, ${lastCommand.value.zM})`);
    assert.ok(Math.hypot(at[0] - 320, at[1] - 380) < 20, `the splash is at the pointer: ${at}`);
    await waitFor("the wave to be drawn", ({ maxElevationM, shownTimeS }) => maxElevationM > 0.02 && shownTimeS > simTime + 0.3);
    const moved = await waterNow();
    const changed = moved.filter((pixel, k) => pixel.some((value, channel) => Math.abs(value - still[k][channel]) > 12)).length;
    assert.ok(changed > 0.02 * moved.length, `${changed} of ${moved.length} pixels have changed`);
    if (process.env.SPINDRIFT_SHOTS) writeFileSync(`${process.env.SPINDRIFT_SHOTS}/firefox.png`, await page.screenshot());
    assert.deepEqual(page.complaints, []);
  });
});
