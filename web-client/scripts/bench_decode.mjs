// npm run bench -- FRAMES [--chromium]: measures the time to read packed frames. FRAMES is a file made by
// `build/release/tests/packed_frames tests/bench/decode_target.textproto 20 FRAMES`.
import { spawn } from "node:child_process";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import path from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { build } from "vite";

const kRounds = 20;
const kChromium = ["--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];

const root = path.dirname(path.dirname(fileURLToPath(import.meta.url)));
const [file, ...options] = process.argv.slice(2);
if (!file) {
  console.error("usage: npm run bench -- FRAMES [--chromium]");
  process.exit(2);
}
const folder = await mkdtemp(path.join(tmpdir(), "spindrift-bench-"));
try {
  await build({
    configFile: false, root, logLevel: "error",
    build: { outDir: folder, emptyOutDir: true, minify: false, target: "es2022", lib: { entry: path.join(root, "scripts/decode_times.ts"), formats: ["es"], fileName: () => "bench.mjs" } },
  });
  const times = options.includes("--chromium") ? await inChromium() : await inNode();
  print(options.includes("--chromium") ? "chromium, worker" : `node ${process.version}`, times);
} finally {
  await rm(folder, { recursive: true, force: true });
}

async function inNode() {
  const { measureDecoding } = await import(pathToFileURL(path.join(folder, "bench.mjs")));
  return measureDecoding(new Uint8Array(await readFile(file)), kRounds);
}

/** Measures in a worker of a page, which posts its result back. */
async function inChromium() {
  const worker = `import { measureDecoding } from "/bench.mjs";
    const file = new Uint8Array(await (await fetch("/frames")).arrayBuffer());
    try { await fetch("/done", { method: "POST", body: JSON.stringify(measureDecoding(file, ${kRounds})) }); }
    catch (error) { await fetch("/done", { method: "POST", body: JSON.stringify({ error: String(error) }) }); }`;
  await writeFile(path.join(folder, "worker.mjs"), worker);
  const page = `<!doctype html><script type="module">new Worker("/worker.mjs", { type: "module" });</script>`;
  // Isolated pages have clocks of 5 us instead of 100.
  const isolated = { "Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Embedder-Policy": "require-corp" };
  let browser;
  const server = createServer();
  try {
    return await new Promise((resolve, reject) => {
      server.on("request", async (request, response) => {
        if (request.url === "/done") {
          let body = "";
          for await (const part of request) body += part;
          response.end();
          const result = JSON.parse(body);
          if (result.error) reject(new Error(result.error));
          else resolve(result);
        } else if (request.url === "/frames") {
          response.writeHead(200, isolated).end(await readFile(file));
        } else if (request.url?.endsWith(".mjs")) {
          response.writeHead(200, { ...isolated, "Content-Type": "text/javascript" }).end(await readFile(path.join(folder, path.basename(request.url))));
        } else {
          response.writeHead(200, { ...isolated, "Content-Type": "text/html" }).end(page);
        }
      });
      server.listen(0, "127.0.0.1", () => {
        const args = [...kChromium, `--user-data-dir=${path.join(folder, "profile")}`, `http://127.0.0.1:${server.address().port}/`];
        browser = spawn("chromium", args, { stdio: "ignore" });
        browser.on("error", reject);
        browser.on("exit", () => reject(new Error("chromium ended")));
      });
    });
  } finally {
    server.close();
    server.closeAllConnections();
    if (browser?.exitCode === null) {
      const ended = new Promise((resolve) => browser.on("exit", resolve));
      browser.kill();
      await ended;
    }
  }
}

function print(where, times) {
  console.log(`${where}: ${times.particles} particles, ${times.resolution} x ${times.resolution} samples, ${times.bothMs.length} frames, ms`);
  console.log("            least   median      p99");
  for (const [name, list] of [["surface", times.surfaceMs], ["particles", times.particlesMs], ["both", times.bothMs]]) {
    const at = (share) => list[Math.min(Math.floor(share * list.length), list.length - 1)].toFixed(2).padStart(8);
    console.log(`${name.padEnd(9)}${at(0)} ${at(0.5)} ${at(0.99)}`);
  }
}
