// The server behind nginx and behind Caddy with TLS, configured as docs/operations.md says. Skipped where the proxy or openssl is missing.
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:net";
import { get } from "node:https";
import { tmpdir } from "node:os";
import { join } from "node:path";
import WebSocket from "ws";

import { repository, startServer } from "../browser/server.mjs";

const has = (program) => spawnSync(program, ["-h"], { env: { PATH: "/usr/sbin:/usr/bin:/bin" } }).error === undefined;
const kStartLimitMs = 10_000;

async function freePort() {
  const probe = createServer().listen(0, "127.0.0.1");
  await new Promise((resolve) => probe.on("listening", resolve));
  const { port } = probe.address();
  await new Promise((resolve) => probe.close(resolve));
  return port;
}

/** Returns the block of documentation in this language with its texts replaced, each of which must be there. */
function documented(language, replaced) {
  const page = readFileSync(`${repository}/docs/operations.md`, "utf8");
  const block = new RegExp(`\`\`\`${language}\\n([^]*?)\`\`\``).exec(page)?.[1];
  return replaced.reduce((text, [from, to]) => {
    expect(text).toContain(from);
    return text.replace(from, to);
  }, block);
}

const environment = (folder) => ({ PATH: "/usr/sbin:/usr/bin:/bin", HOME: folder, XDG_DATA_HOME: folder, XDG_CONFIG_HOME: folder });

/** Each starts a proxy on this port in front of the server, with chain.pem and key.pem of the folder. */
const starters = {
  nginx(port, server_port, folder) {
    const block = documented("nginx", [
      ["listen 443 ssl", `listen 127.0.0.1:${port} ssl`],
      ["/etc/letsencrypt/live/water.example.org/fullchain.pem", `${folder}/chain.pem`],
      ["/etc/letsencrypt/live/water.example.org/privkey.pem", `${folder}/key.pem`],
      ["127.0.0.1:8080", `127.0.0.1:${server_port}`],
    ]);
    const temporary = ["client_body", "proxy", "fastcgi", "uwsgi", "scgi"].map((name) => `${name}_temp_path ${folder}/${name};`);
    writeFileSync(`${folder}/nginx.conf`, `pid ${folder}/pid; error_log stderr; events {} http { access_log off; ${temporary.join(" ")}\n${block} }`);
    return ["-p", folder, "-c", `${folder}/nginx.conf`, "-g", "daemon off;"];
  },
  caddy(port, server_port, folder) {
    const block = documented("caddy", [
      ["water.example.org {", `https://127.0.0.1:${port} {\n    bind 127.0.0.1\n    tls ${folder}/chain.pem ${folder}/key.pem`],
      ["127.0.0.1:8080", `127.0.0.1:${server_port}`],
    ]);
    writeFileSync(`${folder}/Caddyfile`, `{\n    admin off\n    auto_https disable_redirects\n}\n${block}`);
    return ["run", "--adapter", "caddyfile", "--config", `${folder}/Caddyfile`];
  },
};

describe.each(Object.keys(starters))("behind %s with TLS", (name) => {
  describe.skipIf(!has(name) || !has("openssl"))("where it is installed", () => {
    const folder = mkdtempSync(join(tmpdir(), `spindrift-${name}-`));
    let server;
    let proxy;
    let port;
    let ca;

    beforeAll(async () => {
      const names = ["-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1"];
      execFileSync("openssl", ["req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", ...names, "-keyout", `${folder}/key.pem`, "-out", `${folder}/chain.pem`], { stdio: "ignore" });
      ca = readFileSync(`${folder}/chain.pem`);
      // One session per address.
      server = await startServer(0, ["--scene", `${repository}/tests/browser/tank.textproto`, "--trust-proxy", "127.0.0.1", "--address-share", "0"]);
      port = await freePort();
      proxy = spawn(name, starters[name](port, server.port, folder), { env: environment(folder), stdio: ["ignore", "ignore", "pipe"] });
      let words = "";
      proxy.stderr.setEncoding("utf8").on("data", (text) => (words += text));
      const begin = Date.now();
      while ((await status("/healthz").catch(() => 0)) !== 200) {
        if (proxy.exitCode !== null || Date.now() - begin > kStartLimitMs) throw new Error(`${name} does not serve: ${words}`);
        await new Promise((resolve) => setTimeout(resolve, 50));
      }
    });
    afterAll(async () => {
      if (proxy && proxy.exitCode === null) {
        proxy.kill("SIGQUIT");
        await new Promise((resolve) => proxy.on("exit", resolve));
      }
      await server?.stop("SIGTERM");
      rmSync(folder, { recursive: true });
    });

    const options = (from, more = {}) => ({ ca, localAddress: from, headers: more });

    function status(path, headers = {}) {
      return new Promise((resolve, reject) => {
        get({ host: "127.0.0.1", port, path, ...options("127.0.0.2", headers) }, (answer) => {
          answer.resume();
          resolve(answer.statusCode);
        }).on("error", reject);
      });
    }

    /** Opens a session from this address; resolves to the socket, or to the status of the refusal. */
    function open(from, headers = {}) {
      const socket = new WebSocket(`wss://127.0.0.1:${port}/ws`, "spindrift.v1", options(from, headers));
      return new Promise((resolve, reject) => {
        socket.on("message", () => resolve(socket));
        socket.on("unexpected-response", (_, answer) => resolve(answer.statusCode));
        socket.on("error", reject);
      });
    }

    it("serves the page and opens sessions for it", async () => {
      expect(await status("/")).toBe(200);
      const socket = await open("127.0.0.3", { Origin: `https://127.0.0.1:${port}` });
      expect(socket.protocol).toBe("spindrift.v1");
      socket.terminate();
      expect(await open("127.0.0.4", { Origin: "https://elsewhere.example" })).toBe(403);
    });

    it("gives every client limits of its own, whatever the client claims", async () => {
      const first = await open("127.0.0.5");
      const second = await open("127.0.0.6");
      expect(first.readyState).toBe(WebSocket.OPEN);
      expect(second.readyState).toBe(WebSocket.OPEN);
      expect(await open("127.0.0.5", { "X-Forwarded-For": "203.0.113.1" })).toBe(503);
      first.terminate();
      second.terminate();
    });
  });
});
