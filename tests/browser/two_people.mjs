// Two people, each in a browser window of their own; the second has a phone.
import assert from "node:assert/strict";

import { kPhone, launch, WAIT_MS, waitFor } from "./chromium.mjs";
import { command, startServer } from "./server.mjs";

/** Waits for the panels, which the page paints after its first picture. */
export const panelsShown = (page) => page.waitForFunction(() => !document.body.classList.contains("starting"), undefined, { timeout: WAIT_MS });

/** Where a position on the water is in the window. */
export const pixelOf = (page, xM, zM) => page.evaluate(([x, z]) => window.spindrift.pixelOf(x, z), [xM, zM]);

/** Starts a server with a scene file, and opens both pages, where `first` runs before everything else. Call close() in the end. */
export async function twoPeople(scene, first = () => {}) {
  const server = await startServer(0, ["--scene", scene]);
  let browser;
  const close = async () => {
    await browser?.close();
    await server.stop("SIGTERM");
  };
  const open = async (options) => {
    const page = await (await browser.newContext(options)).newPage();
    page.setDefaultTimeout(WAIT_MS);
    await page.addInitScript(first);
    await page.goto(`${server.url}?quality=minimal`, { timeout: WAIT_MS });
    await waitFor(page, "the page to be live", ({ connectionState, framesReceived, role }) => connectionState === "live" && framesReceived.surface > 3 && role !== "viewer");
    await panelsShown(page);
    return page;
  };
  try {
    browser = await launch();
    const desk = await open({ viewport: { width: 900, height: 600 } });
    const phone = await open(kPhone);
    /** Begins the scene again, and waits until both pages show the still water. */
    const reset = async () => {
      assert.equal((await command(server, { reset: {} })).status, 200);
      for (const page of [desk, phone]) await waitFor(page, "still water", ({ maxElevationM, minElevationM }) => maxElevationM - minElevationM < 0.02);
    };
    return { desk, phone, reset, close };
  } catch (error) {
    await close();
    throw error;
  }
}
