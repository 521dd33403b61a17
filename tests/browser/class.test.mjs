// A class in Chromium: a projector, and a pad that is used by touch alone.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";

import jsQR from "jsqr";
import { kPhone, launch, skip, WAIT_MS, waitFor } from "./chromium.mjs";
import { plugGamepad } from "./gamepad.mjs";
import { ended, startClass } from "./server.mjs";

describe("a class", { skip, timeout: 10 * WAIT_MS, concurrency: 1 }, () => {
  let server;
  let browser;
  let projector;
  let pad;

  const open = async (options, path) => {
    const page = await (await browser.newContext(options)).newPage();
    page.setDefaultTimeout(WAIT_MS);
    page.on("pageerror", (error) => assert.fail(error));
    await page.goto(new URL(path, `http://127.0.0.1:${server.port}/`).href, { timeout: WAIT_MS });
    await waitFor(page, "the page to be live", ({ connectionState, role }) => connectionState === "live" && role !== "viewer");
    return page;
  };
  /** Presses a button of the operator, wherever its panel is. */
  const press = (testId) => projector.getByTestId(testId).dispatchEvent("click");

  before(async () => {
    let token;
    ({ server, token } = await startClass());
    browser = await launch();
    projector = await open({ viewport: { width: 1280, height: 720 } }, `?class&quality=minimal#token=${token}`);
  });
  after(() => ended(browser, server));

  it("shows a QR code of the address that the server names", async () => {
    const canvas = projector.getByTestId("join-qr");
    await canvas.waitFor({ timeout: WAIT_MS });
    const { data, width, height } = await canvas.evaluate((qr) => {
      const large = Object.assign(document.createElement("canvas"), { width: 8 * qr.width, height: 8 * qr.height });
      const context = large.getContext("2d");
      context.imageSmoothingEnabled = false;
      context.drawImage(qr, 0, 0, large.width, large.height);
      return { data: [...context.getImageData(0, 0, large.width, large.height).data], width: large.width, height: large.height };
    });
    const { urls } = await (await fetch(`http://127.0.0.1:${server.port}/api/v1/join`)).json();
    assert.equal(jsQR(Uint8ClampedArray.from(data), width, height)?.data, urls[0]);
    assert.ok(await projector.getByTestId("join-card").evaluate((card) => card.classList.contains("large")), "nobody plays yet");
  });

  it("launches a boat from a pad, which the projector shows", async () => {
    pad = await open(kPhone, "pad");
    await pad.getByTestId("pad-tool-boat").tap();
    await pad.getByTestId("pad-launch").tap();
    const { myBoat } = await waitFor(pad, "its boat", ({ myBoat }) => myBoat > 0);
    await waitFor(projector, "the boat", ({ boats }) => boats.some(({ boatId }) => boatId === myBoat));
    assert.ok(!(await projector.getByTestId("join-card").evaluate((card) => card.classList.contains("large"))), "the code is in a corner");
  });

  it("is used by a gamepad: B launches a boat, the stick steers it, LB and A throw a stone", async () => {
    const { myBoat: before } = await pad.evaluate(() => window.spindrift.stats());
    await pad.getByTestId("pad-remove").tap();
    await waitFor(pad, "no boat", ({ myBoat }) => myBoat === 0);
    const press = await plugGamepad(pad);
    await press(1);
    const { myBoat } = await waitFor(pad, "a boat", (stats) => stats.myBoat > 0);
    assert.notEqual(myBoat, before);
    await pad.evaluate(() => (window.pad.axes[1] = -1));
    await waitFor(projector, "the boat under way", ({ boats }) => boats.some(({ boatId, throttle }) => boatId === myBoat && throttle > 0.9));
    await pad.evaluate(() => (window.pad.axes[1] = 0));
    await press(4);
    await waitFor(pad, "the tool before", ({ mode }) => mode === "throw");
    await press(0);
    await waitFor(pad, "the stone", ({ water }) => water.floaters > 0);
    await pad.evaluate(() => (navigator.getGamepads = () => []));
    await pad.getByTestId("pad-tool-boat").tap();
  });

  it("has only targets that a thumb hits", async () => {
    const sizes = await pad.evaluate(() => [...document.querySelectorAll("button")].filter((each) => each.checkVisibility()).map((each) => [each.textContent, each.getBoundingClientRect().width, each.getBoundingClientRect().height]));
    assert.deepEqual(sizes.filter(([, width, height]) => width < 44 || height < 44), []);
  });

  it("pauses the pads, takes a tool away, and gives both back", async () => {
    await press("lesson-freeze");
    await waitFor(pad, "the pause", ({ whyNot }) => /paused/.test(whyNot ?? ""));
    await press("lesson-freeze");
    await waitFor(pad, "the end of the pause", ({ whyNot }) => whyNot === null);
    await press("lesson-tool-rain");
    await pad.getByTestId("pad-tool-rain").waitFor({ state: "hidden", timeout: WAIT_MS });
    await press("lesson-tool-rain");
    await pad.getByTestId("pad-tool-rain").waitFor({ state: "visible", timeout: WAIT_MS });
  });

  it("starts a race with the pad's boat in it", async () => {
    await press("game-race");
    await projector.getByTestId("board-race").waitFor({ timeout: WAIT_MS });
    await pad.getByTestId("pad-headline").filter({ hasText: "Steer to buoy 1" }).waitFor({ timeout: WAIT_MS });
    await press("game-end");
    await pad.getByTestId("pad-headline").waitFor({ state: "hidden", timeout: WAIT_MS });
  });
});
