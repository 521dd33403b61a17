// Rooms in the page of another origin by <spindrift-water>: what that page may do, and what no other page may.
import assert from "node:assert/strict";
import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { kPhone, launch, skip, until, WAIT_MS } from "./chromium.mjs";
import { measure } from "./pixels.mjs";
import { repository, startServer, temporaryFolder } from "./server.mjs";

const slow = { timeout: 4 * WAIT_MS };
const kTokens = { viewer: "a-viewer-of-the-test", player: "a-player-of-the-test" };
const kScene = `${repository}/tests/browser/scene.textproto`;

/** Serves HTML by path on a port of its own: another origin. */
async function startPages() {
  const pages = new Map();
  const http = createServer(({ url }, answer) => {
    const html = url === "/favicon.ico" ? "" : pages.get(url.split("?")[0]);
    answer.writeHead(html === undefined ? 404 : 200, { "Content-Type": "text/html" }).end(html);
  });
  http.listen(0, "127.0.0.1");
  await new Promise((resolve) => http.on("listening", resolve));
  const close = () => {
    http.close();
    http.closeAllConnections();
  };
  return { url: `http://127.0.0.1:${http.address().port}`, pages, close };
}

describe("a page of another origin", { skip, concurrency: 1 }, () => {
  const folder = temporaryFolder("embed");
  let listed;
  let hostile;
  let server;
  let browser;
  let page;
  /** What the browser has said on the console. */
  let said;

  before(async () => {
    [listed, hostile] = [await startPages(), await startPages()];
    writeFileSync(join(folder, "tokens"), Object.entries(kTokens).map(([role, token]) => `${role} ${token}\n`).join(""));
    server = await startServer(0, ["--scene", kScene, "--room", `second=${kScene}`, "--embed", listed.url, "--tokens-file", join(folder, "tokens"), "--guests", "operator"]);
    listed.pages.set("/element", withElement('room="main"'));
    browser = await launch();
  }, slow);
  after(async () => {
    await browser?.close();
    for (const each of [listed, hostile]) each?.close();
    await server?.stop("SIGTERM");
    rmSync(folder, { recursive: true });
  });

  async function open(address, options = {}) {
    await page?.close();
    page = await browser.newPage({ viewport: { width: 1280, height: 720 }, ...options });
    page.setDefaultTimeout(WAIT_MS);
    said = [];
    page.on("console", (message) => said.push(`${message.type()}: ${message.text()}`));
    page.on("pageerror", (error) => said.push(`uncaught: ${error.message}`));
    await page.goto(address, { timeout: WAIT_MS });
  }
  const errors = () => said.filter((line) => /^(error|uncaught)/.test(line));

  /** A page with the element, which keeps its events in `events`. */
  function withElement(attributes) {
    return `<!doctype html><script type="module" src="${server.url}element.js"></script>
      <spindrift-water quality="minimal" style="width: 640px" ${attributes}></spindrift-water>
      <script>
        window.events = [];
        const water = document.querySelector("spindrift-water");
        for (const kind of ["ready", "connected", "disconnected", "frame", "people", "error"]) water.addEventListener(kind, ({ detail }) => events.push({ kind, atMs: performance.now(), ...detail }));
      </script>`;
  }
  const eventsOf = (kind) => page.evaluate((wanted) => window.events.filter((event) => event.kind === wanted), kind);
  const connectedAs = (role) => until(`the room, as ${role}`, () => eventsOf("connected"), (events) => events.at(-1)?.role === role);
  /** Returns the tick, or the refusal. */
  const ask = (method, ...args) => page.evaluate(([name, given]) => document.querySelector("spindrift-water")[name](...given).then(({ tick }) => tick, (error) => error.message), [method, args]);
  const waterFrames = () => page.frames().filter((frame) => frame.url().startsWith(server.url));
  const frameOf = (room) => until(`the frame of ${room}`, () => waterFrames().find((frame) => new URL(frame.url()).searchParams.get("room") === room), (frame) => frame !== undefined);
  const statsOf = (frame) => frame.evaluate(() => window.spindrift?.stats());
  const parametersOf = async (room) => (await (await fetch(`${server.url}api/v1/rooms/${room}/parameters`)).json()).parameters;

  for (const [name, options] of [["a window", {}], ["a phone", kPhone]]) {
    it(`shows two rooms in ${name}, and its own sliders change the water`, slow, async () => {
      listed.pages.set("/", readFileSync(`${repository}/web-client/element/example.html`, "utf8"));
      await open(`${listed.url}/?quality=minimal&server=${server.url}`, options);
      const news = page.locator(".news");
      for (const at of [0, 1]) await until("news of the room", () => news.nth(at).textContent(), (text) => /as operator · \d+ here · \d/.test(text));
      for (const at of [0, 1]) {
        const basin = page.locator("spindrift-water").nth(at);
        await basin.scrollIntoViewIfNeeded();
        const { deviation, colour_count } = await until("a picture of water", async () => measure(page, await basin.screenshot({ timeout: WAIT_MS })), ({ colour_count: count }) => count > 8);
        assert.ok(deviation > 4, `basin ${at}: deviation ${deviation}, ${colour_count} colours`);
      }
      const second = await frameOf("second");
      assert.ok(await second.locator("#panel").isHidden());
      assert.ok(await second.locator("#card").isHidden());
      const before = await statsOf(second);
      await page.locator("#size").fill("1.5");
      await until("the slider's splash", () => statsOf(second), (stats) => stats.maxElevationM - stats.minElevationM > 0.1 + before.maxElevationM - before.minElevationM);
      // Shallower: a busy server refuses what makes its ticks slower.
      const depthM = options.hasTouch ? 0.7 : 1;
      const moved = async () => {
        await page.locator("#depth").fill(String(depthM));
        const depth = (await parametersOf("main")).find(({ path }) => path === "wave.depth_m");
        return [depth.value, ...(await page.locator(".refusal").allTextContents())];
      };
      await until("the slider's depth", moved, ([value]) => value === depthM);
      // By hand, in the water.
      const commandId = (await statsOf(second)).lastAck.commandId;
      const basin = page.locator("spindrift-water").nth(1);
      await basin.scrollIntoViewIfNeeded();
      if (!options.hasTouch) {
        await basin.hover();
        await page.mouse.wheel(0, 200);
        await sleep(500);
        assert.equal((await statsOf(second)).view, "overview", "the wheel belongs to the page around");
      }
      await (options.hasTouch ? basin.tap() : basin.click());
      await until("one's own splash", () => statsOf(second), (stats) => stats.lastAck.commandId > commandId);
      if (!options.hasTouch) {
        await page.mouse.wheel(0, 200);
        await until("the wheel to zoom after a click", () => statsOf(second), ({ view }) => view === null);
      }
      assert.equal(new URL(second.url()).search, "?embed&room=second&view=overview&quality=minimal", "the frame writes no address");
      assert.ok(await second.locator("#toast.shown").count() === 0, "no toast of success");
      assert.deepEqual(errors(), []);
    });
  }

  it("gets events of the water, at most four frames per second", slow, async () => {
    await open(`${listed.url}/element`);
    await connectedAs("operator");
    const [{ room, scene, title }] = (await eventsOf("connected")).slice(-1);
    assert.deepEqual({ room, scene, title }, { room: "main", scene: "browser_test", title: "Browser test" });
    const frames = await until("frames", () => eventsOf("frame"), (events) => events.length >= 24);
    const [first, last] = [frames[1], frames.at(-1)];
    assert.ok(last.tick > first.tick && last.timeS > first.timeS, JSON.stringify(frames));
    // From the page's own beginning: a busy machine hands late events over together.
    assert.ok(frames.length <= 2 + last.atMs / 250, `${frames.length} frames: ${JSON.stringify(frames)}`);
    assert.ok((await until("people", () => eventsOf("people"), (events) => events.length > 0)).at(-1).count >= 1);
    assert.deepEqual(errors(), []);
  });

  it("may do what its visitor may, and no more", slow, async () => {
    listed.pages.set("/viewer", withElement(`room="main" token="${kTokens.viewer}"`));
    await open(`${listed.url}/viewer`);
    await connectedAs("viewer");
    for (const [method, ...args] of [["splash", { xM: 0, zM: 0 }], ["wave"], ["pause"], ["step"], ["set", "wave.depth_m", 1]]) {
      assert.match(String(await ask(method, ...args)), /player|operator/, method);
    }
    listed.pages.set("/player", withElement(`room="main" token="${kTokens.player}"`));
    await open(`${listed.url}/player`);
    await connectedAs("player");
    assert.ok(Number.isInteger(await ask("splash", { xM: 1, zM: 1 })));
    assert.ok(Number.isInteger(await ask("wave")));
    for (const [method, ...args] of [["pause"], ["step"], ["set", "wave.depth_m", 1]]) assert.match(String(await ask(method, ...args)), /operator/, method);
    await open(`${listed.url}/element`);
    await connectedAs("operator");
    assert.ok(Number.isInteger(await ask("pause")));
    assert.ok(Number.isInteger(await ask("step", 3)));
    assert.ok(Number.isInteger(await ask("pause", false)));
    assert.match(await ask("set", "wave.depth_m", -1), /minimum of 0.05 m/);
    assert.match(await ask("set", "no.such", 1), /no parameter of this name/);
  });

  it("is warned of malformed messages, which are ignored", slow, async () => {
    await open(`${listed.url}/element`);
    await connectedAs("operator");
    await page.evaluate((origin) => {
      const target = document.querySelector("spindrift-water").shadowRoot.querySelector("iframe").contentWindow;
      for (let i = 0; i < 500; ++i) {
        for (const data of [{ spindrift: 1, kind: "pause", id: i, paused: "yes" }, { spindrift: 9, kind: "pause", id: i, paused: true }, { spindrift: 1, kind: "close" }, "pause", null, i]) target.postMessage(data, origin);
      }
    }, server.url);
    const [first] = await until("a warning", () => eventsOf("error"), (events) => events.length > 0);
    assert.match(first.message, /a message was ignored: pause: paused "yes"/);
    assert.ok(Number.isInteger(await ask("splash", { xM: 0, zM: 0 })), "requests are still carried out");
    const warnings = said.filter((line) => line.startsWith("warning: spindrift:"));
    assert.ok(warnings.length <= 5, `bounded: ${warnings.length}`);
    assert.equal((await statsOf(await frameOf("main"))).paused, false);
  });

  it("that is not listed gets no frame", slow, async () => {
    hostile.pages.set("/", withElement('room="main"'));
    await open(hostile.url);
    await until("the browser's refusal", async () => said, (lines) => lines.some((line) => /frame-ancestors/.test(line)));
    await sleep(1000);
    assert.deepEqual(waterFrames(), []);
    assert.deepEqual(await eventsOf("ready"), []);
    assert.match(await ask("splash", { xM: 0, zM: 0 }), /not ready/);
  });

  it("that is listed gets no frame of the page with panels, and none around which another page is", slow, async () => {
    listed.pages.set("/whole", `<iframe src="${server.url}?room=main"></iframe>`);
    await open(`${listed.url}/whole`);
    await until("the browser's refusal", async () => said, (lines) => lines.some((line) => /frame-ancestors 'none'/.test(line)));
    assert.deepEqual(waterFrames(), []);
    hostile.pages.set("/around", `<iframe src="${listed.url}/element"></iframe>`);
    await open(`${hostile.url}/around`);
    await until("the browser's refusal", async () => said, (lines) => lines.some((line) => /frame-ancestors/.test(line)));
    assert.deepEqual(waterFrames(), []);
  });

  it("beside the water cannot act in it, whatever it sends", slow, async () => {
    hostile.pages.set("/beside", `<script>
      setInterval(() => {
        for (const message of [{ spindrift: 1, kind: "hello" }, { spindrift: 1, kind: "pause", id: 1, paused: true }]) parent.frames[0].postMessage(message, "*");
      }, 50);
      addEventListener("message", ({ data }) => (window.heard = data));
    </script>`);
    listed.pages.set("/plain", `<iframe name="water" src="${server.url}?embed&room=main&quality=minimal"></iframe><iframe src="${hostile.url}/beside"></iframe>`);
    await open(`${listed.url}/plain`);
    await until("the warning", async () => said, (lines) => lines.some((line) => line.includes(`a message from ${hostile.url} was ignored`)));
    const water = await frameOf("main");
    await until("water", () => statsOf(water), (stats) => stats?.connectionState === "live" && stats.framesReceived.surface > 2);
    assert.equal((await statsOf(water)).paused, false);
    assert.equal(await page.frames().find((frame) => frame.url().startsWith(hostile.url)).evaluate(() => window.heard), undefined);
    // The same message of the page around the water is carried out.
    await page.evaluate((origin) => document.querySelector("iframe").contentWindow.postMessage({ spindrift: 1, kind: "pause", id: 1, paused: true }, origin), server.url);
    await until("the pause", () => statsOf(water), (stats) => stats.paused);
    await page.evaluate((origin) => document.querySelector("iframe").contentWindow.postMessage({ spindrift: 1, kind: "pause", id: 2, paused: false }, origin), server.url);
    await until("the end of the pause", () => statsOf(water), (stats) => !stats.paused);
  });

  it("embeds the view by the code that the card of Share gives", slow, async () => {
    await open(`${server.url}?quality=minimal&room=second&view=side#token=${kTokens.player}`);
    await page.getByTestId("share").click();
    await page.getByTestId("share-target").selectOption("embed");
    const code = await page.getByTestId("share-link").inputValue();
    assert.ok(!code.includes(kTokens.player), code);
    await page.getByTestId("share-copy").click();
    await until("the note", () => page.getByTestId("share-note").textContent(), (text) => /copied|by hand/.test(text));
    await page.getByTestId("share-close").click();
    listed.pages.set("/code", code);
    await open(`${listed.url}/code`);
    const water = await frameOf("second");
    await until("water from the side", () => statsOf(water), (stats) => stats?.connectionState === "live" && stats.framesReceived.surface > 2 && stats.view === "side");
    assert.deepEqual(errors(), []);
  });
});
