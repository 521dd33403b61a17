// The page in Chromium with the real server: numbers, controls, acknowledgements. The tests share a page and run in order. Every wait is for
// an event, with a limit for software WebGL on two cores.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { skip, until, WAIT_MS, waitFor } from "./chromium.mjs";
import { unfolded } from "./panel.mjs";
import { measure, shootWater } from "./pixels.mjs";
import { command, repository, startServer } from "./server.mjs";
import { acknowledged, moving, newestIsDrawn, pressed, statsOf, stillWater, Visit } from "./visit.mjs";

const slow = { timeout: 4 * WAIT_MS };

/** Returns the number that an element of the panel shows. */
async function shown(page, testId) {
  const text = (await page.getByTestId(testId).textContent()) ?? "";
  const match = /-?\d[\d,. \u202f]*/.exec(text);
  assert.ok(match, `"${testId}" shows no number: "${text}"`);
  return Number(match[0].replace(/[, \u202f]/g, ""));
}

describe("the page in Chromium", { skip, concurrency: 1 }, () => {
  const visit = new Visit();
  let page;

  before(async () => {
    page = await visit.begin();
  }, slow);
  after(() => visit.end(), { timeout: WAIT_MS });

  it("shows time, speed, frames, bytes and latency of a running simulation", slow, async () => {
    const first = await statsOf(page);
    await waitFor(page, "simulated time to advance by a second", (stats) => stats.simTime > first.simTime + 1);
    await waitFor(page, "ten more surface frames", (stats) => stats.framesReceived.surface > first.framesReceived.surface + 10);
    await waitFor(page, "diagnostics", (stats) => stats.framesReceived.diagnostics > 0);
    await page.waitForFunction(() => /\d/.test(document.querySelector('[data-testid="latency"]')?.textContent ?? ""), undefined, { timeout: WAIT_MS });
    // Rates are those of the last half second, in which a busy machine may have had nothing.
    for (const testId of ["sim-time", "net-fps", "display-fps", "kbps", "rtf"])
      await page.waitForFunction((id) => parseFloat(document.querySelector(`[data-testid="${id}"]`)?.textContent ?? "") > 0, testId, { timeout: WAIT_MS });
    const latency_ms = await shown(page, "latency");
    assert.ok(latency_ms >= 0 && latency_ms < WAIT_MS, `latency ${latency_ms} ms`);
    const particle_count = await shown(page, "particles");
    assert.ok(particle_count > 500 && particle_count < 2000, `${particle_count} particles in a scene that asks for 1024`);
    assert.match(await page.getByTestId("passes").textContent(), /\d/);
    assert.equal((await statsOf(page)).malformedCount, 0);
  });

  it("splashes at a click on the water, and surface and picture change", slow, async () => {
    await stillWater(page);
    // The water stands while it is looked at: a running ring is as wide as the machine is slow.
    await pressed(page, "pause");
    await newestIsDrawn(page);
    const before_click = await shootWater(page);
    const box = await page.locator("canvas").first().boundingBox();
    // A finger's ring would hardly be seen in this quality.
    await page.getByTestId("tool-splash").click();
    await acknowledged(page, () => page.mouse.click(box.x + box.width * 0.5, box.y + box.height * 0.55));
    assert.equal((await command(visit.server, { step: { tick_count: 40 } })).status, 200);
    const clicked = await moving(page);
    assert.equal(clicked.view, "start");
    await newestIsDrawn(page);
    const picture = await measure(page, before_click, await shootWater(page));
    await pressed(page, "pause");
    await page.getByTestId("tool-finger").click();
    // A picture of this run for the report.
    await page.screenshot({ path: join(repository, "build/reports/browser-splash.png"), timeout: 2 * WAIT_MS });
    assert.ok(picture.changed_ratio > 0.02, `${(100 * picture.changed_ratio).toFixed(2)} % of the pixels changed`);
  });

  it("splashes and makes a breaking wave when the buttons are pressed", slow, async () => {
    for (const button of ["splash", "wave"]) {
      await stillWater(page);
      await pressed(page, button);
      await moving(page, `the surface to move after "${button}"`);
      assert.match(await page.getByTestId("last-ack").textContent(), /\d/);
    }
  });

  it("makes a swell from another side", slow, async () => {
    await stillWater(page);
    await (await unfolded(page.getByTestId("wave-side"))).selectOption({ label: "far side: wall" });
    await page.getByTestId("wave-shape").selectOption({ label: "swell" });
    await pressed(page, "wave");
    await moving(page);
  });

  it("hides the boat controls in a scene without boats, and switches views", slow, async () => {
    for (const id of ["boats-box", "view-boat"]) assert.ok(await page.locator(`#${id}`).isHidden(), `#${id} shows in a scene without boats`);
    for (const view of ["view-overview", "view-side", "view-start"]) {
      await page.getByTestId(view).click();
      assert.equal(await page.getByTestId(view).getAttribute("aria-pressed"), "true");
    }
  });

  it("pauses and resumes the room for every page, and moves the other page's slider", slow, async () => {
    const other = await visit.open();
    await pressed(page, "pause");
    await waitFor(other, "the other page to hear of the pause", (stats) => stats.paused === true);
    assert.ok(await page.getByTestId("step").isEnabled(), "a paused room cannot be stepped");
    await pressed(page, "pause");
    const resumed = await waitFor(other, "the other page to hear of the end of the pause", (stats) => stats.paused === false);
    assert.ok(await other.getByTestId("step").isDisabled(), "a running room can be stepped");
    await waitFor(other, "time to continue", (stats) => stats.simTime > resumed.simTime);

    for (const target of [page, other]) await unfolded(target.locator("#parameters"));
    const slider = (target) => target.getByRole("slider", { name: /viscosity/i });
    assert.equal(await slider(other).inputValue(), await slider(page).inputValue());
    await acknowledged(page, () => slider(page).fill("55"));
    await until("the other page's slider to move", () => slider(other).inputValue(), (value) => value === "55");
    await other.close();
  });

  it("shows a coarser level when chosen, and the full level again", slow, async () => {
    await (await unfolded(page.getByTestId("detail"))).selectOption("coarse");
    const coarse = await waitFor(page, "a coarse surface", (stats) => stats.surfaceResolutionCount === 128);
    // A busy machine may have had the coarse level before, for its slow link.
    await waitFor(page, "the coarse water to move on", (stats) => stats.level === "coarse" && stats.levelLimitedBy === "choice" && stats.simTime > coarse.simTime);
    await page.waitForFunction(() => !document.querySelector('[data-testid="level"]')?.textContent?.includes("("), undefined, { timeout: WAIT_MS });
    assert.equal((await page.getByTestId("level").textContent()).trim(), "coarse");
    await page.getByTestId("detail").selectOption("auto");
    const full = await waitFor(page, "a full surface", (stats) => stats.surfaceResolutionCount === 144);
    assert.equal(full.malformedCount, 0);
    assert.ok(full.delayMs > 0 && full.delayMs < 10_000, `the picture is ${full.delayMs} ms behind`);
  });

  it("continues with the water at another fidelity, with its view and sliders", slow, async () => {
    const before = await statsOf(page);
    const viscosity = page.getByRole("slider", { name: /viscosity/i });
    const chosenViscosity = await viscosity.inputValue();
    const fidelity = page.getByTestId("fidelity");
    assert.equal(await fidelity.inputValue(), "balanced");
    assert.match(await page.getByTestId("fidelity-cost").textContent(), /^At balanced, a simulated second takes this server [\d.]+ m?s/);
    await acknowledged(page, () => fidelity.selectOption("draft"));
    const draft = await waitFor(page, "the surface of the draft level", (stats) => stats.surfaceResolutionCount === 80);
    assert.ok(draft.simTime >= before.simTime, `time went from ${before.simTime} s to ${draft.simTime} s`);
    assert.equal(draft.view, before.view);
    assert.equal(await fidelity.inputValue(), "draft");
    assert.match(await page.getByTestId("fidelity-cost").textContent(), /^At draft, a simulated second takes this server [\d.]+ m?s/);
    assert.equal(await viscosity.inputValue(), chosenViscosity);
    await waitFor(page, "the draft water to move on", (stats) => stats.simTime > draft.simTime);
    // Scenes change at most once per second.
    await sleep(1000);
    await acknowledged(page, () => fidelity.selectOption("balanced"));
    const after = await waitFor(page, "the surface of the scene's own level", (stats) => stats.surfaceResolutionCount === 144);
    assert.equal(after.malformedCount, 0);
  });

  it("owns a boat that others cannot take, and keeps it after a reload", slow, async () => {
    const ada = await visit.open("marina");
    const bob = await visit.open("marina");
    const people = (target) => target.getByTestId("people").locator("li");
    await ada.locator("#people-box > summary").click();
    await ada.getByTestId("my-name").fill("Ada");
    await ada.getByTestId("introduce").click();
    // The page connects again under the name; until then it is live under the old connection.
    await people(ada).filter({ hasText: "Ada" }).waitFor({ timeout: WAIT_MS });
    await waitFor(ada, "the page to be live under its name", (stats) => stats.connectionState === "live" && stats.role === "operator");
    await ada.getByTestId("spawn").click();
    const { myBoat } = await waitFor(ada, "a boat of Ada's", (stats) => stats.myBoat > 0);
    await bob.locator("#people-box > summary").click();
    await people(bob).filter({ hasText: /Ada.*boat/ }).waitFor({ timeout: WAIT_MS });
    assert.equal(await people(bob).count(), 2);
    assert.equal(await bob.getByTestId("my-boat").locator(`option[value="${myBoat}"]`).count(), 0, "Bob may choose Ada's boat");

    await ada.reload({ timeout: WAIT_MS });
    await waitFor(ada, "Ada's boat after the reload", (stats) => stats.myBoat === myBoat);
    assert.equal(await ada.getByTestId("my-name").inputValue(), "Ada");
    await ada.close();
    await people(bob).filter({ hasText: /Ada.*away/ }).waitFor({ timeout: WAIT_MS });
    await bob.close();
  });

  it("reconnects after the server was killed and restarted", slow, async () => {
    visit.isServerDown = true;
    await visit.server.stop("SIGKILL");
    await waitFor(page, "the page to notice", (stats) => stats.connectionState.startsWith("retrying"));
    const last = await statsOf(page);
    visit.server = await startServer(visit.server.port);
    await waitFor(page, "the page to be live again", (stats) => stats.connectionState === "live");
    await waitFor(page, "new frames", (stats) => stats.framesReceived.surface > last.framesReceived.surface);
    visit.isServerDown = false;
    await pressed(page, "splash");
  });

  it("gets close code 1001 when the server is terminated, and the server exits with 0", slow, async () => {
    // The page's own socket lives in a worker; a second one in the page sees the close code directly.
    await page.evaluate(
      () =>
        new Promise((resolve, reject) => {
          const socket = new WebSocket(`ws://${location.host}/ws`, "spindrift.v1");
          window.__close_code = new Promise((closed) => socket.addEventListener("close", (event) => closed(event.code)));
          socket.addEventListener("open", () => resolve());
          socket.addEventListener("error", () => reject(new Error("the second socket was refused")));
        }),
    );
    visit.isServerDown = true;
    const end = await visit.server.stop("SIGTERM");
    assert.deepEqual(end, { code: 0, signal: null });
    assert.equal(await page.evaluate(() => window.__close_code), 1001);
  });

  it("raised no error and violated no content policy", () => {
    assert.deepEqual(visit.complaints, []);
  });
});
