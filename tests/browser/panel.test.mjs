// The panel, in Chromium: a sheet on a phone with controls for fingers, lines about what others did, and files of the picture.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, describe, it } from "node:test";

import { skip, WAIT_MS, waitFor } from "./chromium.mjs";
import { unfolded } from "./panel.mjs";
import { repository } from "./server.mjs";
import { twoPeople } from "./two_people.mjs";
import { pressed } from "./visit.mjs";

const kFingerPx = 44;

describe("the panel", { skip, timeout: 10 * WAIT_MS, concurrency: 1 }, () => {
  let desk;
  let phone;
  let close;

  before(async () => {
    ({ desk, phone, close } = await twoPeople(`${repository}/tests/browser/floaters.textproto`));
  });
  after(() => close?.());

  const sheetTop = () => phone.locator("#panel").evaluate((panel) => panel.getBoundingClientRect().top);
  const isOpen = () => phone.locator("#panel-toggle").getAttribute("aria-expanded").then((value) => value === "true");
  const settled = (open) => phone.waitForFunction((wanted) => document.querySelector("#panel-toggle").getAttribute("aria-expanded") === String(wanted), open, { timeout: WAIT_MS });

  it("keeps numbers, parameters and fidelity behind More", async () => {
    for (const testId of ["sim-time", "fidelity", "detail", "quality"]) assert.ok(!(await desk.getByTestId(testId).isVisible()), `${testId} shows at first`);
    await unfolded(desk.getByTestId("sim-time"));
    assert.ok(await desk.getByTestId("sim-time").isVisible());
  });

  it("is a sheet on a phone that leaves most of the water free, and the upper half when it is open", async () => {
    assert.ok(!(await isOpen()));
    assert.ok((await sheetTop()) > 0.8 * 844, "closed it has the handle and what one does");
    assert.ok(await phone.getByTestId("splash").isVisible());
    assert.ok(!(await phone.getByTestId("view-side").isVisible()));
    await phone.locator("#panel-toggle").tap();
    await settled(true);
    await phone.waitForFunction(() => document.querySelector("#tools").getBoundingClientRect().top >= innerHeight / 2, undefined, { timeout: WAIT_MS });
    assert.ok((await sheetTop()) > 422, "the upper half is free");
    await phone.locator("#panel-toggle").tap();
    await settled(false);
  });

  it("follows a finger on its handle", async () => {
    const touch = await phone.context().newCDPSession(phone);
    const send = (type, y) => touch.send("Input.dispatchTouchEvent", { type, touchPoints: y === undefined ? [] : [{ id: 1, x: 195, y }] });
    // The handle follows the sheet a picture later.
    const handleAtSheet = () => phone.waitForFunction(() => Math.abs(document.querySelector("#panel-toggle").getBoundingClientRect().top - document.querySelector("#panel").getBoundingClientRect().top) < 24, undefined, { timeout: WAIT_MS });
    await handleAtSheet();
    const box = await phone.locator("#panel-toggle").boundingBox();
    const handleY = box.y + box.height / 2;
    for (const [toY, open] of [[380, true], [820, false]]) {
      await handleAtSheet();
      const top = await phone.locator("#panel-toggle").boundingBox().then(({ y, height }) => y + height / 2);
      await send("touchStart", top);
      for (let k = 1; k <= 8; ++k) await send("touchMove", top + ((toY - top) * k) / 8);
      // Moves arrive with the next picture: it comes under the finger.
      if (open) await phone.waitForFunction((y) => Math.abs(document.querySelector("#panel").getBoundingClientRect().top - y) < 60, toY, { timeout: WAIT_MS });
      await send("touchEnd");
      await settled(open);
    }
    await phone.waitForFunction((y) => Math.abs(document.querySelector("#panel-toggle").getBoundingClientRect().top + 22 - y) < 3, handleY, { timeout: WAIT_MS });
  });

  it("has controls for fingers: at least 44 px wide and high", async () => {
    await phone.locator("#panel-toggle").tap();
    await settled(true);
    const small = await phone.evaluate((least) => {
      for (const box of document.querySelectorAll("details")) if (!box.hidden) box.open = true;
      const controls = [...document.querySelectorAll("button, select, input, summary, a[href]")].filter((each) => each.checkVisibility({ visibilityProperty: true }));
      const named = (each) => `${each.id || each.dataset.testid || each.textContent}: ${each.offsetWidth} x ${each.offsetHeight}`;
      return { count: controls.length, found: controls.filter((each) => each.offsetWidth < least || each.offsetHeight < least).map(named) };
    }, kFingerPx);
    assert.deepEqual(small.found, []);
    assert.ok(small.count > 30, `${small.count} controls`);
    await phone.locator("#panel-toggle").tap();
    await settled(false);
  });

  it("says who paused the water, to the others only", async () => {
    const name = await phone.evaluate(() => [...document.querySelectorAll("#people li")].find((row) => !row.textContent.includes("you"))?.querySelector("b").textContent);
    await desk.getByTestId("pause").click();
    await waitFor(phone, "the pause", ({ paused }) => paused);
    await phone.getByTestId("toast").filter({ hasText: `${name} paused the water.` }).waitFor({ timeout: WAIT_MS });
    assert.equal(await phone.getByTestId("state").textContent(), "paused");
    await desk.getByTestId("pause").click();
    await waitFor(desk, "the end of the pause", ({ paused }) => !paused);
    assert.equal(await desk.getByTestId("toast").textContent(), "");
  });

  it("says nothing of a splash that worked", async () => {
    await pressed(desk, "splash");
    assert.equal(await desk.getByTestId("toast").textContent(), "");
  });

  it("saves a picture with all pixels of the window", async () => {
    const download = desk.waitForEvent("download", { timeout: WAIT_MS });
    await desk.getByTestId("picture").click();
    const file = await download;
    assert.match(file.suggestedFilename(), /^spindrift-floaters-\d{4}-\d\d-\d\d-\d{6}\.png$/);
    const bytes = await readFile(await file.path());
    assert.deepEqual([bytes.readUInt32BE(16), bytes.readUInt32BE(20)], [900, 600]);
    assert.ok(bytes.length > 50_000, `${bytes.length} bytes: an empty picture is smaller`);
  });

  it("saves a film that a browser plays", async () => {
    const film = desk.getByTestId("film");
    await film.click();
    await film.filter({ hasText: /^[1-9]\d* s$/ }).waitFor({ timeout: WAIT_MS });
    const download = desk.waitForEvent("download", { timeout: WAIT_MS });
    await film.click();
    const file = await download;
    assert.match(file.suggestedFilename(), /^spindrift-floaters-[\d-]+\.(mp4|webm)$/);
    const bytes = await readFile(await file.path());
    const player = await desk.context().newPage();
    const seen = await player.evaluate(async ([base64, type]) => {
      const video = document.createElement("video");
      video.src = URL.createObjectURL(new Blob([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], { type }));
      video.muted = true;
      await new Promise((loaded, failed) => {
        video.onloadeddata = loaded;
        video.onerror = () => failed(new Error(video.error.message));
      });
      return { durationS: video.duration, widthPx: video.videoWidth };
    }, [bytes.toString("base64"), file.suggestedFilename().endsWith("mp4") ? "video/mp4" : "video/webm"]);
    await player.close();
    assert.ok(seen.durationS > 0.8 && seen.durationS < 60, `${seen.durationS} s`);
    assert.equal(seen.widthPx, 584, "0.65 pixels per pixel of the window at quality minimal, even");
    assert.equal(await film.getAttribute("aria-pressed"), "false");
  });
});
