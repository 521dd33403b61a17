// Gauges, in Chromium: poles in the picture, and the panel with the chart, which holds what the server measured.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, describe, it } from "node:test";

import { kPhone, launch, skip, WAIT_MS, waitFor as waitForNumbers } from "./chromium.mjs";
import { ended, startServer } from "./server.mjs";

const kGauges = ["maker", "toe", "slope", "breakers", "shore"];
const kFingerPx = 44;
/** A picture, and all that a page on a busy machine has to do before it. */
const kPatienceMs = 4 * WAIT_MS;
const slow = { timeout: 6 * kPatienceMs };
const waitFor = (page, what, accept) => waitForNumbers(page, what, accept, kPatienceMs);

describe("the gauges", { skip, concurrency: 1 }, () => {
  let server;
  let browser;
  let desk;
  const requested = [];

  before(async () => {
    server = await startServer(0, ["--scene", "flume"]);
    browser = await launch();
    desk = await open({ viewport: { width: 1280, height: 720 } });
  }, slow);
  after(() => ended(browser, server));

  async function open(options) {
    const page = await (await browser.newContext(options)).newPage();
    page.setDefaultTimeout(kPatienceMs);
    page.on("request", (request) => requested.push(request.url()));
    await page.goto(`${server.url}?quality=minimal`, { timeout: kPatienceMs });
    await waitFor(page, "a picture", ({ connectionState, shownTimeS }) => connectionState === "live" && shownTimeS !== null);
    return page;
  }

  const seriesOf = async (gauge) => (await fetch(`${server.url}api/v1/rooms/main/gauges/${gauge}`)).json();
  const valueOf = (page, gauge) => page.getByTestId(`gauge-key-${gauge}`).locator(".gauge-value").textContent();

  /** Opens the panel and waits for readings. */
  async function openPanel(page, press) {
    await press(page.getByTestId("gauges"));
    await page.getByTestId("gauge-chart").waitFor({ timeout: kPatienceMs });
    await page.waitForFunction(() => /\d m$/.test(document.querySelector("[data-testid=gauge-key-toe] .gauge-value")?.textContent), undefined, { timeout: kPatienceMs });
  }

  /** Saves the table of the panel, and returns its header and its rows of numbers. */
  async function table(page) {
    const download = page.waitForEvent("download", { timeout: kPatienceMs });
    await page.getByTestId("gauge-csv").click();
    const file = await download;
    assert.match(file.suggestedFilename(), /^spindrift-flume-gauges-\d{4}-\d\d-\d\d-\d{6}\.csv$/);
    const [head, ...rows] = (await readFile(await file.path(), "utf8")).trimEnd().split("\n").map((line) => line.split(","));
    return { head, rows: rows.map((row) => row.map((value) => (value === "" ? null : Number(value)))) };
  }

  it("are poles from the bed to above the water, with their names", slow, async () => {
    const { gauges } = await waitFor(desk, "the ground", (stats) => stats.gauges.length === 5 && stats.gauges[4].lowM > -0.1);
    assert.deepEqual(gauges.map(({ name }) => name), kGauges);
    const depths = { maker: 0.5, slope: 0.25, breakers: 0.1, shore: 0 };
    for (const { name, lowM, topM } of gauges) {
      if (name in depths) assert.ok(Math.abs(lowM + depths[name]) < 0.01, `${name} begins at ${lowM} m`);
      assert.ok(topM > 0.1, `${name} ends at ${topM} m`);
    }
    const named = desk.getByTestId("gauge-tags").locator("span", { hasText: "breakers" });
    await named.filter({ visible: true }).waitFor({ timeout: kPatienceMs });
    const { topM, xM, zM } = gauges[3];
    const isThere = ([x, z, y]) => {
      const box = [...document.querySelectorAll(".gauge-tags span")].find((tag) => tag.textContent === "breakers").getBoundingClientRect();
      const [left, top] = window.spindrift.pixelOf(x, z, y);
      return Math.abs(box.left + box.width / 2 - left) < 3 && Math.abs(box.bottom - top) < 3;
    };
    await desk.waitForFunction(isThere, [xM, zM, topM], { timeout: kPatienceMs });
  });

  it("load their chart when the panel is first opened", slow, async () => {
    const isChart = (url) => /gauge_panel.*\.js$/.test(url);
    assert.ok(!requested.some(isChart), "nobody has opened it");
    await openPanel(desk, (button) => button.click());
    assert.equal(requested.filter(isChart).length, 1);
    await desk.waitForFunction(() => document.querySelector("[data-testid=gauge-chart] canvas")?.width > 300, undefined, { timeout: kPatienceMs });
  });

  it("have a chart that is held and read: values under the mouse are those of the server", slow, async () => {
    await waitFor(desk, "waves at the toe", ({ simTime }) => simTime > 12);
    await desk.getByTestId("gauge-pause").click();
    await desk.waitForFunction(() => document.querySelector("[data-testid=gauge-pause]").textContent === "Continue", undefined, { timeout: kPatienceMs });
    const chart = await desk.getByTestId("gauge-chart").boundingBox();
    await desk.mouse.move(chart.x + 0.7 * chart.width, chart.y + 0.4 * chart.height);
    await desk.waitForFunction(() => /^at /.test(document.querySelector("[data-testid=gauge-at]").textContent), undefined, { timeout: kPatienceMs });
    const readAll = async () => [await desk.getByTestId("gauge-at").textContent(), ...(await Promise.all(kGauges.map((gauge) => valueOf(desk, gauge))))];
    const read = await readAll();
    const timeS = Number(/^at ([\d.]+) s$/.exec(read[0])[1]);
    for (const [n, gauge] of kGauges.entries()) {
      const { time_s: times, elevation_m: elevations } = await seriesOf(gauge);
      const near = elevations.filter((_, at) => Math.abs(times[at] - timeS) < 0.02);
      const shownM = Number(/^(-?[\d.]+) m$/.exec(read[n + 1])[1]);
      assert.ok(near.some((elevationM) => Math.abs(elevationM - shownM) <= 0.0006), `${gauge} at ${timeS} s: ${read[n + 1]}, the server has ${near}`);
    }
    const { simTime } = await waitFor(desk, "a second", () => true);
    await waitFor(desk, "the water, which runs on", (stats) => stats.simTime > simTime + 1);
    assert.deepEqual(await readAll(), read);
    await desk.getByTestId("gauge-quantity").selectOption("velocityX");
    await desk.waitForFunction(() => / m\/s$/.test(document.querySelector("[data-testid=gauge-key-toe] .gauge-value").textContent), undefined, { timeout: kPatienceMs });
  });

  it("are saved as a table of every tick, with what the server measured", slow, async () => {
    await desk.getByTestId("gauge-key-maker").click();
    const { head, rows } = await table(desk);
    assert.deepEqual(head, ["time [s]", ...kGauges.slice(1).flatMap((gauge) => [`${gauge} elevation [m]`, `${gauge} velocity x [m/s]`, `${gauge} velocity z [m/s]`])]);
    const { time_s: times, elevation_m: elevations, velocity_x_mps: speeds } = await seriesOf("toe");
    const at = new Map(times.map((timeS, n) => [timeS, n]));
    // Meanwhile the server has dropped the oldest ones.
    const shared = rows.filter(([timeS]) => timeS >= times[0]);
    assert.ok(shared.length > 300, `${shared.length} of ${rows.length} rows are of times that the server still has`);
    for (const [timeS, elevationM, speedMps] of shared) {
      const n = at.get(timeS);
      assert.notEqual(n, undefined, `the server has no reading of ${timeS} s`);
      assert.ok(Math.abs(elevationM - elevations[n]) < 1e-6 && Math.abs(speedMps - speeds[n]) < 1e-6, `${timeS} s: ${elevationM} m, ${speedMps} m/s; the server has ${elevations[n]}, ${speeds[n]}`);
    }
    assert.ok(Math.max(...elevations) > 0.02, "there are waves");
    await desk.getByTestId("gauge-key-maker").click();
  });

  it("continue after the pause, live and with what came meanwhile", slow, async () => {
    await desk.getByTestId("gauge-quantity").selectOption("elevation");
    const held = await table(desk);
    await desk.getByTestId("gauge-pause").click();
    const newestS = held.rows.at(-1)[0];
    await waitFor(desk, "later water", ({ simTime }) => simTime > newestS + 2);
    await desk.mouse.move(640, 10);
    await desk.getByTestId("gauge-at").filter({ hasText: "now" }).waitFor({ timeout: kPatienceMs });
    const { rows } = await table(desk);
    const gaps = rows.slice(1).map(([timeS], n) => timeS - rows[n][0]);
    assert.ok(rows.at(-1)[0] > newestS + 1);
    assert.ok(Math.max(...gaps) < 0.05, `a gap of ${Math.max(...gaps)} s`);
  });

  it("are saved as a picture", slow, async () => {
    const download = desk.waitForEvent("download", { timeout: kPatienceMs });
    await desk.getByTestId("gauge-png").click();
    const file = await download;
    assert.match(file.suggestedFilename(), /^spindrift-flume-gauges-[\d-]+\.png$/);
    const bytes = await readFile(await file.path());
    assert.deepEqual([...bytes.subarray(1, 4)].map((byte) => String.fromCharCode(byte)).join(""), "PNG");
    assert.ok(bytes.readUInt32BE(16) > 400 && bytes.readUInt32BE(20) > 150, `${bytes.readUInt32BE(16)} x ${bytes.readUInt32BE(20)} pixels`);
    await desk.getByTestId("gauge-close").click();
    assert.ok(await desk.getByTestId("gauge-panel").isHidden());
    await desk.close();
  });

  it("are in the sheet of a phone: a chart to read, and controls for fingers", slow, async () => {
    const phone = await open(kPhone);
    await phone.getByTestId("gauges").waitFor();
    assert.equal(await phone.locator("#panel-toggle").getAttribute("aria-expanded"), "false");
    await openPanel(phone, (button) => button.tap());
    assert.equal(await phone.locator("#panel-toggle").getAttribute("aria-expanded"), "true");
    const chart = await phone.getByTestId("gauge-chart").boundingBox();
    assert.ok(chart.x >= 0 && chart.x + chart.width <= 390 && chart.y > 422 && chart.y + chart.height <= 844, JSON.stringify(chart));
    assert.ok(chart.width > 330 && chart.height > 140, JSON.stringify(chart));
    const small = await phone.evaluate((least) => [...document.querySelectorAll(".gauge-card :is(button, select)")].filter((each) => each.offsetWidth < least || each.offsetHeight < least).map(({ textContent }) => textContent), kFingerPx);
    assert.deepEqual(small, []);
    await phone.touchscreen.tap(chart.x + 0.6 * chart.width, chart.y + 0.4 * chart.height);
    await phone.getByTestId("gauge-at").filter({ hasText: /^at / }).waitFor({ timeout: kPatienceMs });
  });
});

describe("gauges of one's own", { skip, concurrency: 1 }, () => {
  let server;
  let browser;
  let desk;
  let phone;

  before(async () => {
    server = await startServer(0, ["--scene", "pool", "--guests", "player", "--grace-s", "1"]);
    browser = await launch();
    desk = await open({ viewport: { width: 1280, height: 720 } });
    phone = await open(kPhone);
  }, slow);
  after(() => ended(browser, server));

  async function open(options) {
    const page = await (await browser.newContext(options)).newPage();
    page.setDefaultTimeout(kPatienceMs);
    await page.goto(`${server.url}?quality=minimal`, { timeout: kPatienceMs });
    await waitFor(page, "a picture", ({ connectionState, shownTimeS, role }) => connectionState === "live" && shownTimeS !== null && role === "player");
    return page;
  }

  const gaugesWhen = (page, what, names) => waitFor(page, what, ({ gauges }) => gauges.map(({ name }) => name).join() === names).then(({ gauges }) => gauges);
  const isPlacing = (page) => page.getByTestId("gauge-place").getAttribute("aria-pressed").then((value) => value === "true");
  const valueShows = (page, gauge) => page.getByTestId(`gauge-key-${gauge}`).locator(".gauge-value").filter({ hasText: /\d m$/ }).waitFor({ timeout: kPatienceMs });

  /** Where the water can be seen and touched: a place on it, and the pixel. */
  async function openWater(page) {
    const found = await page.evaluate(() => {
      for (const xM of [0, 1, -1, 2, -2, 3, -3])
        for (const zM of [0, 1, -1, 2, -2, 3, -3]) {
          const [xPx, yPx] = window.spindrift.pixelOf(xM, zM);
          if (document.elementFromPoint(xPx, yPx)?.id === "view") return { xM, zM, xPx, yPx };
        }
      return undefined;
    });
    assert.ok(found, "no place on the water can be touched");
    return found;
  }
  /** A ray that is low over waves ends metres from where it meets still water: the touched pixel must be one of the gauge's pole. */
  async function assertIsAt(page, { xM, zM, lowM, topM }, { xPx, yPx }) {
    const ends = await page.evaluate(([x, z, ...ends]) => ends.map((y) => window.spindrift.pixelOf(x, z, y)), [xM, zM, lowM, topM]);
    const [[lowXPx, lowYPx], [topXPx, topYPx]] = ends;
    const share = Math.min(1, Math.max(0, (yPx - topYPx) / (lowYPx - topYPx)));
    const poleXPx = topXPx + share * (lowXPx - topXPx);
    assert.ok(Math.abs(poleXPx - xPx) < 3 && yPx > topYPx - 3 && yPx < lowYPx + 3, `the pole is seen from ${topXPx}, ${topYPx} to ${lowXPx}, ${lowYPx}, not at ${xPx}, ${yPx}`);
  }

  it("are placed by a click, in a scene that has none, and others see them", slow, async () => {
    await desk.getByTestId("gauges").click();
    await desk.getByTestId("gauge-at").filter({ hasText: "no gauge" }).waitFor({ timeout: kPatienceMs });
    assert.deepEqual((await desk.evaluate(() => window.spindrift.stats())).gauges, []);
    await desk.getByTestId("gauge-place").click();
    assert.ok(await isPlacing(desk));
    assert.match(await desk.getByTestId("hint").textContent(), /Click the water/);
    const place = await openWater(desk);
    await desk.mouse.click(place.xPx, place.yPx);
    const [gauge] = await gaugesWhen(desk, "the gauge", "G1");
    await assertIsAt(desk, gauge, place);
    assert.ok(gauge.lowM < -1.4 && gauge.topM > 0.2, `${gauge.lowM} to ${gauge.topM} m`);
    assert.ok(!(await isPlacing(desk)));
    assert.equal((await desk.evaluate(() => window.spindrift.stats())).lastCommand.case, "placeGauge");
    const [seen] = await gaugesWhen(phone, "the gauge of the other", "G1");
    assert.deepEqual(seen, gauge);
    await phone.getByTestId("gauge-tags").locator("span", { hasText: "G1" }).waitFor({ state: "attached", timeout: kPatienceMs });
    await valueShows(desk, "G1");
    const { time_s: times, x_m: xM } = await (await fetch(`${server.url}api/v1/rooms/main/gauges/G1`)).json();
    assert.ok(times.length > 1 && xM === gauge.xM, `${times.length} ticks at ${xM} m`);
  });

  it("are not placed after Escape, and a tap is one of the tool again", slow, async () => {
    await desk.getByTestId("gauge-place").click();
    await desk.keyboard.press("Escape");
    assert.ok(!(await isPlacing(desk)));
    assert.ok(await desk.getByTestId("hint").isHidden());
    const place = await openWater(desk);
    await desk.mouse.click(place.xPx, place.yPx);
    await waitFor(desk, "a splash", ({ lastCommand }) => lastCommand.case === "splash");
    await gaugesWhen(desk, "the one gauge", "G1");
  });

  it("are placed by touch, and removed by who has placed them", slow, async () => {
    await phone.getByTestId("gauges").tap();
    await valueShows(phone, "G1");
    assert.ok(await phone.getByTestId("gauge-remove-G1").isHidden(), "it is the other's");
    assert.match(await phone.getByTestId("gauge-key-G1").getAttribute("title"), /^Placed by guest \d$/);
    await phone.getByTestId("gauge-place").tap();
    await phone.getByTestId("hint").filter({ hasText: "Tap the water" }).waitFor({ timeout: kPatienceMs });
    const place = await openWater(phone);
    await phone.touchscreen.tap(place.xPx, place.yPx);
    await assertIsAt(phone, (await gaugesWhen(phone, "the second gauge", "G1,G2"))[1], place);
    await gaugesWhen(desk, "the second gauge on the other page", "G1,G2");
    await valueShows(phone, "G2");
    const small = await phone.evaluate((least) => [...document.querySelectorAll(".gauge-card :is(button, select)")].filter((each) => each.checkVisibility() && (each.offsetWidth < least || each.offsetHeight < least)).map(({ textContent }) => textContent), kFingerPx);
    assert.deepEqual(small, []);
    await phone.getByTestId("gauge-remove-G2").tap();
    for (const page of [phone, desk]) await gaugesWhen(page, "the first gauge alone", "G1");
    await phone.getByTestId("gauge-key-G2").waitFor({ state: "detached", timeout: kPatienceMs });
    assert.equal((await fetch(`${server.url}api/v1/rooms/main/gauges/G2`)).status, 404);
  });

  it("are placed by keys", slow, async () => {
    await desk.getByTestId("gauge-place").focus();
    await desk.keyboard.press("Enter");
    assert.ok(await isPlacing(desk));
    for (let k = 0; k < 5; ++k) await desk.keyboard.press("ArrowUp");
    await desk.keyboard.press("Enter");
    await gaugesWhen(desk, "the third gauge", "G1,G3");
    await desk.getByTestId("gauge-remove-G3").click();
    await gaugesWhen(desk, "its end", "G1");
  });

  it("are gone some time after their owner", slow, async () => {
    await desk.close();
    await gaugesWhen(phone, "a water without gauges", "");
  });
});
