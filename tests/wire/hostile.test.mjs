// Clients that attack the real server over raw sockets, because HTTP libraries send no such bytes: paths that lead
// outside, requests that two readers would divide differently, and clients that are slow on purpose.
import { mkdirSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { connect } from "node:net";
import { join } from "node:path";

import { startServer, temporaryFolder } from "../browser/server.mjs";

/** What the server allows a request, and a session without Hello (ServerOptions::handshake_timeout, 10 s), and more for a busy machine. */
const kPatienceMs = 30_000;
const kDripMs = 200;

const folder = temporaryFolder("hostile");
let server;

beforeAll(async () => {
  writeFileSync(join(folder, "small.textproto"), 'name: "small" unwatched: UNWATCHED_SLEEP wave { resolution_count: 32 side_m: 8 depth_m: 1 }');
  mkdirSync(join(folder, "state"));
  server = await startServer(0, ["--scene", join(folder, "small.textproto"), "--state-dir", join(folder, "state")]);
});
afterAll(async () => {
  expect(await server?.stop("SIGTERM")).toEqual({ code: 0, signal: null });
  rmSync(folder, { recursive: true });
});

/** Sends the bytes of `text` (Latin-1). Resolves to all that came, and to who closed the connection; after `limit_ms` that is "us". */
function exchange(text, limit_ms = kPatienceMs) {
  return new Promise((resolve) => {
    const socket = connect(server.port, "127.0.0.1");
    let answer = "";
    let closed_by = "us";
    socket.setEncoding("latin1").on("data", (part) => (answer += part));
    socket.on("end", () => (closed_by = "server"));
    socket.on("error", () => (closed_by = "server"));
    const timer = setTimeout(() => socket.destroy(), limit_ms);
    socket.on("close", () => {
      clearTimeout(timer);
      resolve({ answer, closed_by, statuses: [...answer.matchAll(/HTTP\/1\.1 (\d{3}) /g)].map((match) => Number(match[1])) });
    });
    socket.write(Buffer.from(text, "latin1"));
  });
}

const head = (line, ...headers) => [`${line} HTTP/1.1`, "Host: a", ...headers, "", ""].join("\r\n");
const get = (target) => head(`GET ${target}`, "Connection: close");
const post = (path, value) => {
  const body = Buffer.from(JSON.stringify(value)).toString("latin1");
  return head(`POST ${path}`, "Connection: close", "Content-Type: application/json", `Content-Length: ${body.length}`) + body;
};
const kKey = "Sec-WebSocket-Key: c3BpbmRyaWZ0IHRlc3RzIQ==";
const upgrade = (target, ...more) => head(`GET ${target}`, "Connection: Upgrade", "Upgrade: websocket", "Sec-WebSocket-Version: 13", kKey, ...more);

/** The only status of the answer. */
async function statusOf(text) {
  const { statuses, closed_by } = await exchange(text);
  expect(closed_by, text).toBe("server");
  expect(statuses, text).toHaveLength(1);
  return statuses[0];
}

describe("paths that lead outside", () => {
  // "..", plain, encoded once and twice, in overlong UTF-8, with what ends a path elsewhere, and as Windows writes it.
  const ups = ["..", "%2e%2e", ".%2e", "%252e%252e", "..%00", "..;", "%c0%ae%c0%ae", "..%c0%af", "..%2f", "..%252f", "..%5c", "..\\", "....//..", "%u002e%u002e"];

  it("serve no file but those of the page", async () => {
    expect(await statusOf(get("/index.html"))).toBe(200);
    // package.json lies beside the folder of the page.
    const targets = ups.flatMap((up) => [`/${up}/package.json`, `/assets/${up}/${up}/package.json`]);
    targets.push("//etc/passwd", "/%2fetc%2fpasswd", "/etc/passwd", "file:///etc/passwd", "http://a/../package.json");
    targets.push("/index.html%00.js", "/index.html\0.js", "/%00", "/.", "/..", "/assets", "/assets/", "/assets/.", "/index.html/..", "/./index.html");
    for (const target of targets) {
      const { answer, statuses } = await exchange(get(target));
      expect([400, 404], target).toContain(statuses[0]);
      expect(answer, target).not.toMatch(/root:|"dependencies"/);
    }
  });

  it("are not rooms, for sessions and for requests", async () => {
    const names = [...ups, "../main", "..%2fmain", "main/../main", "%2fmain", "main%00", "main%0d%0aPUB", "*", "%3e", "main.%3e", "main%20x"];
    for (const name of names) {
      for (const text of [upgrade(`/ws/${name}`), upgrade(`/ws?room=${name}`), get(`/api/v1/rooms/${name}`), head(`DELETE /api/v1/rooms/${name}`, "Connection: close")]) {
        expect([400, 404], text).toContain(await statusOf(text));
      }
    }
  });

  it("are refused as names of rooms and scenes", async () => {
    const before = readdirSync(folder, { recursive: true }).filter((name) => !name.includes("main"));
    for (const name of ["..", "../x", "/etc/x", "x/y", "x\\y", "x\0", ".x", "x.", "%2e%2e", "%252e%252e", "*", ">", "a b", "x\n", "ä", "", "x".repeat(33)]) {
      expect(await statusOf(post("/api/v1/rooms", { name, scene: "small" })), JSON.stringify(name)).toBe(422);
      expect(await statusOf(post("/api/v1/rooms", { name: "fresh", scene: name })), JSON.stringify(name)).toBeOneOf([404, 422]);
      expect(await statusOf(post("/api/v1/rooms/main/commands", { change_scene: { name } })), JSON.stringify(name)).toBeOneOf([404, 422]);
    }
    expect(readdirSync(folder, { recursive: true }).filter((name) => !name.includes("main"))).toEqual(before);
  });
});

describe("requests that two readers would divide differently", () => {
  // Read as a request of its own, it would be answered with 200.
  const hidden = head("GET /healthz");
  const chunks = `0\r\n\r\n${hidden}`;
  const both = (...headers) => head("POST /api/v1/rooms", "Content-Type: application/json", ...headers);
  const length = `Content-Length: ${chunks.length}`;

  /** Refused, closed, and what follows is never read as a request. */
  async function expectRefused(name, text) {
    const { statuses, closed_by } = await exchange(text);
    expect(statuses, name).toHaveLength(1);
    expect(statuses[0], name).toBeOneOf([400, 411]);
    expect(closed_by, name).toBe("server");
  }

  it("are refused when they have a length and chunks", async () => {
    await expectRefused("length first", both(length, "Transfer-Encoding: chunked") + chunks);
    await expectRefused("chunks first", both("Transfer-Encoding: chunked", "Content-Length: 5") + chunks);
    await expectRefused("HTTP/1.0", both("Transfer-Encoding: chunked", "Connection: keep-alive").replace("HTTP/1.1", "HTTP/1.0") + chunks);
  });

  it("are refused when they have two lengths, or one that is not a number", async () => {
    await expectRefused("two", both("Content-Length: 0", `Content-Length: ${hidden.length}`) + hidden);
    await expectRefused("two, swapped", both(`Content-Length: ${hidden.length}`, "Content-Length: 0") + hidden);
    for (const value of ["+2", "-2", "0x2", "2 2", "2, 3", "", "18446744073709551618"]) await expectRefused(value, both(`Content-Length: ${value}`) + `{}${hidden}`);
    await expectRefused("space before the colon", both("Content-Length : 2", "Content-Length: 0") + hidden);
  });

  it("are refused when they hide chunks from one of the two", async () => {
    const codings = ["\tchunked", " ChUnKeD", " xchunked", " identity", " gzip", " chunked, identity", " identity, chunked", ' "chunked"', " \x0bchunked", " chunked\0", "\r\n chunked", ""];
    for (const coding of codings) {
      await expectRefused(coding, both(`Transfer-Encoding:${coding}`, length) + chunks);
      await expectRefused(coding, head("GET /healthz", `Transfer-Encoding:${coding}`) + chunks);
    }
    await expectRefused("two codings", both("Transfer-Encoding: identity", "Transfer-Encoding: chunked", length) + chunks);
    await expectRefused("space before the colon", both("Transfer-Encoding : chunked", length) + chunks);
    await expectRefused("LF only", both("X-A: b\nTransfer-Encoding: chunked", length) + chunks);
    await expectRefused("CR only", both("X-A: b\rTransfer-Encoding: chunked", length) + chunks);
    await expectRefused("no colon", both("Transfer-Encoding chunked", "Content-Length: 0") + hidden);
    await expectRefused("NUL in a name", both("Content\0-Length: 2", "Content-Length: 0") + hidden);
    await expectRefused("lines that end in LF", head("GET /healthz").replaceAll("\r\n", "\n") + hidden);
    for (const line of ["GET  /healthz", "GET\t/healthz"]) await expectRefused(line, head(line) + hidden);
    for (const version of ["0.9", "1.9", "2.0"]) await expectRefused(version, hidden.replace("1.1", version) + hidden);
  });

  it("are answered one by one, in order, when each has one length", async () => {
    const body = '{"name": ""}';
    const both_lengths = head("GET /healthz", `Content-Length: ${hidden.length}`) + hidden;
    const { statuses } = await exchange(both_lengths + both(`Content-Length: ${body.length}`) + body + head("GET /nothing", "Connection: close") + hidden);
    expect(statuses).toEqual([200, 422, 404]);
  });

  it("end at an upgrade, whether it is accepted or refused", async () => {
    // Before it: a request of its own.
    expect((await exchange(head("GET /healthz") + upgrade("/ws"), 1000)).statuses).toEqual([200, 101]);
    // A proxy that believes in the upgrade passes on everything behind it; here nothing of it is a request.
    const refused = { early: upgrade("/ws"), version: upgrade("/ws").replace(": 13", ": 12"), room: upgrade("/ws/nowhere"), path: upgrade("/healthz"), token: upgrade("/ws?token=a") };
    for (const [name, text] of Object.entries(refused)) await expectRefused(name, text + hidden);
    for (const text of [upgrade("/ws/nowhere"), upgrade("/ws").replace(": 13", ": 12")]) {
      const { statuses, closed_by } = await exchange(text);
      expect(statuses).toHaveLength(1);
      expect(closed_by).toBe("server");
    }
    // After it: bytes of a session, which are not frames.
    const { statuses, closed_by } = await exchange(upgrade("/ws", `Content-Length: ${hidden.length}`) + hidden);
    expect(statuses).toEqual([101]);
    expect(closed_by).toBe("server"); // after the time for Hello
  });
});

describe("clients that are slow on purpose", () => {
  /** Sends `begin`, `then` when something was answered, and from then on a byte at a time. Resolves to the time in ms until the server closes. */
  function drip(begin, byte, then) {
    return new Promise((resolve, reject) => {
      const since = Date.now();
      const socket = connect(server.port, "127.0.0.1", () => socket.write(Buffer.from(begin, "latin1")));
      const timer = setInterval(() => {
        if (byte !== undefined && drips && socket.writable) socket.write(Buffer.from([byte]));
        if (Date.now() - since < kPatienceMs) return;
        clearInterval(timer);
        socket.destroy();
        reject(new Error(`still open after ${kPatienceMs} ms: ${begin}`));
      }, kDripMs);
      let drips = then === undefined;
      socket.on("data", () => {
        if (drips) return;
        drips = true;
        socket.write(Buffer.from(then));
      });
      socket.on("error", () => {});
      socket.on("close", () => {
        clearInterval(timer);
        resolve(Date.now() - since);
      });
    });
  }

  it("are closed at one deadline for all of it, while others are served", async () => {
    const x = "x".charCodeAt(0);
    const attacks = [
      () => drip(""), // never a byte
      () => drip("GET / HTTP/1.1\r\nHost: a\r\nX-Long: ", x),
      () => drip(head("POST /api/v1/rooms", "Content-Type: application/json", "Content-Length: 60000"), x),
      () => drip(upgrade("/ws").slice(0, -2) + "X-Long: ", x),
      // A session whose first message never ends: a binary frame of 16,384 bytes, with a mask of zeros.
      () => drip(upgrade("/ws"), 0, [0x82, 0xfe, 0x40, 0x00, 0, 0, 0, 0]),
    ];
    const slow = attacks.flatMap((attack) => Array.from({ length: 15 }, attack));
    let ended = false;
    const all = Promise.all(slow).finally(() => (ended = true));
    while (!ended) {
      const since = Date.now();
      expect(await statusOf(get("/index.html"))).toBe(200);
      expect(Date.now() - since).toBeLessThan(2_000);
      await new Promise((resolve) => setTimeout(resolve, 500));
    }
    for (const open_ms of await all) {
      expect(open_ms).toBeLessThan(20_000);
      expect(open_ms).toBeGreaterThan(5_000); // not refused for what they said
    }
  });
});
