// A server with a browser, whose pages are watched for errors, and what a visitor does in such a page.
import { cameraAtRest, launch, WAIT_MS, waitFor } from "./chromium.mjs";
import { startServer } from "./server.mjs";

export class Visit {
  /** Errors that the browser reported. */
  complaints = [];
  /** While the server is down on purpose, a refused connection is not an error. */
  isServerDown = false;

  /** Starts the server with the scenes of this folder, and the browser; returns a page of the main room. */
  async begin() {
    this.server = await startServer();
    this.browser = await launch();
    this.context = await this.browser.newContext({ viewport: { width: 900, height: 600 } });
    // Not the first visit: the line about drawing would be in the pictures.
    await this.context.addInitScript(() => localStorage.setItem("spindrift.has-drawn", "1"));
    return this.open();
  }

  /** Opens a page of a room, and waits until frames of `layer` arrive. */
  async open(room = "main", layer = "surface") {
    const page = await this.context.newPage();
    page.setDefaultTimeout(WAIT_MS);
    page.on("pageerror", (error) => this.complaints.push(`uncaught: ${error.stack ?? error.message}`));
    page.on("console", (message) => {
      // The browser reports a draw call that it refuses as a warning.
      if (message.type() !== "error" && !/GL_INVALID/.test(message.text())) return;
      if (this.isServerDown && /WebSocket connection|ERR_CONNECTION/.test(message.text())) return;
      this.complaints.push(`console: ${message.text()} (${message.location().url})`);
    });
    await page.goto(`${this.server.url}?quality=minimal&room=${room}`, { timeout: WAIT_MS });
    await waitFor(page, "the page to be live", (stats) => stats.connectionState === "live" && stats.framesReceived[layer] > 0);
    return page;
  }

  async end() {
    await this.browser?.close();
    await this.server?.stop("SIGKILL");
  }
}

export const statsOf = (page) => page.evaluate(() => window.spindrift?.stats());

/** Calls `press`, waits for the acknowledgement of a newer command, and returns the page's numbers. */
export async function acknowledged(page, press, what = "an acknowledgement") {
  const last = (await statsOf(page)).lastAck?.commandId ?? 0;
  await press();
  return waitFor(page, what, (stats) => (stats.lastAck?.commandId ?? 0) > last);
}

export const pressed = (page, testId) => acknowledged(page, () => page.getByTestId(testId).click());

/** Waits until the heights of the water differ by more than this. */
export const moving = (page, what = "the surface to move", byM = 0.1) => waitFor(page, what, ({ maxElevationM, minElevationM }) => maxElevationM - minElevationM > byM);

/** Returns to the first view, and waits until the camera is there. */
export async function startView(page) {
  await page.getByTestId("view-start").click();
  await waitFor(page, "the view", ({ view }) => view === "start");
  await cameraAtRest(page);
}

/** Resets the room, so that every test starts with still water. */
export async function stillWater(page) {
  await pressed(page, "reset");
  await waitFor(page, "still water", (stats) => stats.maxElevationM - stats.minElevationM < 0.02);
}

/** Waits until pictures were drawn for this long, and three more. */
export function drawnPictures(page, during_ms) {
  return page.evaluate(async (wanted_ms) => {
    const picture = () => new Promise((drawn) => requestAnimationFrame(drawn));
    for (const start = performance.now(); performance.now() < start + wanted_ms; ) await picture();
    for (let i = 0; i < 3; ++i) await picture();
  }, during_ms);
}

/** Waits until the newest surface frame is drawn: pictures follow the frames after a delay that grows on a busy machine. */
export async function newestIsDrawn(page) {
  // After a reset the picture before it has the larger time: one picture more takes the new one.
  await drawnPictures(page, 0);
  const { surfaceTimeS } = await statsOf(page);
  await waitFor(page, `the surface of ${surfaceTimeS} s to be drawn`, (stats) => stats.shownTimeS >= surfaceTimeS);
  await drawnPictures(page, 0);
}
