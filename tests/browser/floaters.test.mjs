// Objects in the water, in Chromium: a drag on one holds it, and everybody sees it; what one drops, throws and takes out.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { chromium } from "playwright-core";

import { executable, kChromiumArgs } from "./chromium.mjs";
import { repository, startServer } from "./server.mjs";

const WAIT_MS = 60_000;
const skip = existsSync(executable) ? false : `Chromium is missing (${executable}); set CHROMIUM or install it`;

async function waitFor(page, what, accept) {
  const deadline_ms = Date.now() + WAIT_MS;
  for (;;) {
    const stats = await page.evaluate(() => window.spindrift?.stats());
    if (stats !== undefined && accept(stats)) return stats;
    assert.ok(Date.now() < deadline_ms, `waited ${WAIT_MS / 1000} s for ${what}; floaters: ${JSON.stringify(stats?.floaters)}`);
    await sleep(50);
  }
}
const ofKind = ({ floaters }, kind) => floaters.find((each) => each.kind === kind);
const distanceM = (floater, xM, zM) => Math.hypot(floater.xM - xM, floater.zM - zM);

describe("objects in the water", { skip, timeout: 10 * WAIT_MS, concurrency: 1 }, () => {
  let server;
  let browser;
  /** Two people, each in a browser window of their own; the second has a phone. */
  let desk;
  let phone;

  const open = async (options) => {
    const page = await (await browser.newContext(options)).newPage();
    await page.goto(`${server.url}?quality=minimal`, { timeout: WAIT_MS });
    await waitFor(page, "the page to show both objects", ({ connectionState, role, floaters }) => connectionState === "live" && role !== "viewer" && floaters.length === 2);
    return page;
  };
  const pixelOf = (page, xM, zM) => page.evaluate(([x, z]) => window.spindrift.pixelOf(x, z), [xM, zM]);
  /** Presses on an object and moves to a position; the button stays down. */
  const drag = async (page, kind, xM, zM) => {
    const floater = ofKind(await page.evaluate(() => window.spindrift.stats()), kind);
    await page.mouse.move(...(await pixelOf(page, floater.xM, floater.zM)));
    await page.mouse.down();
    await page.mouse.move(...(await pixelOf(page, xM, zM)), { steps: 10 });
  };

  before(async () => {
    server = await startServer(0, ["--scene", `${repository}/tests/browser/floaters.textproto`]);
    browser = await chromium.launch({ executablePath: executable, args: kChromiumArgs });
    desk = await open({ viewport: { width: 900, height: 600 } });
    phone = await open({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  });
  after(async () => {
    await browser?.close();
    await server?.stop("SIGTERM");
  });

  it("holds an object under a drag, and lets it go with the button", async () => {
    const { view } = await waitFor(desk, "a view", ({ view }) => view !== null);
    await drag(desk, "crate", 0.5, 1.5);
    const seen = await waitFor(phone, "the held crate at its new position", (stats) => ofKind(stats, "crate")?.isHeld && distanceM(ofKind(stats, "crate"), 0.5, 1.5) < 0.6);
    assert.ok(distanceM(ofKind(seen, "ball"), 1.5, -1) < 0.6, "the other object stays");
    await desk.mouse.up();
    await waitFor(phone, "the crate to be free", (stats) => !ofKind(stats, "crate").isHeld);
    assert.equal((await waitFor(desk, "the view", () => true)).view, view, "the camera stays");
  });

  it("drops what is chosen where one taps", async () => {
    await phone.getByTestId("tool-float").tap();
    await phone.getByTestId("object-duck").tap();
    await phone.touchscreen.tap(...(await pixelOf(phone, -0.5, -1)));
    const { floaters } = await waitFor(desk, "the duck", (stats) => ofKind(stats, "duck"));
    assert.equal(floaters.length, 3);
    const calm = await waitFor(desk, "the duck to float", (stats) => Math.abs(ofKind(stats, "duck").yM) < 0.3);
    assert.ok(distanceM(ofKind(calm, "duck"), -0.5, -1) < 1, JSON.stringify(ofKind(calm, "duck")));
  });

  it("throws a stone that sinks", async () => {
    await desk.getByTestId("tool-throw").click();
    await desk.mouse.click(...(await pixelOf(desk, 0, -0.5)));
    await waitFor(phone, "the stone on the bed", (stats) => ofKind(stats, "stone")?.yM < -1.2);
  });

  it("takes an object out that is held while Delete is pressed", async () => {
    await desk.getByTestId("tool-finger").click();
    await drag(desk, "ball", 1, -1.5);
    await waitFor(desk, "the held ball", (stats) => ofKind(stats, "ball").isHeld);
    await desk.keyboard.press("Delete");
    await desk.mouse.up();
    await waitFor(phone, "the ball to be gone", (stats) => !ofKind(stats, "ball"));
  });
});
