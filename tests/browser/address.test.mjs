// The page at other addresses than the root: under a path behind a proxy, and what its address holds. A room that does not exist: front.test.mjs.
import assert from "node:assert/strict";
import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { cameraAtRest, launch, skip, WAIT_MS, waitFor } from "./chromium.mjs";
import { startPathProxy } from "./path_proxy.mjs";
import { repository, startServer, temporaryFolder } from "./server.mjs";
import { panelsShown } from "./two_people.mjs";

const slow = { timeout: 4 * WAIT_MS };

describe("the page's address", { skip, concurrency: 1 }, () => {
  const folder = temporaryFolder("address");
  let server;
  let proxy;
  let browser;
  let page;
  let complaints;

  before(async () => {
    // With a bed, which the page asks for by REST.
    writeFileSync(join(folder, "mound.textproto"), "wave { resolution_count: 64 side_m: 8 depth_m: 1 }\nbed { shapes { cone { toe_radius_m: 3 crest_radius_m: 1 height_m: 1.2 } } }\n");
    server = await startServer(0, ["--scene", `${repository}/tests/browser/scene.textproto`, "--room", `mound=${join(folder, "mound.textproto")}`]);
    proxy = await startPathProxy(server.port, "/water/");
    browser = await launch();
  }, slow);
  after(async () => {
    await browser?.close();
    proxy?.close();
    await server?.stop("SIGTERM");
    rmSync(folder, { recursive: true });
  });

  async function open(address) {
    page = await browser.newPage();
    page.setDefaultTimeout(WAIT_MS);
    complaints = [];
    page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
    page.on("pageerror", (error) => complaints.push(error.message));
    await page.goto(address, { timeout: WAIT_MS });
  }

  it("under a path asks for nothing outside it, and shows water and ground of a room", slow, async () => {
    await open("about:blank");
    const ground = page.waitForResponse((answer) => answer.url().endsWith("/ground"), { timeout: WAIT_MS });
    await page.goto(`${proxy.url}?quality=minimal&room=mound`, { timeout: WAIT_MS });
    await waitFor(page, "frames", (stats) => stats.connectionState === "live" && stats.framesReceived.surface > 2);
    assert.equal((await ground).status(), 200);
    assert.deepEqual(proxy.outside, []);
    assert.deepEqual(complaints, []);
    await page.close();
  });

  it("holds the view, the camera and the light, and shows them again elsewhere", slow, async () => {
    const pixels = () => page.evaluate(() => [[0, 0], [1, 0], [0, 1]].map(([xM, zM]) => window.spindrift.pixelOf(xM, zM)));
    const isLive = (stats) => stats.connectionState === "live" && stats.framesReceived.surface > 2;
    await open(`${server.url}?quality=minimal&room=main`);
    await waitFor(page, "frames", isLive);
    await sleep(1500);
    assert.equal(new URL(page.url()).search, "?quality=minimal&room=main", "nothing was chosen yet");
    await page.getByTestId("view-overview").click();
    await page.waitForURL(/view=overview/, { timeout: WAIT_MS });
    await page.locator("#view").focus();
    for (let k = 0; k < 20; ++k) await page.keyboard.press("Shift+ArrowLeft");
    await page.getByTestId("light").selectOption("golden hour");
    await page.waitForURL(/camera=/, { timeout: WAIT_MS });
    await cameraAtRest(page);
    await sleep(2000);
    const { searchParams } = new URL(page.url());
    assert.equal(searchParams.get("light"), "golden-hour");
    assert.equal(searchParams.get("view"), null);
    const [address, shown] = [page.url(), await pixels()];
    await page.close();

    await open(address);
    await waitFor(page, "frames", isLive);
    await waitFor(page, "the camera of the address", (stats) => stats.view === null);
    await cameraAtRest(page);
    const again = await pixels();
    shown.flat().forEach((px, k) => assert.ok(Math.abs(px - again.flat()[k]) < 2, `${JSON.stringify(shown)}, then ${JSON.stringify(again)}`));
    assert.equal(await page.getByTestId("light").inputValue(), "golden hour");
    assert.equal(page.url(), address);
    assert.deepEqual(complaints, []);
    await page.close();
  });

  it("shows a still of a shipped scene until the water is drawn, without buttons before they are named, and the scene's hour", slow, async () => {
    const shipped = await startServer(0, ["--scene", "beach", "--fidelity", "draft"]);
    try {
      await open("about:blank");
      // The page's own code waits.
      let release;
      const held = new Promise((resolve) => (release = resolve));
      await page.route(/water_page-.*\.js$/, async (route) => {
        await held;
        await route.continue();
      });
      await page.goto(`${shipped.url}?quality=minimal`, { timeout: WAIT_MS });
      const poster = page.locator("#poster");
      await poster.waitFor({ state: "visible", timeout: WAIT_MS });
      assert.ok((await poster.evaluate((image) => image.naturalWidth)) > 100);
      const buttons = page.locator("button:visible");
      assert.equal(await buttons.count(), 0);
      assert.ok(!(await page.getByTestId("state").isVisible()));
      release();
      await waitFor(page, "a picture of the water", (stats) => stats.shownTimeS !== null);
      await poster.waitFor({ state: "detached", timeout: WAIT_MS });
      await panelsShown(page);
      assert.ok((await buttons.count()) > 5);
      for (const button of await buttons.all()) assert.ok(await button.evaluate((each) => each.textContent.trim() || each.title || each.getAttribute("aria-label")), await button.evaluate((each) => each.outerHTML));
      assert.equal(await page.getByTestId("light").inputValue(), "automatic");
      const [, hour] = /^first_view .*\bhour: ([\d.]+)/m.exec(readFileSync(`${repository}/server/scenes/beach.textproto`, "utf8"));
      const slider = page.getByTestId("slider-hour");
      assert.ok(Math.abs(Number(await slider.inputValue()) - Number(hour)) <= 0.5 * Number(await slider.getAttribute("step")), `${await slider.inputValue()} h for ${hour} h`);
      assert.deepEqual(complaints, []);
    } finally {
      await page.close();
      await shipped.stop("SIGTERM");
    }
  });
});
