// Which Chromium, and its flags: software WebGL, no traffic of its own; and what tests of pages wait with.
import { existsSync } from "node:fs";

import { chromium } from "playwright-core";

import { until, WAIT_MS } from "./server.mjs";

export { until, WAIT_MS };
export const executable = process.env.CHROMIUM ?? "/usr/bin/chromium";
export const kChromiumArgs = [
  "--no-sandbox",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];
/** What a phone is for a browser. */
export const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
/** False, or why tests in Chromium cannot run here. */
export const skip = existsSync(executable) ? false : `Chromium is missing (${executable}); set CHROMIUM or install it`;
export const launch = () => chromium.launch({ executablePath: executable, args: kChromiumArgs });

/** Waits until the camera has stood still for a few pictures: a new view is flown to, in a number of pictures that the machine decides. */
export const cameraAtRest = (page) =>
  page.evaluate(async (patienceMs) => {
    const places = () => [[0, 0], [1, 2]].flatMap(([xM, zM]) => window.spindrift.pixelOf(xM, zM));
    let [before, stillCount] = [places(), 0];
    for (const endMs = performance.now() + patienceMs; stillCount < 4; ) {
      await new Promise((done) => requestAnimationFrame(done));
      const now = places();
      stillCount = now.every((px, k) => Math.abs(px - before[k]) < 0.01) ? stillCount + 1 : 0;
      before = now;
      if (performance.now() > endMs) throw new Error(`the camera still moves after ${patienceMs} ms`);
    }
  }, WAIT_MS);

/** Waits until the page's numbers are as wanted, and returns them. */
export const waitFor = (page, what, accept, patienceMs) => until(what, () => page.evaluate(() => window.spindrift?.stats()), (stats) => stats !== undefined && accept(stats), patienceMs);
