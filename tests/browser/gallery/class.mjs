// The pictures of docs/class.md: a projector in a race, a pad in it, and the operator's controls in a ball game.
import { join } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";

import { Crowd } from "../crowd.mjs";
import { repository } from "../server.mjs";
import { encodedAs } from "./compare.mjs";
import { DrivenPage } from "./driven_page.mjs";
import { kFile, write } from "./pictures.mjs";

const kFolder = join(repository, "web-client/screenshots");
const kSize = { width: 1120, height: 630 };
const kPad = { viewport: { width: 390, height: 760 }, hasTouch: true, isMobile: true };
const kBoats = 14;
const kStride = 12;
/** The crowd sees the frames of one command and its pads send the next. */
const kLinkMs = 60;
const kWaitMs = 60_000;
/** Simulated time before each picture. */
const kPadS = 6;
const kRaceS = 17;
const kBallS = 14;

/** Lets the crowd play for a while. The projector's camera moves with each picture. */
async function play(page, crowd, seconds) {
  const until = page.tick + Math.round((60 * seconds) / kStride) * kStride;
  while (page.tick < until) {
    crowd.play();
    await sleep(kLinkMs);
    await page.goOn(kStride);
    await page.glance();
  }
}

/** @param {import("playwright-core").BrowserContext} context */
export async function* shootClass(context) {
  const browser = context.browser();
  const page = await DrivenPage.open(context, { quality: "high", light: "noon", size: kSize });
  const phone = await browser.newContext(kPad);
  const scratch = await context.newPage();
  const keep = async (name, png) => {
    const path = join(kFolder, `${name}.webp`);
    write(path, await encodedAs(scratch, png, kFile));
    return path;
  };
  let crowd;
  try {
    crowd = await Crowd.open({ port: page.port, boats: kBoats, drawers: 0 });
    crowd.launch();
    const pad = await phone.newPage();
    await pad.goto(`http://127.0.0.1:${page.port}/pad`, { timeout: kWaitMs });
    await pad.getByTestId("pad-tool-boat").tap({ timeout: kWaitMs });
    await pad.getByTestId("pad-launch").tap();
    await play(page, crowd, 0.4);
    await page.command({ start_game: { kind: "GAME_KIND_RACE", countdown_s: 1 } });
    const stick = await pad.getByTestId("pad-stick").boundingBox({ timeout: kWaitMs });
    await pad.mouse.move(stick.x + stick.width / 2, stick.y + stick.height / 2);
    await pad.mouse.down();
    await pad.mouse.move(stick.x + stick.width / 2, stick.y);
    await play(page, crowd, kPadS);
    yield keep("class_pad", await pad.screenshot({ timeout: kWaitMs }));
    await play(page, crowd, kRaceS - kPadS);
    yield keep("class_race", await page.windowPicture());
    await page.command({ end_game: {} });
    await page.command({ set_lesson: { lesson: { teams: true } } });
    await page.command({ start_game: { kind: "GAME_KIND_BALL", countdown_s: 1 } });
    await play(page, crowd, kBallS);
    // In the window's full size, where the controls stay where they are scrolled to.
    await page.picture();
    await page.evaluate(() => {
      // Controls hide a few seconds after the mouse has moved, and a picture takes longer.
      setInterval(() => window.dispatchEvent(new Event("pointermove")), 500);
      document.getElementById("panel-toggle").click();
      const box = document.getElementById("class-box");
      box.open = true;
      box.scrollIntoView();
    });
    yield keep("class_ball", await page.windowPicture());
    if (page.complaints.length > 0) throw new Error(`class: ${page.complaints.join("; ")}`);
  } finally {
    await crowd?.close();
    await phone.close();
    await scratch.close();
    await page.close();
  }
}
