// Links: the Share card, and what a link shows elsewhere.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { after, before, describe, it } from "node:test";

import { chromium } from "playwright-core";

import { executable, kChromiumArgs } from "./chromium.mjs";
import { measure, shootWater } from "./pixels.mjs";
import { repository, startServer } from "./server.mjs";

const WAIT_MS = 60_000;
const skip = existsSync(executable) ? false : `Chromium is missing (${executable}); set CHROMIUM or install it`;
const slow = { timeout: 4 * WAIT_MS };
const kNetworkUrl = "http://192.168.1.20:8080/water";
const kPhone = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 1 };

describe("a shared link", { skip, concurrency: 1 }, () => {
  let server;
  const browsers = [];

  before(async () => {
    server = await startServer(0, ["--scene", `${repository}/tests/browser/scene.textproto`, "--public-url", kNetworkUrl]);
    for (let k = 0; k < 2; ++k) browsers.push(await chromium.launch({ executablePath: executable, args: kChromiumArgs }));
  }, slow);
  after(async () => {
    for (const browser of browsers) await browser.close();
    await server?.stop("SIGTERM");
  });

  /** Waits until the page's numbers are as wanted. */
  async function waitFor(page, what, accept, argument) {
    await page.waitForFunction(accept, argument, { timeout: WAIT_MS, polling: 100 }).catch(async (error) => {
      assert.fail(`waited for ${what}: ${error.message}: ${JSON.stringify(await page.evaluate(() => window.spindrift?.stats()))}`);
    });
  }

  async function open(browser, address, options = { viewport: { width: 800, height: 500 } }) {
    const page = await browser.newPage(options);
    await page.goto(address, { timeout: WAIT_MS });
    await waitFor(page, "frames", () => window.spindrift?.stats().framesReceived.surface > 2);
    return page;
  }

  /** The card's link on this machine; that of the network leads nowhere in a test. */
  async function sharedLink(page) {
    await page.getByTestId("share").click();
    await page.waitForFunction((start) => document.querySelector("[data-testid=share-link]")?.value.startsWith(start), kNetworkUrl, { timeout: WAIT_MS });
    return page.getByTestId("share-link").inputValue();
  }
  const onThisMachine = (link) => server.url + new URL(link).search;

  it("shows the same picture in another browser: camera, light, look and water of one paused tick", slow, async () => {
    const first = await open(browsers[0], `${server.url}?quality=minimal`);
    await first.getByTestId("look").selectOption("height");
    await first.getByTestId("light").selectOption("dusk");
    await first.locator("#view").focus();
    for (let k = 0; k < 9; ++k) await first.keyboard.press("Shift+ArrowLeft");
    await first.waitForURL(/camera=/, { timeout: WAIT_MS }); // written when the camera is at rest
    await first.getByTestId("splash").click();
    await waitFor(first, "the splash", () => window.spindrift.stats().maxElevationM > 0.02);
    await first.getByTestId("pause").click();
    await waitFor(first, "the pause", () => window.spindrift.stats().paused);
    const link = await sharedLink(first);
    for (const part of ["camera=", "light=dusk", "look=height", "quality=minimal"]) assert.ok(link.includes(part), `${part} in ${link}`);
    await first.getByTestId("share-close").click();

    const second = await open(browsers[1], onThisMachine(link));
    await waitFor(second, "the camera of the link", () => window.spindrift.stats().view === null);
    const timeS = (page) => page.evaluate(() => window.spindrift.stats().surfaceTimeS);
    await waitFor(second, "the tick of the first browser", (wantedS) => window.spindrift.stats().surfaceTimeS === wantedS, await timeS(first));
    for (const page of [first, second]) await page.addStyleTag({ content: "body > :not(#view) { display: none !important; }" });
    let found;
    // The picture follows the last frame within its playout delay.
    for (const begin = Date.now(); Date.now() - begin < WAIT_MS; ) {
      found = await measure(first, await shootWater(first), await shootWater(second));
      if (found.changed_ratio < 0.002) break;
    }
    assert.ok(found.changed_ratio < 0.002, JSON.stringify(found));
    assert.ok(found.colour_count > 20 && found.deviation > 2, `the picture shows something: ${JSON.stringify(found)}`);

    await second.locator("#view").focus();
    for (let k = 0; k < 9; ++k) await second.keyboard.press("Shift+ArrowLeft");
    await second.waitForURL((url) => url.search !== new URL(link).search, { timeout: WAIT_MS });
    const moved = await measure(first, await shootWater(first), await shootWater(second));
    assert.ok(moved.changed_ratio > 0.02, `another camera shows another picture: ${JSON.stringify(moved)}`);
    await first.close();
    await second.close();
  });

  it("has the address in the network, and is copied", slow, async () => {
    const context = await browsers[0].newContext({ permissions: ["clipboard-read", "clipboard-write"] });
    const page = await open(context, `${server.url}?quality=minimal&light=dusk`);
    const link = await sharedLink(page);
    assert.equal(link, `${kNetworkUrl}/?quality=minimal&light=dusk`);
    assert.equal(await page.getByTestId("share-qr").getAttribute("data-address"), link);
    await page.getByTestId("share-copy").click();
    await page.getByText("The link is copied.").waitFor({ timeout: WAIT_MS });
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), link);
    await page.keyboard.press("Escape");
    assert.ok(await page.getByTestId("share-card").isHidden());
    await context.close();
  });

  it("goes to other programs of a phone, by touch", slow, async () => {
    const context = await browsers[0].newContext(kPhone);
    await context.addInitScript(() => void (navigator.share = ({ url }) => void (window.sharedUrl = url)));
    const page = await open(context, `${server.url}?quality=minimal`);
    await page.getByTestId("share").tap();
    await page.waitForFunction((start) => document.querySelector("[data-testid=share-link]")?.value.startsWith(start), kNetworkUrl, { timeout: WAIT_MS });
    for (const name of ["share", "share-copy", "share-send", "share-close"]) {
      const { x, y, width, height } = await page.getByTestId(name).boundingBox();
      assert.ok(width >= 44 && height >= 44 && x >= 0 && x + width <= 390 && y + height <= 844, `${name}: ${width} x ${height} at ${x}, ${y}`);
    }
    await page.getByTestId("share-send").tap();
    assert.equal(await page.evaluate(() => window.sharedUrl), await page.getByTestId("share-link").inputValue());
    await page.getByTestId("share-close").tap();
    assert.ok(await page.getByTestId("share-card").isHidden());
    await context.close();
  });
});
