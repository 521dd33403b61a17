// Measures the time from a finger to one's own ripple and to somebody else's picture, by stage, in two headless browsers with software WebGL.
// The page and the server must be built.
//   bench_latency.mjs [--rounds N] [--size 480x300]
import { setTimeout as sleep } from "node:timers/promises";
import { parseArgs } from "node:util";

import { launch, waitFor } from "./chromium.mjs";
import { repository, startServer } from "./server.mjs";
import { pixelOf } from "./two_people.mjs";

const { values } = parseArgs({ options: { rounds: { type: "string", default: "15" }, size: { type: "string", default: "480x300" } } });
const rounds = Number(values.rounds);
const [width, height] = values.size.split("x").map(Number);
if (!(rounds >= 1 && width > 0 && height > 0)) {
  console.error("usage: bench_latency.mjs [--rounds N] [--size WIDTHxHEIGHT]");
  process.exit(2);
}
/** The water is calm again below the first range of elevations [m], and moved above the second. */
const kCalmM = 0.004;
const kMovedM = 0.006;

/** Runs in both pages before everything else; times are those of the machine, milliseconds. */
function watch() {
  const now = () => performance.timeOrigin + performance.now();
  const marks = (window.marks = {});
  let picture = 0;
  let eventPicture = 0;
  const post = Worker.prototype.postMessage;
  Worker.prototype.postMessage = function (message, ...more) {
    if (JSON.stringify(message, (_, value) => (typeof value === "bigint" ? Number(value) : value)).includes('"stroke"')) marks.sent ??= now();
    return post.call(this, message, ...more);
  };
  window.addEventListener("pointermove", (event) => {
    if (event.buttons !== 1 || marks.event) return;
    Object.assign(marks, { event: performance.timeOrigin + event.timeStamp, handled: now() });
    eventPicture = picture;
  }, { capture: true });
  window.arm = (from) => {
    for (const name of Object.keys(marks)) delete marks[name];
    window.armed = from;
  };
  const look = () => {
    const stats = window.spindrift?.stats();
    if (!stats || !window.armed) return undefined;
    if (!marks.received && stats.maxElevationM - stats.minElevationM > window.armed.movedM) Object.assign(marks, { received: now(), receivedS: stats.surfaceTimeS, receivedPicture: picture });
    return stats;
  };
  const draw = () => {
    requestAnimationFrame(draw);
    ++picture;
    // Sees what the page drew in the picture before.
    const stats = look();
    if (marks.event && !marks.own && stats?.dents > 0) Object.assign(marks, { own: now(), ownPictures: picture - eventPicture });
    if (marks.received && !marks.drawn && stats?.shownTimeS >= marks.receivedS) Object.assign(marks, { drawn: now(), drawnPictures: picture - marks.receivedPicture });
  };
  requestAnimationFrame(draw);
  setInterval(look, 2);
}

const server = await startServer(0, ["--scene", `${repository}/tests/browser/scene.textproto`, "--device", "software"]);
const browsers = [];
const open = async () => {
  const browser = await launch();
  browsers.push(browser);
  const page = await (await browser.newContext({ viewport: { width, height } })).newPage();
  await page.addInitScript(watch);
  await page.goto(`${server.url}?quality=minimal`);
  await waitFor(page, "the page to be live", ({ connectionState, framesReceived }) => connectionState === "live" && framesReceived.surface > 3);
  return page;
};
try {
  const [own, other] = [await open(), await open()];
  const found = [];
  for (let n = 0; n < rounds; ++n) {
    for (const page of [own, other]) await waitFor(page, "still water", ({ maxElevationM, minElevationM }) => maxElevationM - minElevationM < kCalmM);
    for (const page of [own, other]) await page.evaluate((movedM) => window.arm({ movedM }), kMovedM);
    const [from, to] = [await pixelOf(own, -0.6, 0.3), await pixelOf(own, 0.6, 0.3)];
    await own.mouse.move(...from);
    await own.mouse.down();
    await own.mouse.move(...to);
    await sleep(400);
    const deadlineMs = Date.now() + 20_000;
    let marks;
    do {
      marks = { ...(await other.evaluate(() => window.marks)), ...(await own.evaluate(({ event, handled, sent, own: seen, ownPictures } = window.marks) => ({ event, handled, sent, own: seen, ownPictures }))) };
      await sleep(20);
    } while (!(marks.drawn && marks.own) && Date.now() < deadlineMs);
    await own.mouse.up();
    if (!(marks.drawn && marks.own)) throw new Error(`round ${n}: not seen within 20 s: ${JSON.stringify(marks)}`);
    found.push(marks);
  }
  const line = (what, of) => {
    const sorted = found.map(of).sort((a, b) => a - b);
    console.log(`${what}: median ${sorted[Math.floor(sorted.length / 2)].toFixed(0)}, ${sorted[0].toFixed(0)} to ${sorted.at(-1).toFixed(0)}`);
  };
  const { displayFps } = await own.evaluate(() => window.spindrift.stats());
  const delayMs = await other.evaluate(() => window.spindrift.stats().delayMs);
  console.log(`${rounds} strokes, ${width} x ${height}: ${displayFps.toFixed(1)} and ${(await other.evaluate(() => window.spindrift.stats().displayFps)).toFixed(1)} pictures/s; the other page shows water ${delayMs.toFixed(0)} ms after its frame`);
  line("pointer event -> the page hears of it [ms]", (marks) => marks.handled - marks.event);
  line("the page hears of it -> command handed to the worker [ms]", (marks) => marks.sent - marks.handled);
  line("pointer event -> own ripple drawn [ms]", (marks) => marks.own - marks.event);
  // The pictures are counted before the page draws, so a ripple in the next picture is seen one later.
  line("pointer event -> own ripple drawn [pictures]", (marks) => marks.ownPictures - 1);
  line("command -> frame with it in the other page [ms]", (marks) => marks.received - marks.sent);
  line("frame -> drawn by the other page [ms]", (marks) => marks.drawn - marks.received);
  line("frame -> drawn by the other page [pictures]", (marks) => marks.drawnPictures - 1);
  line("pointer event -> drawn by the other page [ms]", (marks) => marks.drawn - marks.event);
} finally {
  for (const browser of browsers) await browser.close();
  await server.stop("SIGTERM");
}
