// The page as an exhibit: attract view, visits, time-outs, limits, the watchdog, and a day of visitors in simulated time.
// KIOSK_HOURS=N (default 1): length of that day in hours.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { cameraAtRest, launch, skip, until, WAIT_MS } from "./chromium.mjs";
import { ended, repository, startServer } from "./server.mjs";

const slow = { timeout: 8 * WAIT_MS };
const kHours = Number(process.env.KIOSK_HOURS ?? 1);
/** A round is a simulated minute. */
const kRoundsCount = Math.round(60 * kHours);
const kHeapGrowthMaxBytes = 8e6;
/** All that visitors may see of controls. */
const kAllowed = ["view", "wave", "spawn", "kiosk-view", "tool-finger", "tool-splash", "tool-paddle", "tool-float", "tool-throw"];
const kIdleS = 60;

describe("a kiosk", { skip, concurrency: 1 }, () => {
  let server;
  let browser;
  let page;
  let address;
  const complaints = [];
  const lines = [];
  const start = (port = 0) => startServer(port, ["--scene", `${repository}/tests/browser/kiosk.textproto`]);

  before(async () => {
    // Guests on this machine are operators: what the page forbids, it forbids to them, too.
    server = await start();
    address = `${server.url}?quality=minimal&kiosk=${kIdleS}`;
    browser = await launch();
    page = await (await browser.newContext({ viewport: { width: 800, height: 600 }, hasTouch: true })).newPage();
    page.setDefaultTimeout(WAIT_MS);
    page.on("pageerror", (error) => complaints.push(error.stack ?? error.message));
    page.on("console", (message) => lines.push(message.text()));
    await page.goto(address, { timeout: WAIT_MS });
    await shown();
    await page.evaluate(() => void (window.mark = 1));
  }, slow);
  after(() => ended(browser, server));

  /** While a page loads, what is read of it fails. */
  const whenThere = (what, read, accept) => until(what, () => read().catch((error) => error.message), accept);
  const stats = () => page.evaluate(() => ({ ...window.spindrift.stats(), ...window.spindriftKiosk.stats() }));
  const untilStats = (what, accept) => whenThere(what, stats, (now) => typeof now === "object" && accept(now));
  const shown = () => untilStats("pictures of the water", ({ connectionState, shownTimeS }) => connectionState === "live" && shownTimeS !== null);
  const skipVisit = (s) => page.evaluate((seconds) => window.spindriftKiosk.skipVisit(seconds), s);
  const pixel = () => page.evaluate(() => window.spindrift.pixelOf(3, 2));
  const tap = (x, y) => page.touchscreen.tap(x, y);
  const roomNow = async () => (await fetch(`${server.url}api/v1/rooms/main`)).json();
  const isSamePage = async () => assert.deepEqual(await page.evaluate(() => [window.mark, location.href]), [1, address]);
  /** Controls and other things that can be seen and used. */
  const visibleControls = () => page.evaluate(() => {
    const controls = [...document.querySelectorAll("a[href], button, input, select, textarea, summary, dialog, iframe, [tabindex], [contenteditable]")];
    return controls.filter((each) => each.checkVisibility({ visibilityProperty: true, opacityProperty: true })).map((each) => each.dataset.testid ?? (each.closest("#pad") ? "helm" : each.id || each.outerHTML.slice(0, 80)));
  });
  const others = async () => (await visibleControls()).filter((name) => !kAllowed.includes(name) && name !== "helm" && !name.startsWith("object-"));

  it("attracts: the camera moves by itself, and not for those who want less motion", slow, async () => {
    assert.ok(await page.getByTestId("kiosk-invite").isVisible());
    assert.deepEqual(await visibleControls(), ["view"]);
    const first = await pixel();
    await whenThere("the camera to move", pixel, ([x, y]) => Math.hypot(x - first[0], y - first[1]) > 5);
    await page.emulateMedia({ reducedMotion: "reduce" });
    await cameraAtRest(page);
    const still = await pixel();
    for (let k = 0; k < 5; ++k) {
      await sleep(200);
      assert.ok((await pixel()).every((px, axis) => Math.abs(px - still[axis]) < 1e-6));
    }
  });

  it("offers tools at a touch, and nothing that leads out", slow, async () => {
    await tap(400, 330);
    await untilStats("the visit", ({ phase }) => phase === "active");
    assert.ok(await page.getByTestId("kiosk-invite").isHidden());
    await page.getByTestId("tool-throw").waitFor({ state: "visible", timeout: WAIT_MS });
    assert.deepEqual(await others(), []);
    for (const key of ["F5", "Control+r", "Control+p", "Control+l", "F11", "Alt+ArrowLeft", "Alt+Home", "m", "Escape", "4", "Shift+F10"]) await page.keyboard.press(key);
    const prevented = await page.evaluate(() => {
      const view = document.getElementById("view");
      const link = Object.assign(document.createElement("a"), { href: "https://example.com/" });
      document.body.append(link);
      const events = [new MouseEvent("contextmenu", { bubbles: true, cancelable: true }), new Event("selectstart", { bubbles: true, cancelable: true }), new DragEvent("dragstart", { bubbles: true, cancelable: true }), new WheelEvent("wheel", { bubbles: true, cancelable: true, ctrlKey: true, deltaY: 50 })];
      const found = [...events.map((event) => !view.dispatchEvent(event)), !link.dispatchEvent(new MouseEvent("click", { bubbles: true, cancelable: true }))];
      link.remove();
      // A control that is not shown does nothing either.
      for (const id of ["pause", "reset"]) document.getElementById(id).click();
      return found;
    });
    assert.deepEqual(prevented, [true, true, true, true, true]);
    const { refusedCount, sound, paused } = await stats();
    assert.ok(refusedCount >= 2, `${refusedCount} refused`);
    assert.deepEqual([sound, paused, (await roomNow()).paused ?? false], [null, false, false]);
    await isSamePage();
  });

  it("counts down without input, continues at a touch, and puts away what a visitor leaves", slow, async () => {
    await page.getByTestId("tool-float").tap();
    await tap(420, 360);
    await untilStats("an own object", ({ ownFloaters }) => ownFloaters.length === 1);
    await page.getByTestId("spawn").tap();
    await untilStats("an own boat", ({ myBoat, view }) => myBoat > 0 && view === "boat");
    assert.ok(await page.getByTestId("spawn").isHidden(), "one boat is enough");
    assert.deepEqual(await others(), []);
    assert.equal((await roomNow()).boat_count, 1);

    await skipVisit(kIdleS + 1);
    const countdown = page.getByTestId("kiosk-countdown");
    await countdown.waitFor({ state: "visible", timeout: WAIT_MS });
    assert.match(await countdown.innerText(), /^Back to the start in \d+ s – touch to continue$/);
    await tap(200, 330);
    await untilStats("the visit", ({ phase }) => phase === "active");
    assert.ok(await countdown.isHidden());

    await skipVisit(kIdleS);
    await untilStats("the countdown", ({ phase }) => phase === "countdown");
    await skipVisit(10);
    await untilStats("the first view without what was left", ({ phase, view, ownBoats, ownFloaters, boats, floaters }) => phase === "attract" && view === "start" && ownBoats.length + ownFloaters.length + boats.length === 0 && floaters.length === 1);
    assert.equal((await roomNow()).boat_count ?? 0, 0);
    assert.ok(await page.getByTestId("kiosk-invite").isVisible());
    await isSamePage();
  });

  it("loads again when pictures stop, each time later, and not while the server is away", slow, async () => {
    const reloaded = (reloads) => whenThere(`reload ${reloads}`, () => page.evaluate(() => [window.mark ?? 0, window.spindriftKiosk.stats().reloads]), (now) => now[0] === 0 && now[1] === reloads);
    const skipWatchdog = (s) => page.evaluate((seconds) => window.spindriftKiosk.skipWatchdog(seconds), s);
    const watchdogSaid = (text) => whenThere(text, async () => lines.filter((line) => line.includes("kiosk:")), (said) => said.some((line) => line.includes(text)));
    await page.evaluate(() => void (window.requestAnimationFrame = () => 0));
    await skipWatchdog(31);
    await reloaded(1);
    await watchdogSaid("the page loads again (reload 1 in a row)");
    await shown();

    await page.evaluate(() => {
      window.mark = 1;
      document.getElementById("view").getContext("webgl2").getExtension("WEBGL_lose_context").loseContext();
    });
    await skipWatchdog(40);
    await isSamePage();
    await skipWatchdog(25);
    await reloaded(2);
    await shown();

    await page.evaluate(() => void (window.mark = 1));
    await server.stop("SIGTERM");
    await untilStats("the loss of the connection", ({ connectionState }) => connectionState !== "live");
    await page.evaluate(() => window.spindriftKiosk.skipWatchdog(700));
    await watchdogSaid("the page is not loaded again before the server answers");
    await isSamePage();
    server = await start(server.port);
    await shown();
    assert.equal((await stats()).phase, "attract");
    assert.deepEqual(complaints, []);
  });

  it(`stands ${kHours} h of random touches and keys: no error, no way out, no growth of memory`, { timeout: 8 * WAIT_MS + kRoundsCount * 10_000 }, async (context) => {
    await page.emulateMedia({ reducedMotion: "no-preference" });
    await page.evaluate(() => {
      window.mark = 1;
      // Browsers capture real pointers only, and the storm has others, too.
      for (const name of ["setPointerCapture", "releasePointerCapture"]) {
        const real = Element.prototype[name];
        Element.prototype[name] = function (pointerId) {
          if (pointerId < 1000) real.call(this, pointerId);
        };
      }
    });
    const { reloads } = await stats();
    let seed = 20_261_127;
    const random = () => (seed = (Math.imul(seed, 1_664_525) + 1_013_904_223) >>> 0) / 2 ** 32;
    const devtools = await page.context().newCDPSession(page);
    const memory = async () => {
      await devtools.send("HeapProfiler.collectGarbage");
      return { bytes: (await devtools.send("Runtime.getHeapUsage")).usedSize, ...(await devtools.send("Memory.getDOMCounters")) };
    };
    let eventsCount = 0;
    let settled;
    for (let round = 0; round < kRoundsCount; ++round) {
      eventsCount += await page.evaluate(storm, [random() * 2 ** 31, 40]);
      for (let k = 0; k < 2; ++k, ++eventsCount) await tap(800 * random(), 600 * random());
      await page.keyboard.press(["Tab", "Enter", "ArrowUp", "F5", "Alt+ArrowLeft", "Escape", "3", "q", "Control+w"][Math.floor(9 * random())]);
      // Most visitors stay; some leave until the countdown, some for good.
      await skipVisit(Math.floor([5, 20, kIdleS + 3, kIdleS + 15][Math.floor(4 * random())]));
      if (round === Math.floor(kRoundsCount / 4)) settled = await memory();
      if (round % 20 === 0) assert.deepEqual(await others(), []);
    }
    await isSamePage();
    await skipVisit(kIdleS);
    await skipVisit(10);
    const end = await untilStats("the end of the last visit", ({ phase, ownBoats, ownFloaters }) => phase === "attract" && ownBoats.length + ownFloaters.length === 0);
    const grown = await memory();
    context.diagnostic(`${eventsCount} events, ${end.refusedCount} commands refused by the page; heap ${(settled.bytes / 1e6).toFixed(1)} MB after a quarter, ${(grown.bytes / 1e6).toFixed(1)} MB at the end; nodes ${settled.nodes}, ${grown.nodes}; listeners ${settled.jsEventListeners}, ${grown.jsEventListeners}`);
    assert.ok(grown.bytes - settled.bytes < kHeapGrowthMaxBytes, `heap grew by ${((grown.bytes - settled.bytes) / 1e6).toFixed(1)} MB`);
    assert.ok(grown.nodes - settled.nodes < 200 && grown.jsEventListeners - settled.jsEventListeners < 50, JSON.stringify([settled, grown]));
    await untilStats("pictures after all that", ({ shownTimeS, connectionState }) => connectionState === "live" && shownTimeS > end.shownTimeS + 1);
    const { boat_count: boats = 0, session_count: sessions, paused = false } = await roomNow();
    assert.deepEqual([boats, sessions, paused], [0, 1, false]);
    assert.equal((await stats()).reloads, reloads, "the watchdog saw a page that works");
    assert.deepEqual(complaints, []);
  });

  /** Runs in the page: random presses, drags, wheels and keys at random positions. Returns how many. */
  function storm([seed, count]) {
    let state = seed >>> 0;
    const random = () => (state = (Math.imul(state, 1_664_525) + 1_013_904_223) >>> 0) / 2 ** 32;
    for (let n = 0; n < count; ++n) {
      const [clientX, clientY] = [innerWidth * random(), innerHeight * random()];
      const target = document.elementFromPoint(clientX, clientY) ?? document.body;
      const kind = random();
      const init = { bubbles: true, cancelable: true, clientX, clientY, pointerId: 1000 + Math.floor(4 * random()), pointerType: random() < 0.7 ? "touch" : "mouse", button: 0, buttons: 1 };
      if (kind < 0.15) target.dispatchEvent(new WheelEvent("wheel", { ...init, deltaY: 200 * random() - 100, ctrlKey: random() < 0.3 }));
      else if (kind < 0.35) target.dispatchEvent(new KeyboardEvent("keydown", { bubbles: true, cancelable: true, code: ["KeyW", "KeyE", "Digit6", "Digit7", "ArrowLeft", "F1", "Minus"][Math.floor(7 * random())], key: "x", ctrlKey: random() < 0.1 }));
      else if (kind < 0.45 && target.closest("button")) target.closest("button").click();
      else {
        target.dispatchEvent(new PointerEvent("pointerdown", init));
        for (let k = 0; k < 3; ++k) target.dispatchEvent(new PointerEvent("pointermove", { ...init, clientX: clientX + 60 * random() - 30, clientY: clientY + 60 * random() - 30 }));
        target.dispatchEvent(new PointerEvent(random() < 0.9 ? "pointerup" : "pointercancel", { ...init, buttons: 0 }));
      }
    }
    return count;
  }
});
