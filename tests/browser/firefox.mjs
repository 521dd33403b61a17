// Firefox with software WebGL, driven by WebDriver BiDi, which every Firefox speaks. Without a window Firefox has no WebGL 2 here (its headless
// mode finds no GL driver), so it gets an X server of its own.
import { spawn } from "node:child_process";
import { existsSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { createInterface } from "node:readline";

import { WebSocket } from "ws";

import { temporaryFolder } from "./server.mjs";

const executable = process.env.FIREFOX ?? ["/usr/bin/firefox-esr", "/usr/bin/firefox"].find(existsSync) ?? "/usr/bin/firefox-esr";
const kXvfb = "/usr/bin/Xvfb";
const START_MS = 120_000;
const kPreferences = { "webgl.force-enabled": true, "browser.shell.checkDefaultBrowser": false, "datareporting.policy.dataSubmissionEnabled": false, "app.update.enabled": false, "network.captive-portal-service.enabled": false, "network.connectivity-service.enabled": false };

/** False, or why Firefox cannot run here. */
export const skip = [executable, kXvfb].every(existsSync) ? false : `Firefox or Xvfb is missing (${executable}, ${kXvfb}); install firefox-esr and xvfb, or set FIREFOX`;

/** Starts a process and returns it with the first match of `pattern` in a line of one of its outputs. */
function started(command, args, options, output, pattern) {
  const child = spawn(command, args, options);
  let words = "";
  return new Promise((resolve, reject) => {
    const timer = setTimeout(() => {
      child.kill("SIGKILL");
      reject(new Error(`${command} did not say ${pattern} within ${START_MS / 1000} s:\n${words}`));
    }, START_MS);
    child.on("error", reject);
    child.on("exit", (code) => reject(new Error(`${command} ended with ${code}:\n${words}`)));
    createInterface({ input: child.stdio[output] }).on("line", (line) => {
      words = `${words}${line}\n`.slice(-2000);
      const match = pattern.exec(line);
      if (!match) return;
      clearTimeout(timer);
      resolve({ child, match });
    });
  });
}

/** One page of a new Firefox with a new profile; close() ends it. */
export class FirefoxPage {
  #children;
  #profile;
  #socket;
  #context;
  #lastId = 0;
  #answers = new Map();
  /** Errors that the page threw or wrote to the console. */
  complaints = [];

  static async open(viewport) {
    const page = new FirefoxPage();
    page.#children = [];
    page.#profile = temporaryFolder("firefox");
    try {
      await page.#start(viewport);
    } catch (error) {
      await page.close();
      throw error;
    }
    return page;
  }

  async #start(viewport) {
    writeFileSync(join(this.#profile, "user.js"), Object.entries(kPreferences).map(([name, value]) => `user_pref(${JSON.stringify(name)}, ${value});\n`).join(""));
    const x = await started(kXvfb, ["-displayfd", "3", "-screen", "0", "1280x900x24", "-nolisten", "tcp"], { stdio: ["ignore", "ignore", "ignore", "pipe"] }, 3, /^(\d+)$/);
    this.#children.push(x.child);
    const environment = { ...process.env, DISPLAY: `:${x.match[1]}`, LIBGL_ALWAYS_SOFTWARE: "1", MOZ_WEBRENDER: "1", HOME: this.#profile };
    delete environment.WAYLAND_DISPLAY;
    const browser = await started(executable, ["--profile", this.#profile, "--no-remote", "--remote-debugging-port", "0", "about:blank"], { stdio: ["ignore", "ignore", "pipe"], env: environment }, 2, /WebDriver BiDi listening on (ws:\S+)/);
    this.#children.push(browser.child);
    this.#socket = new WebSocket(`${browser.match[1]}/session`);
    await new Promise((opened, failed) => this.#socket.once("open", opened).once("error", failed));
    this.#socket.on("message", (data) => this.#take(JSON.parse(String(data))));
    await this.#ask("session.new", { capabilities: {} });
    await this.#ask("session.subscribe", { events: ["log.entryAdded"] });
    this.#context = (await this.#ask("browsingContext.create", { type: "tab" })).context;
    await this.#ask("browsingContext.setViewport", { context: this.#context, viewport });
  }

  async goto(url) {
    await this.#ask("browsingContext.navigate", { context: this.#context, url, wait: "interactive" });
  }

  /** Returns what a JavaScript expression, or a promise of it, is in the page; it has to be JSON. */
  async evaluate(expression) {
    const answer = await this.#ask("script.evaluate", { expression: `Promise.resolve(${expression}).then((value) => JSON.stringify(value, (_, each) => (typeof each === "bigint" ? String(each) : each)))`, target: { context: this.#context }, awaitPromise: true });
    if (answer.type === "exception") throw new Error(`${expression}: ${answer.exceptionDetails.text}`);
    return answer.result.type === "string" ? JSON.parse(answer.result.value) : undefined;
  }

  /** A click of the mouse in CSS pixels of the window. */
  async click(x, y) {
    const actions = [{ type: "pointerMove", x: Math.round(x), y: Math.round(y) }, { type: "pointerDown", button: 0 }, { type: "pointerUp", button: 0 }];
    await this.#ask("input.performActions", { context: this.#context, actions: [{ type: "pointer", id: "mouse", parameters: { pointerType: "mouse" }, actions }] });
  }

  /** Returns a picture of the window (PNG). */
  async screenshot() {
    return Buffer.from((await this.#ask("browsingContext.captureScreenshot", { context: this.#context })).data, "base64");
  }

  async close() {
    if (this.#context) await this.#ask("browser.close", {}).catch(() => {});
    this.#socket?.terminate();
    for (const child of this.#children.reverse()) {
      if (child.exitCode !== null || child.signalCode !== null) continue;
      const ended = new Promise((done) => child.once("exit", done));
      child.kill("SIGTERM");
      const timer = setTimeout(() => child.kill("SIGKILL"), 10_000);
      await ended;
      clearTimeout(timer);
    }
    rmSync(this.#profile, { recursive: true, force: true, maxRetries: 10 });
  }

  #take(message) {
    if (message.method === "log.entryAdded" && message.params.level === "error") this.complaints.push(message.params.text);
    const answer = this.#answers.get(message.id);
    this.#answers.delete(message.id);
    if (message.type === "success") answer?.resolve(message.result);
    else if (message.type === "error") answer?.reject(new Error(`${message.error}: ${message.message}`));
  }

  #ask(method, params) {
    const id = ++this.#lastId;
    this.#socket.send(JSON.stringify({ id, method, params }));
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`Firefox did not answer ${method} within ${START_MS / 1000} s`)), START_MS);
      const done = (settle) => (value) => {
        clearTimeout(timer);
        settle(value);
      };
      this.#answers.set(id, { resolve: done(resolve), reject: done(reject) });
    });
  }
}
