// The page in Chromium with the real server, in one long file because its tests share a browser and a server and run in order:
// picture, controls, acknowledgements. Every wait is for an event, with a limit for software WebGL on two cores.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { chromium } from "playwright-core";

import { cameraAtRest, executable, kChromiumArgs, skip, WAIT_MS, waitFor } from "./chromium.mjs";
import { focusLight } from "./caustics.mjs";
import { unfolded } from "./panel.mjs";
import { brightnessAt, colourAt, measure, measureBody, shootWater } from "./pixels.mjs";
import { repository, startServer } from "./server.mjs";

const slow = { skip, timeout: 4 * WAIT_MS };

let server;
let profile;
let context;
let page;
/** Errors that the browser reported. */
const complaints = [];
/** While the server is down on purpose, a refused connection is not an error. */
let is_server_down = false;

/** Waits until frames of `layer` arrive. */
async function openPage(room = "main", layer = "surface") {
  const opened = await context.newPage();
  opened.setDefaultTimeout(WAIT_MS);
  opened.on("pageerror", (error) => complaints.push(`uncaught: ${error.stack ?? error.message}`));
  opened.on("console", (message) => {
    // The browser reports a draw call that it refuses as a warning.
    if (message.type() !== "error" && !/GL_INVALID/.test(message.text())) return;
    if (is_server_down && /WebSocket connection|ERR_CONNECTION/.test(message.text())) return;
    complaints.push(`console: ${message.text()} (${message.location().url})`);
  });
  await opened.goto(`${server.url}?quality=minimal&room=${room}`, { timeout: WAIT_MS });
  await waitFor(opened, "the page to be live", (stats) => stats.connectionState === "live" && stats.framesReceived[layer] > 0);
  return opened;
}

const statsOf = (target) => target.evaluate(() => window.spindrift?.stats());

/** Returns the number that an element of the panel shows. */
async function shown(target, test_id) {
  const text = (await target.getByTestId(test_id).textContent()) ?? "";
  const match = /-?\d[\d,. \u202f]*/.exec(text);
  assert.ok(match, `"${test_id}" shows no number: "${text}"`);
  return Number(match[0].replace(/[, \u202f]/g, ""));
}

/** Calls `press` and waits for the acknowledgement of a newer command. */
async function acknowledged(target, press) {
  const last = (await statsOf(target)).lastAck?.commandId ?? 0;
  await press();
  await waitFor(target, "an acknowledgement", (stats) => (stats.lastAck?.commandId ?? 0) > last);
}

/** Resets the room, so that every test starts with still water. */
async function stillWater(target) {
  await acknowledged(target, () => target.getByTestId("reset").click());
  await waitFor(target, "still water", (stats) => stats.maxElevationM - stats.minElevationM < 0.02);
}

/** Simulates so many ticks of the paused room. */
async function stepped(tick_count) {
  const answer = await fetch(`${server.url}api/v1/rooms/main/commands`, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ step: { tick_count } }),
  });
  assert.equal(answer.status, 200, await answer.text());
}

/** Waits until pictures were drawn for this long, and three more. */
function drawnPictures(target, during_ms) {
  return target.evaluate(async (wanted_ms) => {
    const picture = () => new Promise((drawn) => requestAnimationFrame(drawn));
    for (const start = performance.now(); performance.now() < start + wanted_ms; ) await picture();
    for (let i = 0; i < 3; ++i) await picture();
  }, during_ms);
}

/** Waits until the newest surface frame is drawn: pictures follow the frames after a delay that grows on a busy machine. */
async function newestIsDrawn(target) {
  // After a reset the picture before it has the larger time: one picture more takes the new one.
  await drawnPictures(target, 0);
  const { surfaceTimeS } = await statsOf(target);
  await waitFor(target, `the surface of ${surfaceTimeS} s to be drawn`, (stats) => stats.shownTimeS >= surfaceTimeS);
  await drawnPictures(target, 0);
}

/** A test that uses the page opened by the first test. */
function step(name, body) {
  it(name, slow, async () => {
    assert.ok(page, "the page never came up");
    await body();
  });
}

describe("the page in Chromium", { concurrency: 1 }, () => {
  it("connects to a new server and goes live", slow, async () => {
    server = await startServer();
    profile = mkdtempSync(join(tmpdir(), "spindrift-chromium-"));
    context = await chromium.launchPersistentContext(profile, {
      executablePath: executable,
      headless: true,
      viewport: { width: 900, height: 600 },
      args: kChromiumArgs,
    });
    // Not the first visit: the line about drawing would be in the pictures.
    await context.addInitScript(() => localStorage.setItem("spindrift.has-drawn", "1"));
    page = await openPage();
  });

  after(
    async () => {
      await context?.close();
      await server?.stop("SIGKILL");
      if (profile) rmSync(profile, { recursive: true, force: true, maxRetries: 10 });
    },
    { timeout: WAIT_MS },
  );

  step("shows time, speed, frames, bytes and latency of a running simulation", async () => {
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

  step("draws water in many colours", async () => {
    const picture = await measure(page, await shootWater(page));
    assert.ok(picture.colour_count >= 12, `only ${picture.colour_count} colours`);
    assert.ok(picture.deviation > 3, `brightness varies by ${picture.deviation.toFixed(2)} of 255 only`);
  });

  step("splashes at a click on the water, and surface and picture change", async () => {
    await stillWater(page);
    // The water stands while it is looked at: a running ring is as wide as the machine is slow.
    await acknowledged(page, () => page.getByTestId("pause").click());
    await newestIsDrawn(page);
    const before_click = await shootWater(page);
    const box = await page.locator("canvas").first().boundingBox();
    // A finger's ring would hardly be seen in this quality.
    await page.getByTestId("tool-splash").click();
    await acknowledged(page, () => page.mouse.click(box.x + box.width * 0.5, box.y + box.height * 0.55));
    await stepped(40);
    const clicked = await waitFor(page, "the surface to move", (stats) => stats.maxElevationM - stats.minElevationM > 0.1);
    assert.equal(clicked.view, "start");
    await newestIsDrawn(page);
    const picture = await measure(page, before_click, await shootWater(page));
    await acknowledged(page, () => page.getByTestId("pause").click());
    await page.getByTestId("tool-finger").click();
    // A picture of this run for the report.
    await page.screenshot({ path: join(repository, "build/reports/browser-splash.png"), timeout: 2 * WAIT_MS });
    assert.ok(picture.changed_ratio > 0.02, `${(100 * picture.changed_ratio).toFixed(2)} % of the pixels changed`);
  });

  step("splashes and makes a breaking wave when the buttons are pressed", async () => {
    for (const button of ["splash", "wave"]) {
      await stillWater(page);
      await acknowledged(page, () => page.getByTestId(button).click());
      await waitFor(page, `the surface to move after "${button}"`, (stats) => stats.maxElevationM - stats.minElevationM > 0.1);
      assert.match(await page.getByTestId("last-ack").textContent(), /\d/);
    }
  });

  step("makes a swell from another side", async () => {
    await stillWater(page);
    await (await unfolded(page.getByTestId("wave-side"))).selectOption({ label: "far side: wall" });
    await page.getByTestId("wave-shape").selectOption({ label: "swell" });
    await acknowledged(page, () => page.getByTestId("wave").click());
    await waitFor(page, "the surface to move", (stats) => stats.maxElevationM - stats.minElevationM > 0.1);
  });

  step("hides the boat controls in a scene without boats, and switches views", async () => {
    for (const id of ["boats-box", "view-boat"]) assert.ok(await page.locator(`#${id}`).isHidden(), `#${id} shows in a scene without boats`);
    for (const view of ["view-overview", "view-side", "view-start"]) {
      await page.getByTestId(view).click();
      assert.equal(await page.getByTestId(view).getAttribute("aria-pressed"), "true");
    }
  });

  step("sees the sky through Snell's window in still water, and the floor's reflection outside it", async () => {
    await stillWater(page);
    // Without a move of the camera.
    await page.emulateMedia({ reducedMotion: "reduce" });
    await page.getByTestId("view-below").click();
    await waitFor(page, "the view from below", (stats) => stats.view === "below");
    // The eye is below the middle, in 0.62 of the depth; light from the air arrives within 48.6 degrees of the vertical.
    const radius_m = 0.62 * 1.5 * Math.tan(Math.asin(0.75));
    const ahead = [-0.43, -0.9];
    const places = () =>
      page.evaluate(([radius, [x, z]]) => [0.9, 1.2].map((share) => window.spindrift.pixelOf(share * radius * x, share * radius * z)), [radius_m, ahead]);
    // The first picture from there.
    await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
    const deadline_ms = Date.now() + WAIT_MS;
    let pixels = await places();
    while (!pixels.every(([x, y]) => x > 0 && x < 900 && y > 0 && y < 600)) {
      assert.ok(Date.now() < deadline_ms, `${JSON.stringify(pixels)} are not in the picture`);
      await sleep(100);
      pixels = await places();
    }
    const [sky, floor] = await brightnessAt(page, await page.screenshot({ timeout: 120_000 }), pixels);
    assert.ok(sky > 1.2 * floor, `brightness ${sky.toFixed(0)} in the window, ${floor.toFixed(0)} outside it`);
    await page.getByTestId("view-start").click();
    await page.emulateMedia({ reducedMotion: null });
    assert.equal((await statsOf(page)).view, "start");
  });

  step("pauses and resumes the room for every page, and moves the other page's slider", async () => {
    const other = await openPage();
    await acknowledged(page, () => page.getByTestId("pause").click());
    await waitFor(other, "the other page to hear of the pause", (stats) => stats.paused === true);
    assert.ok(await page.getByTestId("step").isEnabled(), "a paused room cannot be stepped");
    await acknowledged(page, () => page.getByTestId("pause").click());
    const resumed = await waitFor(other, "the other page to hear of the end of the pause", (stats) => stats.paused === false);
    assert.ok(await other.getByTestId("step").isDisabled(), "a running room can be stepped");
    await waitFor(other, "time to continue", (stats) => stats.simTime > resumed.simTime);

    for (const target of [page, other]) await unfolded(target.locator("#parameters"));
    const slider = (target) => target.getByRole("slider", { name: /viscosity/i });
    assert.equal(await slider(other).inputValue(), await slider(page).inputValue());
    await acknowledged(page, () => slider(page).fill("55"));
    const deadline_ms = Date.now() + WAIT_MS;
    while ((await slider(other).inputValue()) !== "55") {
      assert.ok(Date.now() < deadline_ms, `the other page's slider stands at ${await slider(other).inputValue()}`);
      await sleep(100);
    }
    await other.close();
  });

  step("shows a coarser level when chosen, and the full level again", async () => {
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

  step("shows data in colours: the probe reads the value whose colour the water has there", async () => {
    await stillWater(page);
    await newestIsDrawn(page);
    const natural = await shootWater(page);
    const look = page.getByTestId("look");
    assert.deepEqual(await look.locator("option").evaluateAll((options) => options.map(({ value }) => value)), ["natural", "height", "velocity", "speed", "density", "thesis"]);
    assert.ok(await page.getByTestId("look-key").isHidden(), "natural water has a colour bar");
    await look.selectOption("height");
    assert.match(await page.getByTestId("key-title").textContent(), /height \[m\]/);
    await page.waitForURL(/look=height/, { timeout: WAIT_MS });
    await acknowledged(page, () => page.getByTestId("splash").click());
    await waitFor(page, "the surface to move", (stats) => stats.maxElevationM - stats.minElevationM > 0.2);
    await acknowledged(page, () => page.getByTestId("pause").click());
    await waitFor(page, "the room to pause", (stats) => stats.paused);
    await drawnPictures(page, 1500);
    await newestIsDrawn(page);
    const picture = await measure(page, natural, await shootWater(page));
    assert.ok(picture.changed_ratio > 0.5, `${(100 * picture.changed_ratio).toFixed(0)} % of the pixels changed`);

    const { minElevationM, maxElevationM } = await statsOf(page);
    const differences = [];
    const values = [];
    for (const [xM, zM] of [[0, 0], [1, 1], [-1.5, 0.5], [0.5, 2], [2, -1], [-2, 2.5], [0, 1.5]]) {
      const [xPx, yPx] = await page.evaluate(([x, z]) => window.spindrift.pixelOf(x, z), [xM, zM]);
      await page.mouse.move(xPx, yPx);
      await drawnPictures(page, 300);
      const label = await page.getByTestId("probe").textContent();
      const [, value, atXM, atZM] = /^(-?[\d.]+) mx (-?[\d.]+) m, z (-?[\d.]+) m$/.exec(label)?.map(Number) ?? [];
      assert.ok(value >= minElevationM - 0.02 && value <= maxElevationM + 0.02, `the probe says "${label}"; elevations are ${minElevationM} to ${maxElevationM} m`);
      // The point of the still water under the pixel, not where the ray meets a wave.
      assert.ok(Math.hypot(atXM - xM, atZM - zM) < 1.5, `the probe at ${xM}, ${zM} m says "${label}"`);
      values.push(value);
      const seen = await colourAt(page, await page.screenshot({ timeout: 2 * WAIT_MS }), xPx, yPx);
      const wanted = await page.evaluate((shown) => {
        const bar = document.querySelector("#look-key canvas");
        const ticks = [...document.querySelectorAll("#look-key li")].map((tick) => [Number(tick.textContent), parseFloat(tick.style.getPropertyValue("--at")) / 100]);
        const [[firstValue, firstAt], [lastValue, lastAt]] = [ticks[0], ticks.at(-1)];
        const share = firstAt + ((shown - firstValue) / (lastValue - firstValue)) * (lastAt - firstAt);
        return [...bar.getContext("2d").getImageData(Math.round(255 * Math.min(Math.max(share, 0), 1)), 0, 1, 1).data].slice(0, 3);
      }, value);
      differences.push(Math.max(...wanted.map((channel, i) => Math.abs(channel - seen[i]))));
    }
    assert.ok(Math.max(...values) - Math.min(...values) > 0.02, `the probe reads ${values} m at places of a splash`);
    differences.sort((a, b) => a - b);
    // Where the surface is steep, the drawn mesh is coarser than what the probe reads.
    assert.ok(differences[3] <= 12, `colours of water and bar differ by ${differences} of 255`);
    await acknowledged(page, () => page.getByTestId("pause").click());
  });

  step("keeps the look at another level and after a lost graphics context, and goes back to natural water", async () => {
    await page.getByTestId("detail").selectOption("coarse");
    await waitFor(page, "a coarse surface", (stats) => stats.surfaceResolutionCount === 128);
    const loss = await page.evaluateHandle(() => document.querySelector("canvas").getContext("webgl2").getExtension("WEBGL_lose_context"));
    await loss.evaluate((extension) => extension.loseContext());
    await page.locator("#notice").waitFor({ state: "visible", timeout: WAIT_MS });
    await loss.evaluate((extension) => extension.restoreContext());
    await page.locator("#notice").waitFor({ state: "hidden", timeout: WAIT_MS });
    assert.equal(await page.getByTestId("look").inputValue(), "height");
    await drawnPictures(page, 1000);
    const height = await shootWater(page);
    const picture = await measure(page, height);
    assert.ok(picture.colour_count >= 2, "the picture is one colour");
    await page.getByTestId("look").selectOption("speed");
    assert.match(await page.getByTestId("key-title").textContent(), /speed \[m\/s\]/);
    await page.getByTestId("look").selectOption("natural");
    assert.ok(await page.getByTestId("look-key").isHidden(), "natural water has a colour bar");
    await page.waitForURL((url) => !url.searchParams.has("look"), { timeout: WAIT_MS });
    await drawnPictures(page, 500);
    assert.ok(await page.getByTestId("probe").isHidden(), "natural water has a probe");
    assert.ok((await measure(page, height, await shootWater(page))).changed_ratio > 0.5, "the water still shows its height");
    await page.getByTestId("detail").selectOption("auto");
    await waitFor(page, "a full surface", (stats) => stats.surfaceResolutionCount === 144);
  });

  step("continues with the water at another fidelity, with its view and sliders", async () => {
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

  step("draws the same water in another quality, with its view, and keeps the choice in the address", async () => {
    const quality = page.getByTestId("quality");
    assert.equal(await quality.inputValue(), "minimal");
    const before = await statsOf(page);
    for (const tier of ["low", "high", "minimal"]) {
      await quality.selectOption(tier);
      const stats = await waitFor(page, `the tier ${tier}`, (now) => now.quality === tier);
      assert.equal(stats.pixelRatio, tier === "minimal" ? 0.65 : 1);
      await page.waitForURL((url) => url.searchParams.get("quality") === tier, { timeout: WAIT_MS });
      await drawnPictures(page, 0);
      // A picture of the tier "high" takes a second here.
      assert.ok(stats.maxElevationM !== null, "no water is shown");
      const picture = await measure(page, await shootWater(page));
      assert.ok(picture.colour_count >= 12, `${tier}: only ${picture.colour_count} colours`);
    }
    const after = await statsOf(page);
    assert.equal(after.view, before.view);
    assert.equal(after.malformedCount, 0);
  });

  step("draws the open sea without an edge at the sides of the simulated square", async () => {
    const sea = await openPage("sea");
    await waitFor(sea, "the waves to travel in", (stats) => stats.simTime > 8);
    // From farther above, so that the sides are in the picture.
    await sea.getByTestId("view-overview").click();
    await cameraAtRest(sea);
    await sea.mouse.move(300, 400);
    for (let turn = 0; turn < 4; ++turn) await sea.mouse.wheel(0, 300);
    await cameraAtRest(sea);
    const kHalfM = 12;
    const kApartM = 0.6;
    // Pairs of points on both sides of lines parallel to the far and to the left side, at several distances from the middle.
    const lines = [];
    for (const axis of ["x", "z"])
      for (const atM of [-7, -9, -kHalfM, -14, -16]) {
        const pairs = [];
        for (let alongM = -4; alongM <= 4; alongM += 0.25)
          pairs.push([atM - kApartM / 2, atM + kApartM / 2].map((acrossM) => (axis === "x" ? [acrossM, alongM] : [alongM, acrossM])));
        lines.push({ axis, atM, pairs });
      }
    // The mean over pictures leaves out the waves themselves.
    const sums = lines.map(() => 0);
    const kPictureCount = 4;
    for (let picture = 0; picture < kPictureCount; ++picture) {
      const points = await sea.evaluate((all) => all.map(([x, z]) => window.spindrift.pixelOf(x, z)), lines.flatMap(({ pairs }) => pairs.flat()));
      const isWater = await sea.evaluate((all) => all.map(([x, y]) => document.elementFromPoint(x, y)?.tagName === "CANVAS"), points);
      assert.ok(isWater.every(Boolean), "the sides are outside the picture or behind a panel");
      const png = await sea.screenshot({ timeout: 2 * WAIT_MS });
      const seen = await brightnessAt(sea, png, points);
      let at = 0;
      lines.forEach(({ pairs }, n) => {
        for (let pair = 0; pair < pairs.length; ++pair, at += 2) sums[n] += (seen[at + 1] - seen[at]) / pairs.length / kPictureCount;
      });
      await sleep(500);
    }
    for (const axis of ["x", "z"]) {
      const of = (isEdge) => lines.flatMap((line, n) => (line.axis === axis && (line.atM === -kHalfM) === isEdge ? [Math.abs(sums[n])] : []));
      const [edge] = of(true);
      const elsewhere = Math.max(...of(false));
      assert.ok(edge <= elsewhere + 2, `brightness steps by ${edge.toFixed(1)} of 255 at the side -${axis}, by at most ${elsewhere.toFixed(1)} elsewhere`);
    }
    await sea.close();
  });

  step("draws a box full of particles as one body: no gaps, no beads", async () => {
    const tank = await openPage("tank", "particles");
    await waitFor(tank, "the particles to rest", (stats) => stats.simTime > 1);
    await acknowledged(tank, () => tank.getByTestId("pause").click());
    for (const view of ["view-overview", "view-start"]) {
      await tank.getByTestId(view).click();
      await waitFor(tank, `the camera to arrive at ${view}`, (stats) => `view-${stats.view}` === view);
      // The camera moves for a second of drawn time, however long a picture takes.
      await tank.evaluate(async () => {
        const picture = () => new Promise((drawn) => requestAnimationFrame(drawn));
        for (const start = performance.now(); performance.now() < start + 1500; ) await picture();
        for (let i = 0; i < 3; ++i) await picture();
      });
      // Behind the middle, where no pane's edge is before the surface; further back a low view shows the wall in it.
      const corners = await tank.evaluate(() => [-0.5, 0.5].flatMap((xM) => [-0.2, 0.1].map((zM) => window.spindrift.pixelOf(xM, zM))));
      const [xs, ys] = [0, 1].map((axis) => corners.map((corner) => corner[axis]));
      const [left, top] = [Math.min(...xs), Math.min(...ys)];
      const clip = { x: left, y: top, width: Math.max(...xs) - left, height: Math.max(...ys) - top };
      const body = await measureBody(tank, await tank.screenshot({ clip, timeout: 2 * WAIT_MS }));
      const said = `${view}: ${JSON.stringify(body)}`;
      assert.ok(body.water_ratio > 0.9, `water covers too little; ${said}`);
      assert.ok(body.filled_ratio > 0.95, `the water has gaps; ${said}`);
      // Shaded spheres of this size measured 4 to 6.5, the surface 0.3 from above and 2.1 from the side.
      assert.ok(body.roughness < 2.5, `single particles are seen; ${said}`);
    }
    await tank.close();
  });

  step("focuses sunlight by waves without making or losing any", async () => {
    const found = await focusLight(page);
    assert.ok(Math.abs(found.mean - 1) < 0.02, `mean ${found.mean}`);
    assert.ok(Math.abs(found.still_mean - 1) < 0.005 && found.still_most < 1.1, `still water: ${JSON.stringify(found)}`);
    assert.ok(found.most > 2, `the waves focus by ${found.most} at most`);
  });

  step("lights the picture by the chosen hour", async () => {
    const mean = async (light) => {
      await page.getByTestId("light").selectOption(light);
      // The change takes 1.2 s of drawn time, however long a picture takes.
      await page.evaluate(async () => {
        const picture = () => new Promise((drawn) => requestAnimationFrame(drawn));
        for (const start = performance.now(); performance.now() < start + 2000; ) await picture();
        for (let i = 0; i < 3; ++i) await picture();
      });
      return (await measure(page, await shootWater(page))).brightness;
    };
    const noon = await mean("noon");
    const dusk = await mean("dusk");
    const moon = await mean("moon");
    const said = JSON.stringify({ noon, dusk, moon });
    assert.ok(dusk < 0.8 * noon && moon < dusk, said);
    assert.equal(await page.getByTestId("slider-hour").inputValue(), "23");
    await page.getByTestId("slider-hour").fill("12");
    assert.equal(await page.getByTestId("light").inputValue(), "hour");
    await page.getByTestId("light").selectOption("automatic");
  });

  step("owns a boat that others cannot take, and keeps it after a reload", async () => {
    const ada = await openPage("marina");
    const bob = await openPage("marina");
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

  step("reconnects after the server was killed and restarted", async () => {
    is_server_down = true;
    await server.stop("SIGKILL");
    await waitFor(page, "the page to notice", (stats) => stats.connectionState.startsWith("retrying"));
    const last = await statsOf(page);
    server = await startServer(server.port);
    await waitFor(page, "the page to be live again", (stats) => stats.connectionState === "live");
    await waitFor(page, "new frames", (stats) => stats.framesReceived.surface > last.framesReceived.surface);
    is_server_down = false;
    await acknowledged(page, () => page.getByTestId("splash").click());
  });

  step("gets close code 1001 when the server is terminated, and the server exits with 0", async () => {
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
    is_server_down = true;
    const end = await server.stop("SIGTERM");
    assert.deepEqual(end, { code: 0, signal: null });
    assert.equal(await page.evaluate(() => window.__close_code), 1001);
  });

  step("raised no error and violated no content policy", () => {
    assert.deepEqual(complaints, []);
  });
});
