// Changes the scene of a room again and again, and prints what the page holds after each round: the JavaScript heap after a collection,
// and the WebGL objects. Every other round is drawn in another tier of quality. `npm run soak:page` in web-client builds the page and calls this.
//   soak_page.mjs [--minutes M] [--scenes A,B]
// Exits with 1 if the last third of the rounds always has more WebGL objects of a kind than the first third ever had, or if the heap grew by
// more than kMostGrowthMB.
import { setTimeout as sleep } from "node:timers/promises";
import { parseArgs } from "node:util";

import { launch } from "./chromium.mjs";
import { countGlObjects } from "./gl_objects.mjs";
import { startServer } from "./server.mjs";

const kWaitMs = 120_000;
/** Pictures of each scene before the next. Scenes change at most once per second. */
const kPictures = 3;
const kSceneMs = 1100;
const kMostGrowthMB = 3;

const { values } = parseArgs({ strict: false, options: { minutes: { type: "string", default: "30" }, scenes: { type: "string", default: "" } } });
const minutes = Number(values.minutes);
if (!(minutes > 0) || Object.keys(values).length > 2) {
  console.error("usage: soak_page.mjs [--minutes M] [--scenes A,B]");
  process.exit(2);
}

const server = await startServer(0, ["--scene", "harbor"]);
let browser;
try {
  browser = await launch();
  process.exitCode = (await soak(await browser.newPage({ viewport: { width: 480, height: 300 } }))) ? 0 : 1;
} finally {
  await browser?.close();
  await server.stop("SIGTERM");
}

async function soak(page) {
  page.on("pageerror", (error) => console.error(`error in the page: ${error}`));
  await page.addInitScript(countGlObjects);
  await page.goto(`${server.url}?quality=minimal`);
  await page.waitForFunction(() => window.spindrift?.stats().connectionState === "live", undefined, { timeout: kWaitMs, polling: 100 });
  const devTools = await page.context().newCDPSession(page);
  const select = page.getByTestId("scene");
  const scenes = values.scenes ? values.scenes.split(",") : await select.locator("option").evaluateAll((options) => options.map(({ value }) => value));
  const endMs = performance.now() + 60_000 * minutes;
  const rounds = [];
  for (let round = 1; performance.now() < endMs; ++round) {
    await choose(page, "quality", round % 2 ? "minimal" : "low");
    for (const scene of scenes) await show(page, select, scene);
    await show(page, select, scenes[0]);
    // Compared in the same state.
    await choose(page, "quality", "minimal");
    await pictures(page);
    await devTools.send("HeapProfiler.collectGarbage");
    const { usedSize } = await devTools.send("Runtime.getHeapUsage");
    const objects = await page.evaluate(() => window.glObjects());
    rounds.push({ heapMB: usedSize / 1e6, objects });
    console.log(`round ${round}, ${scenes.length} scenes: heap ${(usedSize / 1e6).toFixed(2)} MB, ${Object.entries(objects).map(([kind, count]) => `${kind} ${count}`).join(", ")}`);
  }
  if (rounds.length < 6) throw new Error(`${rounds.length} rounds in ${minutes} minutes are too few to compare`);
  const third = Math.floor(rounds.length / 3);
  const [early, late] = [rounds.slice(0, third), rounds.slice(-third)];
  // What a picture needs varies by a few objects with the water; what is lost adds up.
  const kept = (kind) => ({ most: Math.max(...early.map(({ objects }) => objects[kind])), least: Math.min(...late.map(({ objects }) => objects[kind])) });
  const lost = Object.keys(rounds[0].objects).filter((kind) => kept(kind).least > kept(kind).most);
  for (const kind of lost) console.error(`${kind}: at most ${kept(kind).most} in the first ${third} rounds, at least ${kept(kind).least} in the last`);
  const mean = (some) => some.reduce((sum, { heapMB }) => sum + heapMB, 0) / some.length;
  const growthMB = mean(late) - mean(early);
  console.log(`${rounds.length} rounds: heap ${growthMB >= 0 ? "+" : ""}${growthMB.toFixed(2)} MB from the first third of them to the last (at most ${kMostGrowthMB})`);
  return lost.length === 0 && growthMB <= kMostGrowthMB;
}

async function show(page, select, scene) {
  if ((await select.inputValue()) !== scene) {
    const before = await page.title();
    await choose(page, "scene", scene);
    await page.waitForFunction((title) => document.title !== title, before, { timeout: kWaitMs, polling: 50 }).catch(async (error) => {
      throw new Error(`${scene}: ${await page.getByTestId("toast").textContent()}`, { cause: error });
    });
    await sleep(kSceneMs);
  }
  await pictures(page);
}

/** Chooses in a list of the panel, which a small window hides. */
function choose(page, testId, value) {
  return page.getByTestId(testId).evaluate((list, wanted) => {
    list.value = wanted;
    list.dispatchEvent(new Event("change"));
  }, value);
}

function pictures(page) {
  return page.evaluate(async (count) => {
    for (let i = 0; i < count; ++i) await new Promise((drawn) => requestAnimationFrame(drawn));
  }, kPictures);
}
