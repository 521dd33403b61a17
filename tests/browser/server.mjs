// The real server as a child process: waits for its ready line, stops it by signal.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync } from "node:fs";
import { createServer } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { setTimeout as sleep } from "node:timers/promises";
import { fileURLToPath } from "node:url";

export const repository = fileURLToPath(new URL("../..", import.meta.url));
export const binary = process.env.SPINDRIFT_BINARY ?? `${repository}/build/release/bin/spindrift`;
/** A reload on a busy machine takes longer than the default grace of 20 s. */
const kGrace = ["--grace", "300"];
const kTestScenes = [...kGrace, "--scene", `${repository}/tests/browser/scene.textproto`, "--room", `marina=${repository}/tests/browser/marina.textproto`, "--room", `sea=${repository}/tests/browser/sea.textproto`, "--room", `tank=${repository}/tests/browser/tank.textproto`];
const START_LIMIT_MS = 120_000;
const STOP_LIMIT_MS = 30_000;
/** Limit of one wait: far above what software WebGL on two cores takes. */
export const WAIT_MS = 120_000;

/**
 * Starts `spindrift serve`, or another command that serves, with the built page.
 * @param {number} port 0 = any free port
 * @param {string[]} scenes options that choose scenes; by default those of this folder
 * @param {string} command "serve" or "edge"
 * @returns {Promise<{url: string, port: number, ended: Promise<{code: number | null, signal: string | null}>, lines: string[], stop: (signal: NodeJS.Signals) => Promise<{code: number | null, signal: string | null}>}>}
 *   `lines`: what the server has printed; rejects with the server's output if it ends before it is ready, or after 120 s
 */
export function startServer(port = 0, scenes = kTestScenes, command = "serve") {
  const child = spawn(
    binary,
    [command, "--port", String(port), "--web-root", process.env.SPINDRIFT_WEB_ROOT ?? `${repository}/web-client/dist`, ...scenes],
    { stdio: ["ignore", "pipe", "pipe"] },
  );
  let words = "";
  child.stderr.setEncoding("utf8").on("data", (text) => {
    words = (words + text).slice(-4000);
  });
  const ended = new Promise((resolve) => {
    child.on("error", (error) => resolve({ code: null, signal: null, error }));
    child.on("exit", (code, signal) => resolve({ code, signal }));
  });

  return new Promise((resolve, reject) => {
    const timer = setTimeout(() => {
      child.kill("SIGKILL");
      reject(new Error(`the server was not ready after ${START_LIMIT_MS / 1000} s:\n${words}`));
    }, START_LIMIT_MS);
    ended.then(({ code, signal, error }) => {
      clearTimeout(timer);
      reject(error ?? new Error(`the server ended before it was ready (code ${code}, signal ${signal}):\n${words}`));
    });
    const lines = [];
    createInterface({ input: child.stdout }).on("line", (line) => {
      lines.push(line);
      const match = /^Spindrift is ready: (https?:\/\/[^/]+:(\d+)\/)/.exec(line);
      if (!match) return;
      clearTimeout(timer);
      resolve({ url: match[1], port: Number(match[2]), ended, lines, stop: (signal) => stop(child, ended, signal) });
    });
  });
}

/**
 * Starts `spindrift serve --class` with phones at http://192.168.1.20:8080/pad.
 * @param {string[]} more options
 * @returns {Promise<{server: Awaited<ReturnType<typeof startServer>>, token: string}>} `token`: of the operator
 */
export async function startClass(more = []) {
  const server = await startServer(0, ["--class", "--address", "127.0.0.1", "--public-url", "http://192.168.1.20:8080", ...more]);
  const deadline_ms = Date.now() + START_LIMIT_MS;
  for (;;) {
    // It comes just after the line that the server is ready.
    const token = /^Projector: .*#token=(\S+)/m.exec(server.lines.join("\n"))?.[1];
    if (token) return { server, token };
    if (Date.now() < deadline_ms) await new Promise((done) => setTimeout(done, 50));
    else {
      await server.stop("SIGTERM");
      throw new Error(`the server did not print the projector's address with a token:\n${server.lines.join("\n")}`);
    }
  }
}

async function stop(child, ended, signal) {
  const timer = setTimeout(() => child.kill("SIGKILL"), STOP_LIMIT_MS);
  child.kill(signal);
  const { code, signal: last_signal } = await ended;
  clearTimeout(timer);
  return { code, signal: last_signal };
}

/** Closes the browser and the server of a test, as far as they were opened. */
export async function ended(browser, server) {
  await browser?.close();
  await server?.stop("SIGTERM");
}

/** Reads until `accept` takes the value, and returns it; the failure has the last one. */
export async function until(what, read, accept = Boolean, patienceMs = WAIT_MS) {
  let value;
  for (const begin = Date.now(); Date.now() - begin < patienceMs; await sleep(50)) {
    value = await read();
    if (accept(value)) return value;
  }
  assert.fail(`waited ${patienceMs / 1000} s for ${what}: ${JSON.stringify(value)}`);
}

/** A port of the loopback that nobody listens on now. */
export async function freePort() {
  const probe = createServer().listen(0, "127.0.0.1");
  await new Promise((resolve) => probe.on("listening", resolve));
  const { port } = probe.address();
  await new Promise((resolve) => probe.close(resolve));
  return port;
}

/** Makes a temporary folder, which the caller removes; returns its path. */
export const temporaryFolder = (name) => mkdtempSync(join(tmpdir(), `spindrift-${name}-`));

/** Sends a value as JSON to a path of the server, with a token if there is one; returns the answer. */
export function post({ port }, path, value, token) {
  const headers = { "Content-Type": "application/json", ...(token && { Authorization: `Bearer ${token}` }) };
  return fetch(`http://127.0.0.1:${port}/${path}`, { method: "POST", headers, body: JSON.stringify(value) });
}

/** Sends a command to a room. */
export const command = (server, action, { room = "main", token } = {}) => post(server, `api/v1/rooms/${room}/commands`, action, token);
