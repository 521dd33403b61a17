// A scene in a server of its own, and the page that shows it: paused, advanced tick by tick, drawn on request (`?pictures=stepped`). So a
// picture depends on the tick alone, not on the speed of the machine.
import assert from "node:assert/strict";

import { startClass, startServer } from "../server.mjs";

/** Of every shipped scene. */
export const kTickRateHz = 60;
const kWaitMs = 180_000;
/** Most ticks of one command. */
const kStepMaxTicks = 600;
/** Pictures that are not kept are small, because they cost by the pixel. */
const kSmallWidthPx = 64;
/** A light fades within 1.2 s of the pictures' clock. */
const kFadeS = 2;
/** The page's panels; only the canvas is kept. */
const kBare = "body > :not(canvas), #card, #panel, #panel-toggle, #toast { display: none !important }";

/** Rejects where `promise` takes longer. */
async function within(promise, what) {
  let timer;
  const late = new Promise((_, reject) => (timer = setTimeout(() => reject(new Error(`waited ${kWaitMs / 1000} s for ${what}`)), kWaitMs)));
  try {
    return await Promise.race([promise, late]);
  } finally {
    clearTimeout(timer);
  }
}

export class DrivenPage {
  #server;
  /** Of the operator of a class. */
  #token;
  #page;
  #size;
  /** Frames up to this tick are in the page; the picture shows `shownTick`. */
  #tick = 0;
  #shownTick = 0;

  /** Errors that the browser reported. */
  complaints = [];

  /**
   * Starts the scene at tick 0.
   * @param {import("playwright-core").BrowserContext} context
   * @param {{scene?: string, quality: string, light?: string, size: {width: number, height: number}, query?: string}} what without a
   *   scene a class, whose projector shows everything that it shows
   */
  static async open(context, { scene, quality, light = "noon", size, query = "" }) {
    const driven = new DrivenPage();
    if (scene) driven.#server = await startServer(0, ["--device", "software", "--scene", scene]);
    else ({ server: driven.#server, token: driven.#token } = await startClass(["--device", "software"]));
    try {
      await driven.#start(context, `quality=${quality}&light=${light.replaceAll(" ", "-")}${query && `&${query}`}`, size);
    } catch (error) {
      await driven.close();
      throw error;
    }
    return driven;
  }

  async #start(context, query, size) {
    const page = (this.#page = await context.newPage());
    page.on("pageerror", (error) => this.complaints.push(`uncaught: ${error.stack ?? error.message}`));
    page.on("console", (message) => {
      if (message.type() === "error" || /GL_INVALID/.test(message.text())) this.complaints.push(`console: ${message.text()}`);
    });
    await page.setViewportSize({ width: kSmallWidthPx, height: Math.round((kSmallWidthPx * size.height) / size.width) });
    await page.goto(`${this.#server.url}?pictures=stepped&${query}${this.#token ? `&class#token=${this.#token}` : ""}`, { timeout: kWaitMs });
    if (!this.#token) await page.addStyleTag({ content: kBare });
    await page.waitForFunction(() => window.spindrift?.stats().connectionState === "live", undefined, { timeout: kWaitMs, polling: 20 });
    await page.evaluate((access) => {
      window.command = async (action) => {
        const answer = await fetch("/api/v1/rooms/main/commands", { method: "POST", headers: { "Content-Type": "application/json", ...access }, body: JSON.stringify(action) });
        if (!answer.ok) throw new Error(`${JSON.stringify(action)}: ${await answer.text()}`);
      };
      const detail = document.querySelector('[data-testid="detail"]');
      detail.value = "full";
      detail.dispatchEvent(new Event("change"));
    }, this.#token ? { Authorization: `Bearer ${this.#token}` } : {});
    await this.command({ set_paused: { paused: true } });
    await this.command({ reset: {} });
    await within(page.evaluate(() => window.spindrift.stepped.take(0)), "the first frames");
    this.#size = size;
    await this.#resize(true);
  }

  get port() {
    return this.#server.port;
  }

  /** The last tick that was simulated. */
  get tick() {
    return this.#tick;
  }

  stats() {
    return this.#page.evaluate(() => window.spindrift.stats());
  }

  /** Evaluates a function in the page. */
  evaluate(body, argument) {
    return this.#page.evaluate(body, argument);
  }
  evaluateHandle(body, argument) {
    return this.#page.evaluateHandle(body, argument);
  }

  /** Sends a command by REST; it has been applied when this returns. */
  command(action) {
    return within(this.#page.evaluate((wanted) => window.command(wanted), action), JSON.stringify(action));
  }

  /** Simulates up to `tick` without pictures. */
  async skipTo(tick) {
    while (this.#tick < tick) await this.#advance(Math.min(tick - this.#tick, kStepMaxTicks), 0);
  }

  /**
   * Takes every tick up to `tick` that is a multiple of `stride` after the last one, so that white water and wet ground are there.
   * The page is one stride behind the newest frames: rates of change need the frame before and the one after.
   */
  async followTo(tick, stride) {
    const count = (tick + stride - this.#tick) / stride;
    if (count <= 0) return;
    assert.ok(Number.isInteger(count), `tick ${tick} is not a multiple of ${stride} after ${this.#tick}`);
    for (let i = 0; i < count; ++i) await this.goOn(stride);
  }

  /** Continues by `stride` ticks; picture() draws. */
  async goOn(stride) {
    await this.#advance(stride, stride);
  }

  /** Simulates `count` ticks, takes their last frames, and, with `behind`, follows the water so many ticks before them. */
  async #advance(count, behind) {
    this.#tick += count;
    this.#shownTick = this.#tick - behind;
    await within(
      this.#page.evaluate(
        async ({ ticks, timeS, shownS, remembers }) => {
          const { stepped } = window.spindrift;
          const frames = stepped.take(timeS);
          await window.command({ step: { tick_count: ticks } });
          await frames;
          if (remembers) stepped.remember(shownS);
        },
        { ticks: count, timeS: this.#tick / kTickRateHz, shownS: this.#shownTick / kTickRateHz, remembers: behind > 0 },
      ),
      `the frames of tick ${this.#tick}`,
    );
  }

  /** Chooses a light preset; its fade is over with the next picture. */
  async light(name) {
    await this.#resize(true);
    await this.#page.evaluate(
      ({ preset, timeS, fadeS }) => {
        const row = document.querySelector('[data-testid="light"]');
        row.value = preset;
        row.dispatchEvent(new Event("change"));
        const { stepped } = window.spindrift;
        stepped.draw(timeS);
        stepped.pass(fadeS);
        stepped.draw(timeS);
      },
      { preset: name, timeS: this.#shownTick / kTickRateHz, fadeS: kFadeS },
    );
  }

  /** Places the camera, metres. */
  look({ eyeM, targetM }) {
    return this.#page.evaluate(([eye, target]) => window.spindrift.stepped.look(eye, target), [eyeM, targetM]);
  }

  /** Returns the light presets of the page. */
  lights() {
    return this.#page.evaluate(() => [...document.querySelectorAll('[data-testid="light"] option')].map(({ value }) => value));
  }

  /**
   * Draws the shown tick and returns the picture as a file.
   * @param {{type?: string, quality?: number}} as
   */
  async picture({ type = "image/png", quality } = {}) {
    await this.#resize(false);
    const url = await within(
      this.#page.evaluate(
        ({ timeS, as, share }) => {
          window.spindrift.stepped.draw(timeS);
          return document.getElementById("view").toDataURL(as, share);
        },
        { timeS: this.#shownTick / kTickRateHz, as: type, share: quality },
      ),
      "a picture",
    );
    return Buffer.from(url.slice(url.indexOf(",") + 1), "base64");
  }

  /** Draws the shown tick as a small picture that is not kept, for what follows from picture to picture. */
  async glance() {
    await this.#resize(true);
    await this.#page.evaluate((timeS) => window.spindrift.stepped.draw(timeS), this.#shownTick / kTickRateHz);
  }

  /** Draws the shown tick and returns the window, with what lies over the canvas, as a PNG file. */
  async windowPicture() {
    await this.picture();
    // Panels that fade in or out have done so.
    return this.#page.screenshot({ timeout: kWaitMs, animations: "disabled" });
  }

  async close() {
    await this.#page?.close();
    await this.#server.stop("SIGTERM");
  }

  async #resize(isSmall) {
    const { width, height } = this.#size;
    const wanted = isSmall ? { width: kSmallWidthPx, height: Math.round((kSmallWidthPx * height) / width) } : this.#size;
    const now = this.#page.viewportSize();
    if (now.width === wanted.width && now.height === wanted.height) return;
    await this.#page.setViewportSize(wanted);
    await this.#page.evaluate(() => window.dispatchEvent(new Event("resize")));
  }
}
