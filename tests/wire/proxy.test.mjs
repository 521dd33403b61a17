// The server behind nginx and behind Caddy with TLS, at / and under a path, configured as docs/operations/secure.md says. Skipped where the proxy
// or openssl is missing.
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { readFileSync, rmSync, writeFileSync } from "node:fs";
import { get } from "node:https";
import { join } from "node:path";
import WebSocket from "ws";

import { freePort, repository, startServer, temporaryFolder } from "../browser/server.mjs";

const has = (program) => spawnSync(program, ["-h"], { env: { PATH: "/usr/sbin:/usr/bin:/bin" } }).error === undefined;
const kStartLimitMs = 10_000;

/** Returns the blocks of documentation in this language: for the host as a whole, and for a path. */
function documented(language) {
  const page = readFileSync(`${repository}/docs/operations/secure.md`, "utf8");
  return [...page.matchAll(new RegExp(`\`\`\`${language}\\n([^]*?)\`\`\``, "g"))].map((match) => match[1]);
}

/** Replaces texts, each of which must be there. */
function replaced(text, pairs) {
  return pairs.reduce((before, [from, to]) => {
    expect(before).toContain(from);
    return before.replace(from, to);
  }, text);
}

const environment = (folder) => ({ PATH: "/usr/sbin:/usr/bin:/bin", HOME: folder, XDG_DATA_HOME: folder, XDG_CONFIG_HOME: folder });

/** Each returns the arguments of a proxy on this port in front of the server, with chain.pem and key.pem of the folder, at / or under /water/. */
const starters = {
  nginx(port, server_port, folder, base) {
    const [whole, location] = documented("nginx");
    const root = /^ *location \/ \{\n.*\n/m.exec(whole)[0];
    const block = replaced(base === "/" ? whole : whole.replace(root, location), [
      ["listen 443 ssl", `listen 127.0.0.1:${port} ssl`],
      ["/etc/letsencrypt/live/water.example.org/fullchain.pem", `${folder}/chain.pem`],
      ["/etc/letsencrypt/live/water.example.org/privkey.pem", `${folder}/key.pem`],
      ["127.0.0.1:8080", `127.0.0.1:${server_port}`],
    ]);
    const temporary = ["client_body", "proxy", "fastcgi", "uwsgi", "scgi"].map((name) => `${name}_temp_path ${folder}/${name};`);
    writeFileSync(`${folder}/nginx.conf`, `pid ${folder}/pid; error_log stderr; events {} http { access_log off; ${temporary.join(" ")}\n${block} }`);
    return ["-p", folder, "-c", `${folder}/nginx.conf`, "-g", "daemon off;"];
  },
  caddy(port, server_port, folder, base) {
    const [whole, location] = documented("caddy");
    const block = replaced(base === "/" ? whole : location, [
      ["water.example.org {", `https://127.0.0.1:${port} {\n    bind 127.0.0.1\n    tls ${folder}/chain.pem ${folder}/key.pem`],
      ["127.0.0.1:8080", `127.0.0.1:${server_port}`],
    ]);
    writeFileSync(`${folder}/Caddyfile`, `{\n    admin off\n    auto_https disable_redirects\n}\n${block}`);
    return ["run", "--adapter", "caddyfile", "--config", `${folder}/Caddyfile`];
  },
};

const kPlaces = Object.keys(starters).flatMap((name) => ["/", "/water/"].map((base) => [name, base]));
describe.each(kPlaces)("behind %s with TLS at %s", (name, base) => {
  describe.skipIf(!has(name) || !has("openssl"))("where it is installed", () => {
    const folder = temporaryFolder(`${name}`);
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
      proxy = spawn(name, starters[name](port, server.port, folder, base), { env: environment(folder), stdio: ["ignore", "ignore", "pipe"] });
      let words = "";
      proxy.stderr.setEncoding("utf8").on("data", (text) => (words += text));
      const begin = Date.now();
      while ((await status("healthz").catch(() => 0)) !== 200) {
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

    /** `path`: relative to the page. */
    function ask(path, headers = {}) {
      return new Promise((resolve, reject) => {
        get({ host: "127.0.0.1", port, path: new URL(path, `https://host${base}`).pathname, ...options("127.0.0.2", headers) }, (answer) => {
          let text = "";
          answer.setEncoding("utf8").on("data", (more) => (text += more));
          answer.on("end", () => resolve({ status: answer.statusCode, headers: answer.headers, text }));
        }).on("error", reject);
      });
    }
    const status = async (path) => (await ask(path)).status;

    /** Opens a session from this address; resolves to the socket, or to the status of the refusal. */
    function open(from, headers = {}) {
      const socket = new WebSocket(`wss://127.0.0.1:${port}${base}ws`, "spindrift.v1", options(from, headers));
      return new Promise((resolve, reject) => {
        socket.on("message", () => resolve(socket));
        socket.on("unexpected-response", (_, answer) => resolve(answer.statusCode));
        socket.on("error", reject);
      });
    }

    it("serves the page and opens sessions for it", async () => {
      const page = await ask("");
      expect(page.status).toBe(200);
      const parts = [...page.text.matchAll(/(?:href|src)="([^"]+)"/g)].map((match) => match[1]);
      expect(parts.length).toBeGreaterThan(2);
      for (const part of [...parts, "api/v1/rooms"]) expect(await status(part), part).toBe(200);
      const socket = await open("127.0.0.3", { Origin: `https://127.0.0.1:${port}` });
      expect(socket.protocol).toBe("spindrift.v1");
      socket.terminate();
      expect(await open("127.0.0.4", { Origin: "https://elsewhere.example" })).toBe(403);
    });

    it("sends the page compressed, with its tag and a time to keep it", async () => {
      const script = /src="([^"]+\.js)"/.exec((await ask("")).text)[1];
      for (const coding of ["br", "gzip"]) {
        const { headers } = await ask(script, { "Accept-Encoding": coding });
        expect(headers).toMatchObject({ "content-encoding": coding, vary: expect.stringContaining("Accept-Encoding"), "cache-control": expect.stringContaining("immutable"), etag: expect.stringContaining(coding) });
        expect((await ask(script, { "Accept-Encoding": coding, "If-None-Match": headers.etag })).status).toBe(304);
      }
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
