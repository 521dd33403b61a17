// The pictures of the README's table, at high quality: web-client/screenshots.
import { join } from "node:path";

import { repository } from "../server.mjs";
import { DrivenPage } from "./driven_page.mjs";
import { kFile, write } from "./pictures.mjs";
import { setUp, shotOf } from "./shots.mjs";

const kFolder = join(repository, "web-client/screenshots");
const kScenes = ["splash", "breaking_wave", "flotsam", "dam_break", "kelvin", "rain_rings", "beach", "island"];
const kSize = { width: 880, height: 495 };

/** @param {import("playwright-core").BrowserContext} context */
export async function* shootReadme(context) {
  for (const scene of kScenes) {
    const page = await DrivenPage.open(context, { scene, quality: "high", size: kSize });
    try {
      await setUp(page, shotOf(scene));
      // As a visitor sees it.
      await page.light("automatic");
      const path = join(kFolder, `${scene}.webp`);
      write(path, await page.picture(kFile));
      yield path;
    } finally {
      await page.close();
    }
  }
}
