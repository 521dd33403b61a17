// The server with a certificate of its own: page, WebSocket, scripted client, health check, and a new certificate.
// Skipped where openssl is missing.
import { execFileSync, spawnSync } from "node:child_process";
import { chmodSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { get } from "node:https";
import { join } from "node:path";
import WebSocket from "ws";

import { binary, repository, startServer, temporaryFolder } from "../browser/server.mjs";

describe.skipIf(spawnSync("openssl", ["version"]).error)("a server with --tls-cert", () => {
  const folder = temporaryFolder("tls");
  const files = { cert: join(folder, "cert.pem"), key: join(folder, "key.pem") };
  let server;

  function makeCertificate(name) {
    const names = ["-subj", `/CN=${name}`, "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1"];
    execFileSync("openssl", ["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", ...names, "-keyout", files.key, "-out", files.cert], { stdio: "ignore" });
    chmodSync(files.key, 0o600);
  }

  /** Resolves to status, body and the name in the server's certificate. */
  function request(path) {
    return new Promise((resolve, reject) => {
      get({ host: "127.0.0.1", port: server.port, path, ca: readFileSync(files.cert), agent: false }, async (answer) => {
        const name = answer.socket.getPeerCertificate().subject?.CN;
        let body = "";
        for await (const part of answer.setEncoding("utf8")) body += part;
        resolve({ status: answer.statusCode, body, name });
      }).on("error", reject);
    });
  }

  beforeAll(async () => {
    makeCertificate("first");
    server = await startServer(0, ["--scene", `${repository}/tests/browser/scene.textproto`, "--tls-cert", files.cert, "--tls-key", files.key]);
  });
  afterAll(async () => {
    expect(await server?.stop("SIGTERM")).toMatchObject({ code: 0 });
    rmSync(folder, { recursive: true });
  });

  it("announces https, serves the page and says nothing of transport security", async () => {
    expect(server.url).toMatch(/^https:/);
    expect(await request("/")).toMatchObject({ status: 200, name: "first" });
    const headers = await new Promise((resolve) => get({ host: "127.0.0.1", port: server.port, path: "/", ca: readFileSync(files.cert) }, (answer) => resolve(answer.resume().headers)));
    expect(headers["strict-transport-security"]).toBeUndefined();
  });

  it("opens sessions of its own https page, and no others", async () => {
    const open = (origin) => {
      const socket = new WebSocket(`wss://127.0.0.1:${server.port}/ws`, "spindrift.v1", { ca: readFileSync(files.cert), origin });
      return new Promise((resolve, reject) => {
        socket.on("message", () => resolve(socket));
        socket.on("unexpected-response", (_, answer) => resolve(answer.statusCode));
        socket.on("error", reject);
      });
    };
    const socket = await open(`https://127.0.0.1:${server.port}`);
    expect(socket.protocol).toBe("spindrift.v1");
    const closed = new Promise((resolve) => socket.on("close", resolve));
    socket.close(1000);
    expect(await closed).toBe(1000);
    expect(await open("https://elsewhere.example")).toBe(403);
  });

  it("is used by scripted clients that know its authority, and by no others", () => {
    const script = join(folder, "script.textproto");
    writeFileSync(script, 'clients { name: "ada" subscribe { layer: LAYER_SURFACE max_rate_hz: 30 } } steps { frames { layer: LAYER_SURFACE min_count: 5 } }');
    const run = (...more) => spawnSync(binary, ["script", script, "--url", `wss://localhost:${server.port}`, ...more], { encoding: "utf8" });
    const trusting = run("--tls-ca", files.cert);
    expect(trusting.stdout).toContain("ok");
    expect(trusting.status).toBe(0);
    const doubting = run();
    expect(doubting.status).toBe(1);
    expect(doubting.stdout).toMatch(/the certificate is not accepted: self-signed certificate/);
  });

  it("passes the health check of the container, which a port without a server does not", () => {
    const check = (port) => spawnSync(`${repository}/docker/healthcheck`, [String(port)], { stdio: "ignore" }).status;
    expect(check(server.port)).toBe(0);
    expect(check(1)).not.toBe(0);
  });

  it("uses a new certificate without a restart", async () => {
    makeCertificate("second");
    const begin = Date.now();
    while ((await request("/healthz").catch(() => ({}))).name !== "second") {
      expect(Date.now() - begin).toBeLessThan(20_000);
      await new Promise((resolve) => setTimeout(resolve, 100));
    }
    const metrics = (await request("/metrics")).body;
    expect(metrics).toMatch(/^spindrift_tls_reloads_total 1$/m);
    expect(metrics).toMatch(/^spindrift_tls_reloads_failed_total 0$/m);
    expect(Number(/^spindrift_tls_certificate_expires_seconds (.*)$/m.exec(metrics)[1])).toBeGreaterThan(86_400);
  });
});
