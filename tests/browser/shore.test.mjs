// Wet ground in the page: sand that a wave has left is darker than dry sand. The water is advanced tick by tick, so that nothing depends on
// the speed of the machine.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";

import { launch, skip } from "./chromium.mjs";
import { DrivenPage } from "./gallery/driven_page.mjs";
import { brightnessAt } from "./pixels.mjs";
import { repository } from "./server.mjs";

const kWaitMs = 600_000;
const kStride = 12;
/** The wave of the scene has not come up the beach at this tick, and has long withdrawn at the last one. */
const kBeforeTick = 60;
const kLastTick = 1500;
const kLeastPairs = 8;
/** Height of the sand over the still water. */
const sandM = (xM) => 0.25 * (xM - 2);

/** Positions on the sand, in lines up the beach. */
const kLines = [-1, -0.5, 0, 0.5, 1].map((zM) => Array.from({ length: 24 }, (_, i) => ({ xM: 2.2 + 0.15 * i, zM, yM: sandM(2.2 + 0.15 * i) })));

/** Returns pairs of a position that water has left and a dry position of the same line. */
async function pairsOn(page) {
  const lines = await page.evaluate((wanted) => wanted.map((line) => line.map(({ xM, zM }) => window.spindrift.shoreAt(xM, zM))), kLines);
  return kLines.flatMap((line, k) => {
    const states = lines[k];
    const dry = line.filter((_, i) => states[i].wetness === 0 && states[i].foam === 0);
    // Not those under water now (wetness 1), and not those with lace.
    const wet = line.filter((_, i) => states[i].wetness > 0.6 && states[i].wetness < 0.99 && states[i].foam < 0.05);
    return wet.slice(0, dry.length).map((place, i) => ({ wet: place, dry: dry[i] }));
  });
}

describe("wet sand", { concurrency: 1, skip }, () => {
  let browser;
  before(async () => {
    browser = await launch();
  });
  after(() => browser?.close());

  for (const quality of ["minimal", "high"])
    it(`is darker than dry sand where a wave withdrew, at quality ${quality}`, { timeout: kWaitMs }, async () => {
      const size = { width: 320, height: 180 };
      const page = await DrivenPage.open(await browser.newContext(), { scene: join(repository, "tests/browser/shore.textproto"), quality, size });
      try {
        await page.look({ eyeM: [3, 4, 4], targetM: [4, 0, 0] });
        await page.followTo(kBeforeTick, kStride);
        const untouched = await page.picture();
        let pairs = [];
        for (let tick = kBeforeTick + kStride; pairs.length < kLeastPairs && tick <= kLastTick; tick += kStride) {
          await page.followTo(tick, kStride);
          pairs = await pairsOn(page);
        }
        assert.ok(pairs.length >= kLeastPairs, `${pairs.length} pairs of wet and dry sand until tick ${kLastTick}`);
        const washed = await page.picture();
        const pixels = (kind) =>
          page.evaluate((places) => {
            // A tier may draw fewer pixels than the page has.
            const { width, clientWidth } = document.getElementById("view");
            return places.map(({ xM, zM, yM }) => window.spindrift.pixelOf(xM, zM, yM).map((at) => (at * width) / clientWidth));
          }, pairs.map((pair) => pair[kind]));
        const [wet, dry] = [await pixels("wet"), await pixels("dry")];
        const ratio = async (picture) => {
          const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
          return mean(await brightnessAt(page, picture, wet)) / mean(await brightnessAt(page, picture, dry));
        };
        const [ratioBefore, ratioAfter] = [await ratio(untouched), await ratio(washed)];
        assert.ok(Math.abs(ratioBefore - 1) < 0.1, `before the wave the same places differ by a factor of ${ratioBefore.toFixed(3)}`);
        assert.ok(ratioAfter < 0.9 * ratioBefore, `wet sand has ${ratioAfter.toFixed(3)} of the brightness of dry sand, ${ratioBefore.toFixed(3)} before the wave`);
        console.log(`${quality}: ${pairs.length} pairs; ${ratioBefore.toFixed(3)} before the wave, ${ratioAfter.toFixed(3)} after it`);
        assert.deepEqual(page.complaints, []);
      } finally {
        await page.close();
      }
    });
});
