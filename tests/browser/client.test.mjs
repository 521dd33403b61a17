// The package spindrift-client in a worker of a browser, bundled by Vite as a project of others would, in a page of another origin.
import assert from "node:assert/strict";
import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";

import { build } from "../../web-client/node_modules/vite/dist/node/index.js";
import { launch, skip, WAIT_MS } from "./chromium.mjs";
import { repository, startServer, temporaryFolder } from "./server.mjs";

/** What the worker does: the first heights, a command, a refusal, five frames of a loop. */
const kWorker = (url) => `
  import { connect, Rejected } from ${JSON.stringify(join(repository, "web-client/client/dist/index.js"))};
  try {
    const water = await connect(${JSON.stringify(url)}, { name: "worker" });
    const surface = await water.surface();
    const { appliedTick } = await water.splash({ xM: 1, depthM: 0.3 });
    const refused = await water.splash({ xM: NaN }).catch((error) => error);
    let frames = 0;
    for await (const frame of water.frames("particles")) if (frame.positionsM.length === 3 * frame.count && ++frames === 5) break;
    postMessage({ hasDom: "document" in globalThis, count: surface.heightsM.length, appliedTick, reason: refused instanceof Rejected && refused.reason, frames, role: water.role });
    water.close();
  } catch (error) {
    postMessage({ failed: String(error) });
  }
`;

describe("the package in a worker", { skip }, () => {
  const folder = temporaryFolder("worker");
  let http;
  let server;
  let browser;

  before(async () => {
    http = createServer(({ url }, answer) => {
      const isScript = url === "/worker.js";
      answer.writeHead(200, { "Content-Type": isScript ? "text/javascript" : "text/html" }).end(isScript ? readFileSync(join(folder, "dist/worker.js")) : "<!doctype html><title>a page</title>");
    }).listen(0, "127.0.0.1");
    await new Promise((resolve) => http.on("listening", resolve));
    server = await startServer(0, ["--scene", `${repository}/tests/browser/scene.textproto`, "--origin", `http://127.0.0.1:${http.address().port}`]);
    writeFileSync(join(folder, "worker.js"), kWorker(server.url));
    await build({ configFile: false, root: folder, logLevel: "error", build: { target: "es2022", lib: { entry: "worker.js", formats: ["es"], fileName: () => "worker.js" } } });
    browser = await launch();
  }, { timeout: 4 * WAIT_MS });
  after(async () => {
    await browser?.close();
    http?.close();
    http?.closeAllConnections();
    await server?.stop("SIGTERM");
    rmSync(folder, { recursive: true });
  });

  it("reads packed frames and sends commands without a DOM", { timeout: 2 * WAIT_MS }, async () => {
    const page = await browser.newPage();
    await page.goto(`http://127.0.0.1:${http.address().port}/`);
    const said = await page.evaluate(() => new Promise((resolve) => {
      const worker = new Worker("/worker.js", { type: "module" });
      worker.onmessage = ({ data }) => resolve(data);
      worker.onerror = ({ message }) => resolve({ failed: message });
    }));
    const { appliedTick, ...others } = said;
    assert.deepEqual(others, { hasDom: false, count: 144 * 144, reason: "NOT_FINITE", frames: 5, role: "operator" }, JSON.stringify(said));
    assert.ok(appliedTick > 0);
    assert.ok(readFileSync(join(folder, "dist/worker.js"), "utf8").length < 500_000);
  });
});
