// A server and an edge over a NATS server that is configured as docs/security.md says, with TLS, users and permissions.
// Skipped where nats-server or openssl is missing.
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { once } from "node:events";
import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { connect, createServer } from "node:net";
import { connect as connectTls } from "node:tls";

import { binary, freePort, repository, startServer, temporaryFolder } from "../browser/server.mjs";
import { Layer, Packing } from "../../web-client/client/gen/spindrift/v1/wire_pb";
import { Client } from "./client.mjs";

const kPath = `${process.env.PATH}:/usr/sbin:/usr/bin:/bin`;
const has = (program, argument) => spawnSync(program, [argument], { env: { PATH: kPath } }).error === undefined;
const kStartLimitMs = 20_000;

describe.skipIf(!has("nats-server", "--version") || !has("openssl", "version"))("NATS with the documented permissions", () => {
  const folder = temporaryFolder("nats");
  const passwords = { server: "password-of-the-servers", edge: "password-of-the-edges" };
  let nats;
  let port;
  let words = "";
  let ca;
  let server;
  let edge;

  /** The block of the documentation with the paths, passwords and port of this test. */
  function documented() {
    const page = readFileSync(`${repository}/docs/security.md`, "utf8");
    const block = /```conf\n([^]*?)```/.exec(page)?.[1];
    const replaced = [
      ["10.0.0.5:4222", `127.0.0.1:${port}`],
      ["/var/lib/nats", `${folder}/jetstream`],
      ["/etc/nats/cert.pem", `${folder}/cert.pem`],
      ["/etc/nats/key.pem", `${folder}/key.pem`],
      ["SERVER-PASSWORD", passwords.server],
      ["EDGE-PASSWORD", passwords.edge],
    ];
    return replaced.reduce((text, [from, to]) => {
      expect(text).toContain(from);
      return text.replaceAll(from, to);
    }, block);
  }

  /** Starts a process of the cluster; its URL is in its environment, where `ps` does not show the password. */
  function start(command, user, options) {
    process.env.SPINDRIFT_NATS = `tls://${user}:${passwords[user]}@localhost:${port}`;
    process.env.SPINDRIFT_NATS_CA = `${folder}/cert.pem`;
    try {
      return startServer(0, options, command);
    } finally {
      delete process.env.SPINDRIFT_NATS;
      delete process.env.SPINDRIFT_NATS_CA;
    }
  }

  beforeAll(async () => {
    const names = ["-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost"];
    execFileSync("openssl", ["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", ...names, "-keyout", `${folder}/key.pem`, "-out", `${folder}/cert.pem`], { stdio: "ignore" });
    ca = readFileSync(`${folder}/cert.pem`);
    port = await freePort();
    writeFileSync(`${folder}/nats.conf`, documented(), { mode: 0o600 });
    nats = spawn("nats-server", ["-c", `${folder}/nats.conf`], { env: { PATH: kPath }, stdio: ["ignore", "ignore", "pipe"] });
    nats.stderr.setEncoding("utf8").on("data", (text) => (words += text));
    const begin = Date.now();
    while (!words.includes("Server is ready")) {
      if (nats.exitCode !== null || Date.now() - begin > kStartLimitMs) throw new Error(`nats-server does not serve: ${words}`);
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
    writeFileSync(`${folder}/small.textproto`, 'name: "small" wave { resolution_count: 32 side_m: 8 depth_m: 1 }');
    server = await start("serve", "server", ["--node", "server-1", "--scene", `${folder}/small.textproto`]);
    edge = await start("edge", "edge", ["--node", "edge-1"]);
    const ready = () => fetch(`http://127.0.0.1:${edge.port}/readyz`).then((answer) => answer.ok);
    while (!(await ready())) {
      if (Date.now() - begin > kStartLimitMs) throw new Error(`the edge finds no server: ${words}`);
      await new Promise((resolve) => setTimeout(resolve, 50));
    }
  });
  afterAll(async () => {
    await edge?.stop("SIGTERM");
    await server?.stop("SIGTERM");
    if (nats && nats.exitCode === null) {
      nats.kill("SIGTERM");
      await new Promise((resolve) => nats.on("exit", resolve));
    }
    rmSync(folder, { recursive: true });
  });

  /** Sends lines of the NATS protocol as this user; resolves to what NATS says to each. */
  async function say(user, lines) {
    const plain = connect(port, "127.0.0.1");
    await new Promise((resolve) => plain.once("data", resolve)); // INFO
    const socket = connectTls({ socket: plain, host: "localhost", ca });
    socket.setEncoding("latin1");
    let said = "";
    const answers = [];
    const turn = async (line) => {
      said = "";
      socket.write(`${line}\r\nPING\r\n`);
      while (!said.includes("PONG")) {
        if (socket.closed) throw new Error(`NATS closed after ${line}: ${said}`);
        await once(socket, "readable");
        said += socket.read() ?? "";
      }
      answers.push(said.replace("PONG\r\n", "").trim());
    };
    await turn(`CONNECT ${JSON.stringify({ user, pass: passwords[user], verbose: false, pedantic: false, lang: "test", version: "1" })}`);
    for (const line of lines) await turn(line);
    socket.destroy();
    return answers.slice(1);
  }

  it("lets servers and edges do all that they need", async () => {
    const client = await Client.greeted(edge.port);
    client.subscribe(Layer.SURFACE, Packing.PLAIN);
    await client.nextOf("surface");
    client.command(1n, { case: "splash", value: { depthM: 0.1 } });
    expect(await client.next((message) => message.kind === "ack" || message.kind === "reject")).toMatchObject({ kind: "ack", commandId: 1n });
    await client.close();

    const ask = (method, path, value) => fetch(`http://127.0.0.1:${edge.port}/api/v1/${path}`, { method, headers: { "Content-Type": "application/json" }, body: value && JSON.stringify(value) });
    expect((await ask("POST", "rooms", { name: "lab", scene: "small" })).status).toBe(201);
    expect((await (await ask("GET", "rooms")).json()).rooms.map((room) => room.name).toSorted()).toEqual(["lab", "main"]);
    expect((await ask("DELETE", "rooms/lab")).status).toBe(204);
    expect(words).not.toMatch(/violation/i);
  });

  it("keeps an edge from acting as a server", async () => {
    const lines = ["PUB spindrift.servers 0\r\n", "PUB spindrift.frames.main.0.full 0\r\n", "PUB spindrift.node.edge-2 0\r\n", "PUB $KV.spindrift_rooms.main 0\r\n", "PUB $JS.API.STREAM.DELETE.KV_spindrift_rooms 0\r\n", "SUB spindrift.room.* 1", "SUB spindrift.server.* 2", "SUB $KV.> 3", "SUB > 4", "PUB other.room.main 0\r\n"];
    const answers = await say("edge", lines);
    answers.forEach((answer, k) => expect(answer, lines[k]).toMatch(/^-ERR 'Permissions Violation/));
    expect(words).toMatch(/violation/i); // which the test above would have seen
    expect(await say("edge", ["PUB spindrift.room.nowhere 0\r\n", "SUB spindrift.servers 1"])).toEqual(["", expect.not.stringContaining("-ERR")]);
  });

  it("keeps a server to its cluster and to its directory", async () => {
    const lines = ["PUB other.servers 0\r\n", "PUB $KV.other_rooms.main 0\r\n", "PUB $JS.API.STREAM.DELETE.KV_spindrift_rooms 0\r\n", "PUB $JS.API.STREAM.PURGE.KV_spindrift_rooms 0\r\n", "PUB $SYS.REQ.SERVER.PING 0\r\n", "SUB > 1", "SUB other.> 2"];
    const answers = await say("server", lines);
    answers.forEach((answer, k) => expect(answer, lines[k]).toMatch(/^-ERR 'Permissions Violation/));
  });

  it("refuses a wrong password, an unknown authority and a connection without TLS, and no message has the password", () => {
    const run = (url, ...more) => spawnSync(binary, ["edge", "--port", "0", ...more], { env: { ...process.env, SPINDRIFT_NATS: url }, encoding: "utf8" });
    const refusals = [
      run(`tls://edge:wrong-password@localhost:${port}`, "--nats-ca", `${folder}/cert.pem`),
      run(`tls://edge:${passwords.edge}@localhost:${port}`),
      run(`nats://edge:${passwords.edge}@localhost:${port}`),
    ];
    for (const { status, stdout, stderr } of refusals) {
      expect(status).not.toBe(0);
      expect(stderr).toContain(`localhost:${port}`);
      expect(stdout + stderr).not.toMatch(/wrong-password|password-of/);
    }
    expect(refusals[0].stderr).toMatch(/Authorization Violation/);
  });

  it("sends nothing in plain text where TLS is required", async () => {
    let heard = "";
    const pretender = createServer((socket) => {
      socket.on("error", () => {});
      socket.setEncoding("latin1").on("data", (text) => (heard += text));
      socket.write(`INFO ${JSON.stringify({ server_id: "x", version: "2.9.10", proto: 1, max_payload: 1048576, headers: true })}\r\n`);
    }).listen(0, "127.0.0.1");
    await once(pretender, "listening");
    const at = `edge:${passwords.edge}@127.0.0.1:${pretender.address().port}`;
    for (const [url, ...more] of [[`tls://${at}`], [`nats://${at}`, "--nats-ca", `${folder}/cert.pem`]]) {
      const child = spawn(binary, ["edge", "--port", "0", ...more], { env: { ...process.env, SPINDRIFT_NATS: url }, stdio: ["ignore", "ignore", "pipe"] });
      let said = "";
      child.stderr.setEncoding("utf8").on("data", (text) => (said += text));
      const [code] = await once(child, "close");
      expect(code).not.toBe(0);
      expect(said).toContain("Secure Connection not available");
    }
    expect(heard).toBe("");
    pretender.close();
  });

  it("refuses the certificate of another host", () => {
    const { status, stderr } = spawnSync(binary, ["edge", "--port", "0", "--nats-ca", `${folder}/cert.pem`], { env: { ...process.env, SPINDRIFT_NATS: `tls://edge:${passwords.edge}@127.0.0.1:${port}` }, encoding: "utf8" });
    expect(status).not.toBe(0);
    expect(stderr).toMatch(/IP address mismatch/);
  });
});
