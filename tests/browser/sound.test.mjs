// Sound, in Chromium: off until asked; a splash is heard and calm water is silent; a note follows a gauge; the voices on their own.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { skip, WAIT_MS, waitFor } from "./chromium.mjs";
import { plugGamepad } from "./gamepad.mjs";
import { repository } from "./server.mjs";
import { pixelOf, twoPeople } from "./two_people.mjs";
import { acknowledged, startView } from "./visit.mjs";

/** RMS of the output that counts as silence, and as a splash. */
const kSilentRms = 0.0005;
const kHeardRms = 0.005;

describe("sound of the water", { skip, timeout: 16 * WAIT_MS, concurrency: 1 }, () => {
  let desk;
  let phone;
  let close;

  const splash = async (xM, zM) => desk.mouse.click(...(await pixelOf(desk, xM, zM)));
  const isStill = ({ maxElevationM, minElevationM }) => maxElevationM - minElevationM < 0.004;
  const waitForSilence = () => waitFor(desk, "silence", (stats) => isStill(stats) && stats.sound.levelRms < kSilentRms);

  before(async () => {
    ({ desk, phone, close } = await twoPeople(`${repository}/tests/browser/sound.textproto`, () => {
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
    const still = await waitFor(desk, "the note of still water", ({ sound, ...stats }) => isStill(stats) && sound.tone && sound.levelRms > kHeardRms && Math.abs(Math.log2(sound.tone.playsHz / 440)) < 0.05);
    await waitFor(desk, "a later frame", ({ surfaceTimeS }) => surfaceTimeS > still.surfaceTimeS + 0.3);
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

  it("never reaches full scale, and rings and hisses at the frequencies asked for", async () => {
    const { full, surf, rain, bubble, under } = await desk.evaluate(async () => {
      const { Voices } = await import(performance.getEntriesByType("resource").find(({ name }) => /water_sound.*js$/.test(name)).name);
      const rateHz = 48_000;
      const render = async (play) => {
        const context = new OfflineAudioContext(2, rateHz, rateHz);
        const voices = new Voices(context);
        voices.setVolume(1);
        play(voices);
        const buffer = await context.startRendering();
        const samples = [buffer.getChannelData(0), buffer.getChannelData(1)];
        const late = samples[0].subarray(rateHz / 2);
        const sum = (of) => late.reduce((total, _, n) => total + of(n), 0);
        const square = sum((n) => late[n] ** 2);
        // The mean frequency, weighted by power, from the differences of neighbours.
        const meanHz = n => (rateHz / Math.PI) * Math.asin(Math.min(Math.sqrt(n / 4), 1));
        const first = samples[0].subarray(0, rateHz / 10);
        return {
          peak: Math.max(...samples.map((channel) => channel.reduce((most, sample) => Math.max(most, Math.abs(sample)), 0))),
          isFinite: samples.every((channel) => channel.every(Number.isFinite)),
          rms: Math.sqrt(square / late.length),
          meanHz: meanHz(sum((n) => (n > 0 ? (late[n] - late[n - 1]) ** 2 : 0)) / square),
          ringHz: first.reduce((count, sample, n) => count + Number(n > 0 && first[n - 1] < 0 && sample >= 0), 0) * 10,
        };
      };
      const at = { level: 1, pan: 0, cutoffHz: 18_000 };
      const ring = { ...at, toneLevel: 1, noiseLevel: 0, noiseHz: 1000, rise: 0 };
      return {
        full: await render((voices) => {
          for (let voice = 0; voice < 5; ++voice) voices.playBed(voice, at, 300 + 1000 * voice);
          for (let voice = 0; voice < 7; ++voice) voices.playGrain(voice, { ...ring, noiseLevel: 1, toneHz: 100 + voice, decayS: 5 }, 0);
          voices.playTone(880, 0.1);
        }),
        surf: await render((voices) => voices.playBed(0, at, 300)),
        rain: await render((voices) => voices.playBed(0, at, 5500)),
        under: await render((voices) => {
          voices.setUnder(true);
          voices.playBed(0, at, 5500);
        }),
        bubble: await render((voices) => voices.playGrain(0, { ...ring, toneHz: 1304, decayS: 0.2 }, 0)),
      };
    });
    for (const { peak, isFinite } of [full, surf, rain, bubble]) assert.ok(isFinite && peak < 1, `a peak of ${peak}`);
    assert.ok(full.rms > 0.3, `12 voices: an RMS of ${full.rms}`);
    assert.ok(surf.rms > 0.05 && surf.rms < 0.5, `surf: an RMS of ${surf.rms}`);
    assert.ok(Math.max(surf.rms / rain.rms, rain.rms / surf.rms) < 2, `surf ${surf.rms} and rain ${rain.rms} are as loud`);
    assert.ok(rain.meanHz > 3 * surf.meanHz, `rain at ${rain.meanHz} Hz, surf at ${surf.meanHz} Hz`);
    assert.ok(under.rms < rain.rms / 3, `under water ${under.rms}, above ${rain.rms}`);
    // In a tenth of a second, 18 ms of which are silent.
    assert.ok(Math.abs(bubble.ringHz - 1304 * 0.82) < 60, `a bubble rings ${bubble.ringHz} times`);
  });

  it("is felt on a phone by the finger that splashes, unless that is off", async () => {
    await phone.evaluate(() => {
      window.felt = [];
      navigator.vibrate = (ms) => window.felt.push(ms);
    });
    const tap = async () => {
      await acknowledged(phone, async () => phone.touchscreen.tap(...(await pixelOf(phone, 0, 0))), "the splash");
      return phone.evaluate(() => window.felt.length);
    };
    assert.equal(await tap(), 1);
    await phone.getByTestId("vibration").evaluate((select) => {
      select.value = "off";
      select.dispatchEvent(new Event("change"));
    });
    assert.equal(await tap(), 1);
  });

  it("has gamepads turn and change the view, choose the sound, and shake with their own splash", async () => {
    const press = await plugGamepad(desk);
    const { view } = await waitFor(desk, "a view", (stats) => stats.view !== null);
    await press(8);
    await waitFor(desk, "the next view", (stats) => stats.view !== null && stats.view !== view);
    await desk.evaluate(() => (window.pad.axes[2] = 1));
    await waitFor(desk, "the camera to leave its view", (stats) => stats.view === null);
    await desk.evaluate(() => (window.pad.axes[2] = 0));
    const { sound } = await waitFor(desk, "the sound", () => true);
    await press(9);
    await waitFor(desk, "the sound to change", (stats) => stats.sound.isOn !== sound.isOn);
    await startView(desk);
    // A press of a slow page is a long one, with which a finger would draw.
    await desk.getByTestId("tool-splash").click();
    await press(0);
    await desk.waitForFunction(() => window.effects.length > 0, undefined, { timeout: WAIT_MS });
    await desk.evaluate(() => (navigator.getGamepads = () => []));
    await desk.getByTestId("tool-finger").click();
  });

  it("has gamepads move a slider, choose in a list and press a button of the panels", async () => {
    const press = await plugGamepad(desk);
    const chosen = () =>
      desk.evaluate(() => {
        const one = document.querySelector("[data-chosen]");
        return one && { kind: one.type || one.localName, value: one.value, box: one.getBoundingClientRect().toJSON() };
      });
    const goTo = async (kind, up = false) => {
      for (let k = 0; k < 80; ++k) {
        await press(up ? 12 : 13);
        const one = await chosen();
        if (one?.kind === kind) return one;
      }
      assert.fail(`no ${kind} within 80 presses`);
    };
    const slider = await goTo("range");
    assert.ok(slider.box.bottom <= 720 && slider.box.height > 0, "out of sight");
    await press(15);
    assert.ok(Number((await chosen()).value) > Number(slider.value));
    const list = await goTo("select-one");
    await press(15);
    const isLast = (await chosen()).value === list.value;
    if (isLast) await press(14);
    assert.notEqual((await chosen()).value, list.value);
    await press(isLast ? 15 : 14);
    assert.equal((await chosen()).value, list.value);
    // A presses the button, and the water gets no splash from it.
    const { lastAck } = await waitFor(desk, "the page", () => true);
    await goTo("button", true);
    await desk.evaluate(() => document.activeElement.addEventListener("click", () => (window.pressed = true)));
    await press(0);
    assert.equal(await desk.evaluate(() => window.pressed), true);
    assert.deepEqual((await waitFor(desk, "the page", () => true)).lastAck, lastAck);
    await press(1);
    assert.equal(await chosen(), null);
    await desk.evaluate(() => (navigator.getGamepads = () => []));
    await startView(desk);
  });

  it("draws with Enter and the arrow keys, and zooms with plus", async () => {
    await desk.locator("#view").focus();
    await desk.keyboard.down("Enter");
    for (let k = 0; k < 5; ++k) await desk.keyboard.press("ArrowRight");
    await waitFor(desk, "the dents of a stroke", ({ dents }) => dents > 0);
    await desk.keyboard.up("Enter");
    await desk.keyboard.press("+");
    await waitFor(desk, "the camera to leave its view", ({ view }) => view === null);
  });

  it("keeps the volume, but not that it was on", async () => {
    await desk.getByTestId("slider-volume").fill("40");
    await desk.reload({ timeout: WAIT_MS });
    await waitFor(desk, "the page to be live", ({ connectionState }) => connectionState === "live");
    assert.equal(await desk.getByTestId("slider-volume").inputValue(), "40");
    assert.equal(await desk.getByTestId("sound").getAttribute("aria-pressed"), "false");
    await sleep(100);
    assert.equal(await desk.evaluate(() => window.contextCount), 0);
  });
});
