// The front page of a server with several rooms.
import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";

import { kPhone, launch, skip, until, WAIT_MS } from "./chromium.mjs";
import { command, ended, post, repository, startServer } from "./server.mjs";

const slow = { timeout: 8 * WAIT_MS };
const kScenes = `${repository}/tests/browser`;
const kDesk = { viewport: { width: 1280, height: 720 } };

describe("the front page", { skip, concurrency: 1 }, () => {
  let server;
  let browser;
  const complaints = [];

  before(async () => {
    server = await startServer(0, ["--scene", `${kScenes}/scene.textproto`, "--room", `marina=${kScenes}/marina.textproto`, "--room", `sea=${kScenes}/sea.textproto`]);
    browser = await launch();
  }, slow);
  after(() => ended(browser, server));

  async function open(query = "", options = kDesk, first = () => {}) {
    const page = await browser.newPage(options);
    page.setDefaultTimeout(WAIT_MS);
    page.on("pageerror", (error) => complaints.push(error.message));
    await page.addInitScript(first);
    await page.goto(`${server.url}${query}`, { timeout: WAIT_MS });
    return page;
  }

  const ask = async (path, init) => fetch(`${server.url}api/v1/${path}`, init);
  const sessionsIn = async (room) => (await (await ask(`rooms/${room}`)).json()).session_count;
  const splash = async (room) => assert.equal((await command(server, { splash: { x_m: 1, z_m: 0.5, radius_m: 1, depth_m: 0.3 } }, { room })).status, 200);

  const sessions = (what, wanted) => until(what, () => Promise.all(Object.keys(wanted).map(sessionsIn)), (counts) => Object.values(wanted).every((count, k) => counts[k] === count));
  /** A busy server answers 504 and opens the room a little later. */
  const openRoom = async (name) => {
    const { status } = await post(server, "api/v1/rooms", { name, scene: "wave_only" });
    assert.ok([201, 504].includes(status), `status ${status}`);
    await until(`the room ${name}`, async () => (await ask(`rooms/${name}`)).status, (answer) => answer === 200);
  };
  const textOf = (page, room) => until(`the card of ${room}`, () => page.getByTestId(`room-${room}`).innerText().catch(() => ""), (text) => text !== "");
  const isWater = (page, room) => page.waitForFunction((name) => location.search.includes(`room=${name}`) && window.spindrift?.stats().connectionState === "live", room, { timeout: WAIT_MS });
  /** The card's picture as text; undefined before the first one. */
  const picture = (page, room) => page.evaluate((name) => {
    const canvas = document.querySelector(`[data-testid="room-${name}"] canvas`);
    return canvas && !canvas.hidden ? canvas.toDataURL() : undefined;
  }, room);

  it("shows live pictures of all rooms, and the people in them without itself", slow, async () => {
    const page = await open("?quality=minimal");
    for (const room of ["main", "marina", "sea"]) await until(`the picture of ${room}`, () => picture(page, room), (now) => now !== undefined);
    for (const room of ["main", "marina"]) {
      const still = await picture(page, room);
      await splash(room);
      const moved = await until(`waves in ${room}`, () => picture(page, room), (now) => now !== still);
      await until(`other waves in ${room}`, () => picture(page, room), (now) => now !== moved && now !== still);
    }
    assert.deepEqual(await Promise.all(["main", "marina", "sea"].map(sessionsIn)), [1, 1, 1]);
    assert.match(await textOf(page, "main"), /Browser test[\s\S]*nobody in it[\s\S]*running[\s\S]*Open/);

    const visitor = await open("?quality=minimal&room=main");
    await isWater(visitor, "main");
    await until("the visitor", () => textOf(page, "main"), (text) => text.includes("1 person"));
    assert.match(await textOf(page, "marina"), /nobody in it/);
    const another = await open("?quality=minimal");
    await sessions("both front pages and the visitor", { main: 3, marina: 2 });
    assert.equal((await (await ask("rooms/main/people")).json()).people.length, 1, "front pages are nobody of the room");
    assert.match(await textOf(another, "main"), /1 person/);
    await another.close();
    await visitor.getByTestId("pause").click();
    await until("the pause", () => textOf(page, "main"), (text) => text.includes("paused"));
    await visitor.getByTestId("pause").click();
    await visitor.close();
    await until("the visitor's leave", () => textOf(page, "main"), (text) => text.includes("nobody in it") && text.includes("running"));
    await page.close();
    await sessions("nobody", { main: 0, marina: 0, sea: 0 });
  });

  it("connects to no room that is not in the window, and to none while the page is hidden", slow, async () => {
    const page = await open("", { viewport: { width: 390, height: 480 } });
    await until("a picture", () => picture(page, "main"), (now) => now !== undefined);
    await sessions("the first card", { main: 1, sea: 0 });
    await page.evaluate(() => document.querySelector("[data-testid=room-sea]").scrollIntoView({ block: "end" }));
    await sessions("the last card", { main: 0, sea: 1 });

    await page.evaluate(() => {
      Object.defineProperty(document, "hidden", { configurable: true, value: true });
      document.dispatchEvent(new Event("visibilitychange"));
    });
    await sessions("a hidden page", { main: 0, marina: 0, sea: 0 });
    await page.evaluate(() => {
      delete document.hidden;
      document.dispatchEvent(new Event("visibilitychange"));
    });
    await sessions("the page shown again", { main: 0, sea: 1 });
    await page.close();
  });

  it("opens a room by keyboard and by touch, with the other choices of the address", slow, async () => {
    const page = await open("?quality=minimal&light=dusk&view=side");
    await textOf(page, "marina");
    await page.getByTestId("room-marina").focus();
    await page.keyboard.press("Enter");
    await isWater(page, "marina");
    assert.equal(new URL(page.url()).search, "?quality=minimal&light=dusk&room=marina");
    await page.goBack();
    await textOf(page, "marina");
    await page.close();

    const phone = await open("?quality=minimal", kPhone);
    await textOf(phone, "main");
    for (const box of await Promise.all((await phone.locator(".front-open:visible, .front-card:visible").all()).map((each) => each.boundingBox()))) assert.ok(box.width >= 44 && box.height >= 44 && box.x >= 0 && box.x + box.width <= 390, JSON.stringify(box));
    await phone.getByTestId("room-main").getByText("Open").tap();
    await isWater(phone, "main");
    await phone.close();
  });

  it("shows a room that is opened, and no longer one that is closed, also to those who are in it", slow, async () => {
    const page = await open();
    await textOf(page, "sea");
    await until("the operator's card", () => page.getByTestId("front-open").isVisible(), (isVisible) => isVisible);
    await page.getByTestId("front-scene").selectOption("still_pool");
    const link = new URL(await page.getByTestId("front-open-room").getAttribute("href"));
    assert.equal(link.search, "?scene=still_pool");
    await openRoom("guest");
    await textOf(page, "guest");
    const visitor = await open("?quality=minimal&room=guest");
    await isWater(visitor, "guest");
    assert.ok((await ask("rooms/guest", { method: "DELETE" })).ok);
    await page.getByTestId("room-guest").waitFor({ state: "detached", timeout: WAIT_MS });
    await textOf(visitor, "main");
    assert.equal(await visitor.getByTestId("front-missing").innerText(), "The room was closed.");
    for (const each of [page, visitor]) await each.close();
  });

  it("is where a room that does not exist leads, which it says, until the room is there", slow, async () => {
    const page = await open("?quality=minimal&room=nope", kPhone);
    await textOf(page, "main");
    assert.equal(await page.getByTestId("front-missing").innerText(), "There is no room nope. These are the rooms of this server.");
    assert.equal(new URL(await page.getByTestId("room-sea").getAttribute("href")).search, "?quality=minimal&room=sea");
    await openRoom("nope");
    await textOf(page, "nope");
    assert.ok(await page.getByTestId("front-missing").isHidden());
    await page.getByTestId("room-nope").tap();
    await isWater(page, "nope");
    await page.close();
    assert.ok((await ask("rooms/nope", { method: "DELETE" })).ok);
  });

  it("needs no WebGL, and says when the list of rooms is old", slow, async () => {
    const page = await open("", kDesk, () => {
      const { getContext } = HTMLCanvasElement.prototype;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return kind.startsWith("webgl") ? null : getContext.call(this, kind, ...rest);
      };
    });
    await until("a picture", () => picture(page, "main"), (now) => now !== undefined);
    const list = /api\/v1\/rooms$/;
    await page.route(list, (route) => route.abort());
    await page.getByTestId("front-failed").filter({ hasText: "the server does not answer" }).waitFor({ timeout: WAIT_MS });
    assert.ok(await page.getByTestId("front-retry").isVisible());
    await page.unroute(list);
    // It is asked for again by itself, perhaps before this press.
    await page.getByTestId("front-retry").evaluate((button) => button.click());
    await page.getByTestId("front-failed").waitFor({ state: "hidden", timeout: WAIT_MS });
    await page.close();
    assert.deepEqual(complaints, []);
  });
});
