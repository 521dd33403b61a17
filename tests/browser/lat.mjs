import { chromium } from "playwright-core";
import { kChromiumArgs } from "./chromium.mjs";
const b = await chromium.launch({ executablePath: "/usr/bin/chromium", args: kChromiumArgs });
const open = async () => { const p = await (await b.newContext({ viewport: { width: 480, height: 320 } })).newPage(); await p.goto("http://127.0.0.1:9335/?quality=minimal"); await p.waitForFunction(() => window.spindrift?.stats().framesReceived.surface > 20, undefined, { timeout: 60000 }); return p; };
const a = await open(), c = await open();
await a.waitForTimeout(2000);
const epoch = () => performance.timeOrigin + performance.now();
for (const p of [a, c]) await p.evaluate(() => {
  window.seen = {};
  const now = () => performance.timeOrigin + performance.now();
  document.getElementById("view").addEventListener("pointerdown", e => (window.seen.down = performance.timeOrigin + e.timeStamp), true);
  const loop = () => { const s = window.spindrift.stats();
    if (s.dents > 0) window.seen.dent ??= now();
    if (document.querySelector(".finger-tags div")) window.seen.ring ??= now();
    if (s.minElevationM < -0.02) window.seen.t ??= s.surfaceTimeS;
    if (window.seen.t !== undefined && s.shownTimeS >= window.seen.t) window.seen.shown ??= now();
    requestAnimationFrame(loop); };
  requestAnimationFrame(loop);
});
for (let run = 0; run < 8; ++run) {
  await a.waitForTimeout(2500);
  for (const p of [a, c]) await p.evaluate(() => (window.seen = {}));
  const px = (x, z) => a.evaluate(([q, r]) => window.spindrift.pixelOf(q, r), [x, z]);
  const pts = []; for (let k = 0; k < 12; ++k) pts.push(await px(-3 + 0.5 * k, 1));
  await a.mouse.move(...pts[0]); await a.mouse.down();
  for (const q of pts.slice(1)) { await a.mouse.move(...q); await a.waitForTimeout(12); }
  await a.waitForTimeout(500);
  await a.mouse.up();
  const A = await a.evaluate(() => window.seen), C = await c.evaluate(() => window.seen);
  const s = await c.evaluate(() => { const s = window.spindrift.stats(); return [s.displayFps.toFixed(0), s.delayMs.toFixed(0), s.latencyMs.toFixed(1)]; });
  console.log("own ripple", (A.dent - A.down).toFixed(0), "own ring", (A.ring - A.down).toFixed(0), "own water", (A.shown - A.down).toFixed(0), "other's ring", (C.ring - A.down).toFixed(0), "other's water", (C.shown - A.down).toFixed(0), "ms; fps, delay, latency", ...s);
}
await b.close();
