// Links: the Share card, and what a link shows elsewhere.
import assert from "node:assert/strict";
import { rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";

import { kPhone, launch, skip, WAIT_MS } from "./chromium.mjs";
import { measure, shootWater } from "./pixels.mjs";
import { command, repository, startServer, temporaryFolder } from "./server.mjs";

/** A room is opened within seconds, or minutes on a machine that builds at the same time. */
const slow = { timeout: 8 * WAIT_MS };
const kNetworkUrl = "http://192.168.1.20:8080/water";

describe("a shared link", { skip, concurrency: 1 }, () => {
  let server;
  const browsers = [];

  before(async () => {
    server = await startServer(0, ["--scene", `${repository}/tests/browser/scene.textproto`, "--public-url", kNetworkUrl]);
    for (let k = 0; k < 2; ++k) browsers.push(await launch());
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
    page.setDefaultTimeout(WAIT_MS);
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
    await page.getByText("It is copied.").waitFor({ timeout: WAIT_MS });
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

describe("a link with a scene", { skip, concurrency: 1 }, () => {
  const kOperator = "operator-of-the-test";
  let folder;
  let server;
  let browser;

  before(async () => {
    folder = temporaryFolder("links");
    writeFileSync(join(folder, "tokens"), `operator ${kOperator}\n`);
    server = await startServer(0, ["--scene", `${repository}/tests/browser/scene.textproto`, "--tokens-file", join(folder, "tokens"), "--max-rooms", "3"]);
    browser = await launch();
  }, slow);
  after(async () => {
    await browser?.close();
    await server?.stop("SIGTERM");
    rmSync(folder, { recursive: true });
  });

  const ask = async (path, token = "") => (await fetch(`${server.url}api/v1/${path}`, { headers: token ? { Authorization: `Bearer ${token}` } : {} })).json();
  const depthOf = async (room) => (await ask(`rooms/${room}/parameters`)).parameters.find(({ path }) => path === "wave.depth_m").value;
  const roomsNow = async () => (await ask("rooms")).rooms.map(({ name }) => name);
  async function open(address) {
    const page = await browser.newPage({ viewport: { width: 800, height: 500 } });
    page.setDefaultTimeout(WAIT_MS);
    await page.goto(address, { timeout: WAIT_MS });
    return page;
  }
  const state = (page, wanted) => page.waitForFunction((text) => document.querySelector("[data-testid=state]").textContent.includes(text), wanted, { timeout: 4 * WAIT_MS });

  /** The front page says why a room was not opened. */
  const refusal = (page, wanted) => page.waitForFunction((text) => document.querySelector("[data-testid=front-missing]")?.textContent.includes(text), wanted, { timeout: 4 * WAIT_MS });

  it("says to a guest why no room is opened, and which rooms exist", slow, async () => {
    const page = await open(`${server.url}?quality=minimal&scene=still_pool`);
    await refusal(page, "There is no room still_pool: opening a room takes the role of operator");
    assert.equal(new URL(await page.getByTestId("room-main").getAttribute("href")).search, "?quality=minimal&room=main");
    assert.deepEqual(await roomsNow(), ["main"]);
    await page.close();
  });

  it("opens the room for an operator, and leads all others into it", slow, async () => {
    const link = `${server.url}?quality=minimal&scene=wave_only&set=wave.depth_m:1.25`;
    const operator = await open(`${link}#token=${kOperator}`);
    await state(operator, "live");
    const [, room] = await roomsNow();
    assert.match(room, /^wave_only-[0-9a-f]{8}$/);
    assert.equal(await depthOf(room), 1.25);
    assert.deepEqual((await ask(`rooms/${room}/changes`)).parameters.map(({ path, value }) => [path, value]), [["wave.depth_m", 1.25]]);
    const guest = await open(link);
    await state(guest, "live");
    assert.equal((await ask(`rooms/${room}`)).session_count, 2);

    // A link with other values to a room that exists changes nothing, even for an operator.
    const again = await open(`${server.url}?quality=minimal&room=${room}&scene=wave_only&set=wave.depth_m:0.5#token=${kOperator}`);
    await state(again, "live");
    assert.equal(await depthOf(room), 1.25);
    for (const page of [operator, guest, again]) await page.close();
  });

  it("holds what an operator changes, and opens no room beyond the limit or with impossible values", slow, async () => {
    const page = await open(`${server.url}?quality=minimal&room=main#token=${kOperator}`);
    await state(page, "live");
    const deeper = { set_parameter: { path: "wave.depth_m", value: 1.25 } };
    assert.equal((await command(server, deeper, { token: kOperator })).status, 200);
    await page.waitForURL(/set=wave\.depth_m:1\.25/, { timeout: WAIT_MS });
    const { searchParams } = new URL(page.url());
    assert.deepEqual([searchParams.get("room"), searchParams.get("scene"), searchParams.get("set")], ["main", "browser_test", "wave.depth_m:1.25"]);
    assert.ok(!page.url().includes("token"), page.url());
    await page.close();

    const wrong = await open(`${server.url}?quality=minimal&scene=pool&set=wave.depth_m:-1#token=${kOperator}`);
    await refusal(wrong, "wave.depth_m");
    await refusal(wrong, "There is no room pool-");
    await wrong.close();
  });

  it("gives the role that an operator chose for it", slow, async () => {
    const operator = await open(`${server.url}?quality=minimal&room=main#token=${kOperator}`);
    await state(operator, "live");
    await operator.getByTestId("share").click();
    await operator.getByTestId("share-target").selectOption("roles");
    await operator.getByRole("button", { name: "Open the room" }).click();
    await operator.getByTestId("share-role").waitFor({ timeout: 4 * WAIT_MS });
    const links = {};
    for (const role of ["operator", "player", "viewer", "kiosk"]) {
      await operator.getByTestId("share-role").selectOption(role);
      links[role] = await operator.getByTestId("share-link").inputValue();
      assert.ok(new URL(links[role]).hash.startsWith("#token=") && !new URL(links[role]).search.includes("token"), links[role]);
    }
    await operator.close();
    assert.equal(new URL(links.kiosk).searchParams.get("kiosk"), "60");
    assert.equal(new URL(links.kiosk).hash, new URL(links.player).hash);
    const kiosk = await open(links.kiosk);
    await kiosk.waitForFunction(() => window.spindrift?.stats().role === "player" && window.spindriftKiosk?.stats().phase === "attract", undefined, { timeout: WAIT_MS });
    assert.ok(!(await kiosk.locator("#panel, #actions").first().isVisible()));
    await kiosk.close();
    for (const role of ["operator", "player", "viewer"]) {
      const page = await open(links[role]);
      await page.waitForFunction((wanted) => window.spindrift?.stats().role === wanted && window.spindrift.stats().connectionState === "live", role, { timeout: WAIT_MS });
      await page.close();
    }

    const late = await open(`${server.url}?quality=minimal&scene=pool#token=${kOperator}`);
    await refusal(late, "There is no room pool: the limit of 3 rooms is reached");
    await late.close();
  });
});
