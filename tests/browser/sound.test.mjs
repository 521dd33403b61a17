// Sound, in Chromium: off until asked; a splash is heard and calm water is silent; a note follows a gauge; the voices on their own.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { repository } from "./server.mjs";
import { pixelOf, skip, twoPeople, waitFor, WAIT_MS } from "./two_people.mjs";

/** RMS of the output that counts as silence, and as a splash. */
const kSilentRms = 0.0005;
const kHeardRms = 0.005;

describe("sound of the water", { skip, timeout: 10 * WAIT_MS, concurrency: 1 }, () => {
  let desk;
  let close;

  const splash = async (xM, zM) => desk.mouse.click(...(await pixelOf(desk, xM, zM)));
  const isStill = ({ maxElevationM, minElevationM }) => maxElevationM - minElevationM < 0.004;
  const waitForSilence = () => waitFor(desk, "silence", (stats) => isStill(stats) && stats.sound.levelRms < kSilentRms);

  before(async () => {
    ({ desk, close } = await twoPeople(`${repository}/tests/browser/sound.textproto`, () => {
      window.contextCount = 0;
      window.AudioContext = class extends window.AudioContext {
        constructor(...options) {
          super(...options);
          ++window.contextCount;
        }
      };
    }));
    await waitFor(desk, "still water", isStill);
  });
  after(() => close?.());

  it("makes no AudioContext before it is asked for, and loads nothing of the sound", async () => {
    await splash(0, 0);
    await waitFor(desk, "the splash", ({ minElevationM }) => minElevationM < -0.03);
    assert.equal(await desk.evaluate(() => window.contextCount), 0);
    assert.equal((await waitFor(desk, "stats", () => true)).sound, null);
    const loaded = await desk.evaluate(() => performance.getEntriesByType("resource").map(({ name }) => name));
    assert.deepEqual(loaded.filter((name) => name.includes("water_sound")), []);
    assert.equal(await desk.getByTestId("sound").getAttribute("aria-pressed"), "false");
  });

  it("lets a splash be heard, and is silent when the water is calm again", async () => {
    await desk.getByTestId("sound").click();
    await waitFor(desk, "the context to run", ({ sound }) => sound?.state === "running");
    assert.equal(await desk.getByTestId("sound").getAttribute("aria-pressed"), "true");
    await waitForSilence();
    const heard = waitFor(desk, "the splash to be heard", ({ sound }) => sound.levelRms > kHeardRms && sound.voiceCount > 0);
    await splash(0.5, 0.5);
    await heard;
    await waitForSilence();
  });

  it("is muted by the key M, and sounds again by it", async () => {
    await desk.keyboard.press("m");
    await waitFor(desk, "the context to rest", ({ sound }) => !sound.isOn && sound.state === "suspended");
    await desk.keyboard.press("m");
    await waitFor(desk, "the context to run", ({ sound }) => sound.isOn && sound.state === "running");
    assert.equal(await desk.evaluate(() => window.contextCount), 1);
  });

  it("follows a gauge with a note: an octave per chosen height", async () => {
    await desk.getByTestId("sound-box").locator("summary").click();
    await desk.getByTestId("tone").selectOption("corner");
    await desk.getByTestId("tone-octave").selectOption("0.1");
    assert.match(await desk.getByTestId("sound-remark").textContent(), /440 Hz/);
    const still = await waitFor(desk, "the note of still water", ({ sound, ...stats }) => isStill(stats) && sound.tone && Math.abs(Math.log2(sound.tone.playsHz / 440)) < 0.05);
    assert.ok(still.sound.levelRms > kHeardRms, `the note has an RMS of ${still.sound.levelRms}`);
    const heights = [];
    await splash(1.6, 0.8);
    await waitFor(desk, "a note that moves", ({ sound: { tone } }) => {
      heights.push(tone);
      return heights.length > 40;
    });
    const octaves = heights.map(({ hz }) => Math.log2(hz / 440));
    for (const [k, { elevationM }] of heights.entries()) assert.ok(Math.abs(octaves[k] - Math.min(Math.max(elevationM / 0.1, -1), 1)) < 1e-6, JSON.stringify(heights[k]));
    assert.ok(Math.max(...octaves) - Math.min(...octaves) > 0.1, `the pitch moved by ${Math.max(...octaves) - Math.min(...octaves)} octaves`);
    // What is played is between the newest pitches.
    assert.ok(heights.every(({ playsHz }) => playsHz > 215 && playsHz < 885), JSON.stringify(heights.map(({ playsHz }) => playsHz)));
    await desk.getByTestId("tone").selectOption("");
    await waitForSilence();
  });

  it("keeps the volume, but not that it was on", async () => {
    await desk.getByTestId("slider-volume").fill("40");
    await desk.reload();
    await waitFor(desk, "the page to be live", ({ connectionState }) => connectionState === "live");
    assert.equal(await desk.getByTestId("slider-volume").inputValue(), "40");
    assert.equal(await desk.getByTestId("sound").getAttribute("aria-pressed"), "false");
    await sleep(100);
    assert.equal(await desk.evaluate(() => window.contextCount), 0);
  });
});
