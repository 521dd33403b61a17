// What the page draws in Chromium: water, light and colours of data, by the pixels of its pictures. The tests share a page and run in order.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { focusLight } from "./caustics.mjs";
import { cameraAtRest, skip, until, WAIT_MS, waitFor } from "./chromium.mjs";
import { unfolded } from "./panel.mjs";
import { brightnessAt, colourAt, measure, measureBody, shootWater } from "./pixels.mjs";
import { drawnPictures, moving, newestIsDrawn, pressed, statsOf, stillWater, Visit } from "./visit.mjs";

const slow = { timeout: 4 * WAIT_MS };

describe("pictures of the page in Chromium", { skip, concurrency: 1 }, () => {
  const visit = new Visit();
  let page;

  before(async () => {
    page = await visit.begin();
  }, slow);
  after(() => visit.end(), { timeout: WAIT_MS });

  it("draws water in many colours", slow, async () => {
    await newestIsDrawn(page);
    const picture = await measure(page, await shootWater(page));
    assert.ok(picture.colour_count >= 12, `only ${picture.colour_count} colours`);
    assert.ok(picture.deviation > 3, `brightness varies by ${picture.deviation.toFixed(2)} of 255 only`);
  });

  it("sees the sky through Snell's window in still water, and the floor's reflection outside it", slow, async () => {
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
    const pixels = await until("both points to be in the picture", places, (all) => all.every(([x, y]) => x > 0 && x < 900 && y > 0 && y < 600));
    const png = await page.screenshot({ timeout: 120_000 });
    const [sky, floor] = await Promise.all(pixels.map(([x, y]) => colourAt(page, png, x, y)));
    // Water takes the red light on its way from the floor to the surface and back.
    assert.ok(sky[0] > 1.5 * floor[0], `red ${sky[0]} in the window, ${floor[0]} outside it`);
    await page.getByTestId("view-start").click();
    await page.emulateMedia({ reducedMotion: null });
    assert.equal((await statsOf(page)).view, "start");
  });

  it("shows data in colours: the probe reads the value whose colour the water has there", slow, async () => {
    await stillWater(page);
    await newestIsDrawn(page);
    const natural = await shootWater(page);
    const look = await unfolded(page.getByTestId("look"));
    assert.deepEqual(await look.locator("option").evaluateAll((options) => options.map(({ value }) => value)), ["natural", "height", "velocity", "speed", "density", "thesis"]);
    assert.ok(await page.getByTestId("look-key").isHidden(), "natural water has a colour bar");
    await look.selectOption("height");
    assert.match(await page.getByTestId("key-title").textContent(), /height \[m\]/);
    await page.waitForURL(/look=height/, { timeout: WAIT_MS });
    await pressed(page, "splash");
    await moving(page, "the surface to move", 0.2);
    await pressed(page, "pause");
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
    await pressed(page, "pause");
  });

  it("keeps the look at another level and after a lost graphics context, and goes back to natural water", slow, async () => {
    await (await unfolded(page.getByTestId("detail"))).selectOption("coarse");
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

  it("draws the same water in another quality, with its view, and keeps the choice in the address", slow, async () => {
    const quality = await unfolded(page.getByTestId("quality"));
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

  it("draws the open sea without an edge at the sides of the simulated square", slow, async () => {
    const sea = await visit.open("sea");
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

  it("draws a box full of particles as one body: no gaps, no beads", slow, async () => {
    const tank = await visit.open("tank", "particles");
    await waitFor(tank, "the particles to rest", (stats) => stats.simTime > 1);
    await pressed(tank, "pause");
    for (const view of ["view-overview", "view-start"]) {
      await tank.getByTestId(view).click();
      await waitFor(tank, `the camera to arrive at ${view}`, (stats) => `view-${stats.view}` === view);
      // The camera moves for a second of drawn time, however long a picture takes.
      await drawnPictures(tank, 1500);
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

  it("focuses sunlight by waves without making or losing any", slow, async () => {
    const found = await focusLight(page);
    assert.ok(Math.abs(found.mean - 1) < 0.02, `mean ${found.mean}`);
    assert.ok(Math.abs(found.still_mean - 1) < 0.005 && found.still_most < 1.1, `still water: ${JSON.stringify(found)}`);
    assert.ok(found.most > 2, `the waves focus by ${found.most} at most`);
  });

  it("lights the picture by the chosen hour", slow, async () => {
    const mean = async (light) => {
      await page.getByTestId("light").selectOption(light);
      // The change takes 1.2 s of drawn time, however long a picture takes.
      await drawnPictures(page, 2000);
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

  it("raised no error and violated no content policy", () => {
    assert.deepEqual(visit.complaints, []);
  });
});
