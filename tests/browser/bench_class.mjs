// Measures a class in headless Chromium with software WebGL: a crowd of pads without a page, half of them in a race and half drawing, beside
// a projector and a pad that are pages. The page and the server must be built; tests/wire and tests/browser need their packages (npm ci).
//   bench_class.mjs [--pads N] [--seconds S] [--quality minimal] [--pages projector,pad] [--picture FOLDER]
import { setTimeout as sleep } from "node:timers/promises";
import { parseArgs } from "node:util";

import { kPhone, launch } from "./chromium.mjs";
import { Crowd } from "./crowd.mjs";
import { command, startClass } from "./server.mjs";

const kWaitMs = 120_000;
const kSettleMs = 8000;

const { values } = parseArgs({
  options: { pads: { type: "string", default: "40" }, seconds: { type: "string", default: "30" }, quality: { type: "string", default: "minimal" }, pages: { type: "string", default: "projector,pad" }, picture: { type: "string" } },
});
const [padsCount, seconds] = [Number(values.pads), Number(values.seconds)];
if (!(padsCount >= 2 && padsCount <= 90 && seconds > 0)) {
  console.error("usage: bench_class.mjs [--pads 2..90] [--seconds S] [--quality minimal] [--pages projector,pad] [--picture FOLDER]");
  process.exit(2);
}

const { server, token } = await startClass(["--device", "software"]);
const origin = `http://127.0.0.1:${server.port}`;
const browsers = [];
let crowd;
try {
  const pages = [];
  const shown = values.pages.split(",");
  if (shown.includes("projector")) pages.push(await open("projector", { viewport: { width: 1280, height: 720 } }, `?class&quality=${values.quality}#token=${token}`));
  if (shown.includes("pad")) pages.push(await open("pad", kPhone, "pad"));
  crowd = await Crowd.open({ port: server.port, boats: Math.ceil(padsCount / 2), drawers: Math.floor(padsCount / 2), watches: true });
  crowd.launch();
  await sleep(1000);
  const race = await command(server, { start_game: { kind: "GAME_KIND_RACE", countdown_s: 1 } }, { token });
  if (!race.ok) throw new Error(await race.text());
  crowd.start();
  await sleep(kSettleMs);
  const [frames, simTimeS] = [framesOf(crowd), crowd.simTimeS];
  for (const page of pages) await page.begin();
  const begunMs = performance.now();
  await sleep(1000 * seconds);
  const tookS = (performance.now() - begunMs) / 1000;
  for (const page of pages) console.log(await page.measured());
  const rates = framesOf(crowd).map((count, n) => (count - frames[n]) / tookS).slice(1).sort((a, b) => a - b);
  const rejections = crowd.pads.flatMap((pad) => pad.rejections);
  console.log(`server: ${((crowd.simTimeS - simTimeS) / tookS).toFixed(2)} s simulated per second`);
  console.log(`crowd of ${padsCount}: ${rates[0].toFixed(1)} to ${rates.at(-1).toFixed(1)} frames/s of all layers and pad; ${rejections.length} rejected${rejections.length ? `, the first: ${rejections[0]}` : ""}`);
  if (values.picture) for (const page of pages) await page.picture(values.picture);
} finally {
  await crowd?.close();
  for (const browser of browsers) await browser.close();
  await server.stop("SIGTERM");
}

function framesOf({ pads }) {
  return pads.map(({ framesCount }) => framesCount);
}

/** Opens a page in a browser of its own, as on another machine, that counts its pictures and the longest time between two of them. */
async function open(name, options, path) {
  const browser = await launch();
  browsers.push(browser);
  const page = await (await browser.newContext(options)).newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  // Times what the page does for each picture; what the browser draws after it is not in that.
  await page.addInitScript(() => {
    const request = window.requestAnimationFrame.bind(window);
    window.scriptMs = 0;
    window.requestAnimationFrame = (callback) => request((atMs) => {
      const begunMs = performance.now();
      callback(atMs);
      window.scriptMs += performance.now() - begunMs;
    });
  });
  await page.goto(`${origin}/${path}`, { timeout: kWaitMs });
  await page.waitForFunction(() => window.spindrift?.stats().connectionState === "live", undefined, { timeout: kWaitMs });
  const devtools = await page.context().newCDPSession(page);
  const heapMB = async () => {
    await devtools.send("HeapProfiler.collectGarbage");
    return (await devtools.send("Runtime.getHeapUsage")).usedSize / 1e6;
  };
  let heapBeforeMB;
  return {
    begin: async () => {
      heapBeforeMB = await heapMB();
      await page.evaluate(() => {
        window.seen = { pictures: 0, pictureGapMs: 0, frameGapMs: 0 };
        window.scriptMs = 0;
        let [pictureMs, frameMs, simTime] = [performance.now(), performance.now(), NaN];
        const count = () => {
          requestAnimationFrame(count);
          const nowMs = performance.now();
          const { seen } = window;
          ++seen.pictures;
          seen.pictureGapMs = Math.max(seen.pictureGapMs, nowMs - pictureMs);
          pictureMs = nowMs;
        };
        requestAnimationFrame(count);
        setInterval(() => {
          const stats = window.spindrift.stats();
          if (stats.simTime === simTime) return;
          simTime = stats.simTime;
          window.seen.frameGapMs = Math.max(window.seen.frameGapMs, performance.now() - frameMs);
          frameMs = performance.now();
        }, 20);
        window.seen.sinceMs = performance.now();
      });
    },
    measured: async () => {
      const { pictures, pictureGapMs, frameGapMs, scriptMs, tookS } = await page.evaluate(() => ({ ...window.seen, scriptMs: window.scriptMs, tookS: (performance.now() - window.seen.sinceMs) / 1000 }));
      const after = await heapMB();
      return `${name}: ${(pictures / tookS).toFixed(1)} pictures/s, ${(scriptMs / pictures).toFixed(1)} ms of script each, longest gap ${pictureGapMs.toFixed(0)} ms; longest time without a frame ${frameGapMs.toFixed(0)} ms; heap ${heapBeforeMB.toFixed(1)} -> ${after.toFixed(1)} MB; ${errors.length} errors${errors.length ? `: ${errors.join("; ")}` : ""}`;
    },
    picture: (folder) => page.screenshot({ path: `${folder}/class_${name}.png`, timeout: kWaitMs }),
  };
}
