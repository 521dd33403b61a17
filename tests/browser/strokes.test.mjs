// Tools in the water, in Chromium: a drag draws and everybody sees whose it is; the right button and two fingers turn the view; paddle,
// splash and rain do what they say.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { skip, WAIT_MS, waitFor } from "./chromium.mjs";
import { plugGamepad } from "./gamepad.mjs";
import { unfolded } from "./panel.mjs";
import { repository } from "./server.mjs";
import { pixelOf, twoPeople } from "./two_people.mjs";
import { acknowledged, startView, statsOf } from "./visit.mjs";

describe("fingers in the water", { skip, timeout: 16 * WAIT_MS, concurrency: 1 }, () => {
  let desk;
  let phone;
  let reset;
  let close;

  /** Presses, moves along the points and leaves the button down. */
  const drag = async (page, points, button = "left") => {
    for (const [k, [xM, zM]] of points.entries()) {
      const [xPx, yPx] = await pixelOf(page, xM, zM);
      await page.mouse.move(xPx, yPx);
      if (k === 0) await page.mouse.down({ button });
    }
  };

  before(async () => {
    ({ desk, phone, reset, close } = await twoPeople(`${repository}/tests/browser/scene.textproto`));
  });
  after(() => close?.());

  it("tells a first visitor, once, what a drag does", async () => {
    // The text stays when the line has gone, after 12 s.
    assert.match(await desk.getByTestId("hint").textContent(), /Drag to draw in the water; tap for a splash. The right button turns the view/);
    assert.match(await phone.getByTestId("hint").textContent(), /Two fingers turn the view/);
  });

  it("draws with the mouse, at once on one's own screen, and shows the other whose finger it is", async () => {
    await reset();
    const { view } = await statsOf(desk);
    const line = Array.from({ length: 20 }, (_, k) => [-1.5 + 0.15 * k, 0.5]);
    // From now on: it may have calmed down when everything else has been seen.
    const wake = waitFor(phone, "the wake in the other's water", ({ maxElevationM, minElevationM }) => maxElevationM - minElevationM > 0.02);
    await drag(desk, line);
    const own = await waitFor(desk, "the local ripple", ({ dents }) => dents > 0);
    assert.equal(own.view, view, "the camera stays");
    assert.equal(await desk.locator(".finger-tags div").count(), 1, "one's own ring");
    const ring = phone.locator(".finger-tags div");
    await ring.waitFor({ timeout: WAIT_MS });
    const [xPx, yPx] = await pixelOf(phone, ...line.at(-1));
    // It follows the finger as the server tells of it.
    const isThere = ([x, y]) => {
      const box = document.querySelector(".finger-tags div")?.getBoundingClientRect();
      return box && Math.hypot(box.x + box.width / 2 - x, box.y + box.height / 2 - y) < 40;
    };
    await phone.waitForFunction(isThere, [xPx, yPx], { timeout: WAIT_MS });
    const people = await desk.evaluate(() => [...document.querySelectorAll("#people .swatch")].map((swatch) => getComputedStyle(swatch).backgroundColor));
    assert.ok(people.includes(await ring.evaluate((element) => getComputedStyle(element).borderTopColor)), "in the colour of a person");
    await phone.waitForFunction(() => document.querySelector(".finger-tags span")?.textContent !== "", undefined, { timeout: WAIT_MS });
    await wake;
    await desk.mouse.up();
    await ring.waitFor({ state: "detached", timeout: WAIT_MS });
    await waitFor(desk, "the local ripple to go", ({ dents }) => dents === 0);
    assert.ok(await desk.getByTestId("hint").isHidden());
  });

  it("draws one's own ripple at most two pictures after the finger has moved", async () => {
    await reset();
    await desk.evaluate(() => {
      const ripple = (window.ripple = {});
      let picture = 0;
      const count = () => {
        requestAnimationFrame(count);
        ++picture;
        if (ripple.moved !== undefined && ripple.drawn === undefined && window.spindrift.stats().dents > 0) ripple.drawn = picture;
      };
      requestAnimationFrame(count);
      window.addEventListener("pointermove", ({ buttons }) => buttons === 1 && (ripple.moved ??= picture), { capture: true });
    });
    await drag(desk, [[-0.8, 0.4], [0.8, 0.4]]);
    const { moved, drawn } = await desk.waitForFunction(() => window.ripple.drawn !== undefined && window.ripple, undefined, { timeout: WAIT_MS }).then((found) => found.jsonValue());
    await desk.mouse.up();
    // One picture more than the page needs: this count may run before the page's own callback of a picture.
    assert.ok(drawn - moved <= 2, `${drawn - moved} pictures`);
    await waitFor(desk, "the local ripple to go", ({ dents }) => dents === 0);
  });

  it("turns the view with the right button, and with the left one where the water ends", async () => {
    await reset();
    await startView(desk);
    await drag(desk, [[0, 0], [1, 0.5], [2, 1]], "right");
    await desk.mouse.up({ button: "right" });
    const turned = await waitFor(desk, "the camera to leave its view", ({ view }) => view === null);
    assert.equal(turned.dents, 0);
    await startView(desk);
    await desk.mouse.move(12, 300);
    await desk.mouse.down();
    await desk.mouse.move(80, 300, { steps: 5 });
    await desk.mouse.up();
    await waitFor(desk, "the camera to leave its view", ({ view }) => view === null);
  });

  it("gives the left button back to the view if that is chosen, and keeps the choice", async () => {
    await (await unfolded(desk.getByTestId("drag"))).selectOption("turn");
    await startView(desk);
    await drag(desk, [[0, 0], [1, 0.5], [2, 1]]);
    await desk.mouse.up();
    const turned = await waitFor(desk, "the camera to leave its view", ({ view }) => view === null);
    assert.equal(turned.dents, 0);
    assert.equal(await desk.evaluate(() => localStorage.getItem("spindrift.drag")), "turn");
    await desk.getByTestId("drag").selectOption("draw");
  });

  it("says what the paddle does, outlines its wave while it is dragged, and sends it", async () => {
    await reset();
    await desk.getByTestId("tool-paddle").click();
    assert.match(await desk.getByTestId("hint").textContent(), /Drag to send a wave that way/);
    assert.equal(await desk.getByTestId("tool-paddle").getAttribute("aria-pressed"), "true");
    await drag(desk, [[-1, 0], [0, 0], [1, 0]]);
    const outline = desk.locator(".tool-preview path");
    await desk.waitForFunction(() => document.querySelector(".tool-preview path")?.getAttribute("d").split("M").length === 4, undefined, { timeout: WAIT_MS });
    const wave = waitFor(phone, "the wave in the other's water", ({ maxElevationM, minElevationM }) => maxElevationM - minElevationM > 0.03);
    const taken = await acknowledged(desk, () => desk.mouse.up(), "the wave to be taken");
    assert.equal(taken.lastCommand.case, "breakingWave");
    await wave;
    await outline.waitFor({ state: "detached", timeout: WAIT_MS });
  });

  it("makes a splash larger the longer it is held", async () => {
    const deepest = async (heldMs) => {
      await reset();
      await drag(desk, [[0, 0]]);
      await sleep(heldMs);
      await desk.mouse.up();
      return desk.evaluate(async () => {
        let lowestM = 0;
        for (const endS = window.spindrift.stats().simTime + 1.5; window.spindrift.stats().simTime < endS; await new Promise((done) => requestAnimationFrame(done)))
          lowestM = Math.min(lowestM, window.spindrift.stats().minElevationM);
        return lowestM;
      });
    };
    await desk.keyboard.press("2");
    assert.equal(await desk.getByTestId("tool-splash").getAttribute("aria-pressed"), "true");
    const tapped = await deepest(50);
    assert.ok(tapped < -0.05, `a tap pressed ${tapped} m`);
    const held = await deepest(2000);
    assert.ok(held < 1.3 * tapped, `held ${held} m, tapped ${tapped} m`);
    await desk.keyboard.press("1");
  });

  it("lets it rain for a while where one taps, in everybody's water", async () => {
    await reset();
    await phone.getByTestId("tool-rain").tap();
    const [xPx, yPx] = await pixelOf(phone, 0.5, 0);
    await phone.touchscreen.tap(xPx, yPx);
    await desk.locator(".finger-tags div").waitFor({ timeout: WAIT_MS });
    await desk.locator(".tool-preview path").waitFor({ state: "attached", timeout: WAIT_MS });
    await waitFor(desk, "drops", ({ maxElevationM, minElevationM }) => maxElevationM - minElevationM > 0.01);
    await desk.locator(".finger-tags div").waitFor({ state: "detached", timeout: WAIT_MS });
    await phone.getByTestId("tool-finger").tap();
  });

  it("works without a pointer: Enter in the middle of the picture, a gamepad where its cursor is", async () => {
    const acked = async (what, act) => {
      await reset();
      return (await acknowledged(desk, act, what)).lastCommand;
    };
    await desk.getByTestId("tool-finger").click();
    await desk.locator("#view").focus();
    const middle = await acked("the splash of a key", () => desk.keyboard.press("Enter"));
    assert.equal(middle.case, "splash");
    await desk.keyboard.press("3");
    assert.equal((await acked("the paddle of a key", () => desk.keyboard.press("Enter"))).case, "breakingWave");

    const press = await plugGamepad(desk);
    await press(4);
    await press(4);
    assert.equal(await desk.getByTestId("tool-finger").getAttribute("aria-pressed"), "true");
    // Where pictures are slow this press is a long one: a finger would draw then, and a splash is a splash however long it is held.
    await press(5);
    // The cursor moves by the pictures' time: the stick is held until it is there.
    await desk.evaluate(() =>
      new Promise((done) => {
        const fromPx = window.innerWidth / 2;
        window.addEventListener("pointermove", function moved({ clientX }) {
          if (clientX < fromPx + 80) return;
          window.removeEventListener("pointermove", moved);
          window.pad.axes[0] = 0;
          done();
        });
        window.pad.axes[0] = 0.5;
      }),
    );
    const moved = await acked("the splash of the gamepad", () => press(0));
    assert.equal(moved.case, "splash");
    assert.ok(Math.abs(moved.value.xM - middle.value.xM) > 0.1, "the cursor moved");
    await desk.evaluate(() => (navigator.getGamepads = () => []));
  });

  it("takes each finger of a touch for itself, and two that come down together for the view", async () => {
    await reset();
    const { view } = await statsOf(phone);
    const touch = await phone.context().newCDPSession(phone);
    const at = async (id, xM, zM) => {
      const [x, y] = await pixelOf(phone, xM, zM);
      return { id, x, y };
    };
    const send = (type, touchPoints) => touch.send("Input.dispatchTouchEvent", { type, touchPoints });
    await send("touchStart", [await at(1, -1, 0)]);
    for (let k = 1; k <= 5; ++k) await send("touchMove", [await at(1, -1 + 0.2 * k, 0)]);
    await sleep(300);
    await send("touchStart", [await at(1, 0, 0), await at(2, 1, 1)]);
    for (let k = 1; k <= 5; ++k) await send("touchMove", [await at(1, 0.2 * k, 0), await at(2, 1, 1 - 0.2 * k)]);
    const two = await waitFor(phone, "two local ripples", ({ dents }) => dents >= 8);
    assert.equal(two.view, view, "the camera stays");
    await desk.waitForFunction(() => document.querySelectorAll(".finger-tags div").length === 2, undefined, { timeout: WAIT_MS });
    await send("touchEnd", []);
    await waitFor(phone, "no ripple", ({ dents }) => dents === 0);

    await send("touchStart", [await at(1, -0.5, 0), await at(2, 0.5, 0)]);
    for (let k = 1; k <= 8; ++k) await send("touchMove", [await at(1, -0.5 - 0.1 * k, 0), await at(2, 0.5 + 0.1 * k, 0)]);
    await send("touchEnd", []);
    const zoomed = await waitFor(phone, "the camera to leave its view", (stats) => stats.view === null);
    assert.equal(zoomed.dents, 0);
  });
});
