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
/** False, or why tests in Chromium cannot run here. */
export const skip = existsSync(executable) ? false : `Chromium is missing (${executable}); set CHROMIUM or install it`;
export const launch = () => chromium.launch({ executablePath: executable, args: kChromiumArgs });

/** Waits until the page's numbers are as wanted, and returns them. */
export const waitFor = (page, what, accept, patienceMs) => until(what, () => page.evaluate(() => window.spindrift?.stats()), (stats) => stats !== undefined && accept(stats), patienceMs);
