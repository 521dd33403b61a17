// A server that ends and is started again: what probes, sessions, scripted clients and the page's own connection see.
import { spawn } from "node:child_process";
import { rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import WebSocket from "ws";

import { PageConnection } from "../../web-client/src/net/page_connection";
import { binary, freePort, repository, startServer, until, temporaryFolder } from "../browser/server.mjs";

/** From the signal to the exit of a server whose clients take part. */
// The server's own bounds after SIGTERM: 1 s of --drain-s, 3 s for sessions, 5 s for the disk, 2 s for water that is being built.
const kEndLimitMs = 11000;

/** The page's connection on the sockets of npm ws, with real time. */
class Page {
  events = [];

  constructor(port, name) {
    const world = {
      openSocket: (url, subprotocol) => {
        const socket = new WebSocket(url, subprotocol);
        socket.on("error", () => {}); // "close" follows
        return socket;
      },
      nowMs: () => Date.now(),
      random: () => Math.random(),
      setTimer: (callback, ms) => setTimeout(callback, ms),
      clearTimer: (timer) => clearTimeout(timer),
      findMissingRoom: async () => undefined, // the room is there, or the server is away
    };
    const sink = { event: (event) => this.events.push(event), frame: () => {} };
    this.connection = new PageConnection(`ws://127.0.0.1:${port}/ws`, world, sink, { name, token: "", resumeKey: "" }).session;
    this.connection.start();
  }
  newest(kind) {
    return this.events.findLast((event) => event.kind === kind);
  }
}

function statusOf(port, path, options) {
  return fetch(`http://127.0.0.1:${port}${path}`, options).then(async (answer) => ({ status: answer.status, text: await answer.text(), retryAfter: answer.headers.get("retry-after") }));
}

describe("a server that ends", () => {
  const folder = temporaryFolder("restart");
  const pages = [];
  let server;

  afterEach(async () => {
    for (const page of pages.splice(0)) page.connection.stop();
    await server?.stop("SIGTERM");
    server = undefined;
  });
  afterAll(() => rmSync(folder, { recursive: true }));

  const start = async (port, more = []) => {
    server = await startServer(port, ["--scene", `${repository}/tests/browser/marina.textproto`, "--grace", "60", ...more]);
    return server;
  };

  it("refuses sessions and rooms, then closes with 1001", async () => {
    const { port, stop } = await start(0, ["--drain-s", "3"]);
    const page = new Page(port, "Ada");
    pages.push(page);
    await until("the welcome", () => page.newest("welcome"));
    const ended = stop("SIGTERM");
    const draining = await until("the message", () => page.newest("draining"));
    expect(draining.draining).toMatchObject({ closesInS: 3, goTo: "", reconnectAfterMinS: 4 });
    expect(await statusOf(port, "/readyz")).toMatchObject({ status: 503, text: "draining\n" });
    expect(await statusOf(port, "/healthz")).toMatchObject({ status: 200 });
    const room = { method: "POST", headers: { "Content-Type": "application/json" }, body: '{"name":"more","scene":"splash"}' };
    expect(await statusOf(port, "/api/v1/rooms", room)).toMatchObject({ status: 503, retryAfter: "5" });
    const late = new WebSocket(`ws://127.0.0.1:${port}/ws`, "spindrift.v1");
    const refusal = await new Promise((resolve) => late.on("unexpected-response", (_, answer) => resolve(answer)));
    expect(refusal.statusCode).toBe(503);
    expect(refusal.headers["retry-after"]).toBe("4");
    late.on("error", () => {}).terminate();
    expect(page.newest("state").state.name).toBe("live");
    expect(await ended).toMatchObject({ code: 0 });
    await until("the loss", () => page.newest("state").state.name === "retrying");
    expect(page.newest("state").state.why).toBe("the server restarts");
  });

  it("does not wait any longer after a second signal", async () => {
    const { port, stop } = await start(0, ["--drain-s", "4"]);
    const page = new Page(port, "Ada");
    pages.push(page);
    await until("the welcome", () => page.newest("welcome"));
    const begin = Date.now();
    const ended = stop("SIGTERM");
    await until("the message", () => page.newest("draining"));
    expect(await stop("SIGINT")).toMatchObject({ code: 0 });
    expect(await ended).toMatchObject({ code: 0 });
    expect(Date.now() - begin).toBeLessThan(4000);
  });

  it("ends when an operator asks for it", async () => {
    const { port, ended } = await start(0);
    expect(await statusOf(port, "/api/v1/drain")).toMatchObject({ status: 405 });
    expect(await statusOf(port, "/api/v1/drain", { method: "POST" })).toMatchObject({ status: 202 });
    expect(await ended).toMatchObject({ code: 0 });
    server = undefined;
  });

  it("waits for its clients also after an operator has asked twice", async () => {
    const { port, ended } = await start(0, ["--drain-s", "3"]);
    const page = new Page(port, "Ada");
    pages.push(page);
    await until("the welcome", () => page.newest("welcome"));
    const begin = Date.now();
    for (let k = 0; k < 2; k++) {
      expect(await statusOf(port, "/api/v1/drain", { method: "POST" })).toMatchObject({ status: 202 });
      expect(await statusOf(port, "/readyz")).toMatchObject({ status: 503, text: "draining\n" });
    }
    expect(await ended).toMatchObject({ code: 0 });
    expect(Date.now() - begin).toBeGreaterThan(2500);
    server = undefined;
  });

  it("lets page and scripted client return to their boats after a restart", async () => {
    const port = await freePort();
    const kept = ["--state-dir", join(folder, "state")];
    const first = await start(port, kept);
    const page = new Page(port, "Ada");
    pages.push(page);
    const { welcome } = await until("the welcome", () => page.newest("welcome"));
    page.connection.command(1, { case: "spawnBoat", value: { boat: { xM: 2, zM: 2 } } });
    const { boatId } = await until("the boat", () => {
      expect(page.newest("reject")).toBeUndefined();
      return page.newest("ack");
    });

    writeFileSync(
      join(folder, "script.textproto"),
      `clients { name: "bob" person: "Bob" subscribe { layer: LAYER_BODIES max_rate_hz: 10 } }
       steps { command { command { spawn_boat { boat { x_m: -2 z_m: -2 } } } save_boat: "his" } }
       steps { at_s: 6 people { count: 2 within_s: 30 } }
       steps { command { command { control_boat { throttle_ratio: 0.5 } } boat: "his" } }`,
    );
    const script = spawn(binary, ["script", join(folder, "script.textproto"), "--url", `ws://127.0.0.1:${port}`], { stdio: ["ignore", "pipe", "pipe"] });
    let report = "";
    for (const stream of [script.stdout, script.stderr]) stream.setEncoding("utf8").on("data", (text) => (report += text));
    const finished = new Promise((resolve) => script.on("close", resolve));
    await until("Bob's boat", () => page.newest("boatList")?.boats.length === 2);

    page.events.length = 0;
    const begin = Date.now();
    expect(await first.stop("SIGTERM")).toMatchObject({ code: 0 });
    expect(Date.now() - begin).toBeLessThan(kEndLimitMs);
    await start(port, kept);
    const back = await until("the welcome of the new server", () => page.newest("welcome"));
    expect(back.welcome).toMatchObject({ personId: welcome.personId, resumed: true });
    await until("the boat's owner", () => page.newest("people")?.people.find((person) => person.personId === welcome.personId)?.boatIds.includes(boatId));
    expect(await finished, report).toBe(0);
  });

  it("sends its clients to another server", async () => {
    const other = await startServer(0, ["--scene", `${repository}/tests/browser/scene.textproto`]);
    const { port, stop } = await start(0, ["--drain-s", "4", "--drain-to", `ws://127.0.0.1:${other.port}`]);
    const page = new Page(port, "Ada");
    pages.push(page);
    await until("the welcome", () => page.newest("welcome"));
    page.events.length = 0;
    expect(await stop("SIGTERM")).toMatchObject({ code: 0 });
    await until("the welcome of the other server", () => page.newest("welcome"));
    page.connection.stop();
    await other.stop("SIGTERM");
  });

  it("ends within its bounds with a hundred clients and a kept harbor", async () => {
    server = await startServer(0, ["--scene", "harbor", "--state-dir", join(folder, "harbor")]);
    for (let k = 0; k < 100; ++k) pages.push(new Page(server.port, `client ${k}`));
    await until("a hundred welcomes", () => pages.every((page) => page.newest("welcome")));
    const begin = Date.now();
    expect(await server.stop("SIGTERM")).toMatchObject({ code: 0 });
    const took_ms = Date.now() - begin;
    console.log(`ended ${took_ms} ms after SIGTERM`);
    expect(took_ms).toBeLessThan(kEndLimitMs);
    // A client that reads too slowly, as some of a hundred in one event loop on a busy machine, is cut off at the server's limit, with
    // the notice still under way.
    await until("the end of every connection", () => pages.every((page) => page.newest("state").state.name === "retrying"));
    const waits = pages.flatMap((page) => page.newest("draining")?.draining.reconnectAfterMaxS ?? []);
    expect(waits.length).toBeGreaterThan(0);
    expect(waits.every((wait) => wait >= 2.5)).toBe(true);
    server = undefined;
  });
});
