// Objects in the water, in Chromium: a drag on one holds it, and everybody sees it; what one drops, throws and takes out.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";

import { skip, WAIT_MS, waitFor } from "./chromium.mjs";
import { repository } from "./server.mjs";
import { pixelOf, twoPeople } from "./two_people.mjs";

const ofKind = ({ floaters }, kind) => floaters.find((each) => each.kind === kind);
const distanceM = (floater, xM, zM) => Math.hypot(floater.xM - xM, floater.zM - zM);

describe("objects in the water", { skip, timeout: 10 * WAIT_MS, concurrency: 1 }, () => {
  let desk;
  let phone;
  let close;

  /** Presses on an object and moves to a position; the button stays down. */
  const drag = async (page, kind, xM, zM) => {
    const floater = ofKind(await page.evaluate(() => window.spindrift.stats()), kind);
    await page.mouse.move(...(await pixelOf(page, floater.xM, floater.zM)));
    await page.mouse.down();
    await page.mouse.move(...(await pixelOf(page, xM, zM)), { steps: 10 });
  };

  before(async () => {
    ({ desk, phone, close } = await twoPeople(`${repository}/tests/browser/floaters.textproto`));
    for (const page of [desk, phone]) await waitFor(page, "both objects", ({ floaters }) => floaters.length === 2);
  });
  after(() => close?.());

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
