// The page over https in Chromium, with a throw-away certificate: it opens its WebSocket as wss and shows frames.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync, rmSync } from "node:fs";
import { join } from "node:path";
import { after, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { executable, launch, WAIT_MS } from "./chromium.mjs";
import { repository, startServer, temporaryFolder } from "./server.mjs";

const missing = [
  [!existsSync(executable), `Chromium is missing (${executable}); set CHROMIUM or install it`],
  [spawnSync("openssl", ["version"]).error !== undefined, "openssl is missing"],
].find(([is_missing]) => is_missing);
const skip = missing ? missing[1] : false;

describe("the page over https", { skip }, () => {
  const folder = temporaryFolder("browser-tls");
  let server;
  let browser;
  after(async () => {
    await browser?.close();
    await server?.stop("SIGTERM");
    rmSync(folder, { recursive: true, force: true });
  });

  it("connects by wss and shows frames", { timeout: 4 * WAIT_MS }, async () => {
    const [cert, key] = [join(folder, "cert.pem"), join(folder, "key.pem")];
    execFileSync("openssl", ["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1", "-keyout", key, "-out", cert], { stdio: "ignore" });
    server = await startServer(0, ["--scene", `${repository}/tests/browser/scene.textproto`, "--tls-cert", cert, "--tls-key", key]);
    browser = await launch();
    const context = await browser.newContext({ ignoreHTTPSErrors: true });
    const page = await context.newPage();
    const sockets = [];
    page.on("websocket", (socket) => sockets.push(socket.url()));
    await page.goto(`${server.url}?quality=minimal`, { timeout: WAIT_MS });
    assert.ok(page.url().startsWith("https://"));
    assert.equal(await page.evaluate(() => window.isSecureContext), true);
    let stats;
    for (const begin = Date.now(); Date.now() - begin < WAIT_MS; await sleep(100)) {
      stats = await page.evaluate(() => window.spindrift?.stats());
      if (stats?.connectionState === "live" && stats.framesReceived.surface > 5) break;
    }
    assert.equal(stats?.connectionState, "live");
    assert.ok(stats.framesReceived.surface > 5, JSON.stringify(stats));
    // The worker's socket may not be reported; one that is must be wss.
    for (const url of sockets) assert.ok(url.startsWith("wss://"), url);
  });
});
