// Makes the pictures of one scene, one per light, and compares them with the kept ones.
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

import { repository } from "../server.mjs";
import { compare, encodePng } from "./compare.mjs";
import { DrivenPage } from "./driven_page.mjs";
import { kSize, setUp, shotOf } from "./shots.mjs";

/** Kept and made pictures are lossy files of the same encoder: 3 to 18 kB each, and equal pictures are equal files. */
export const kFile = { type: "image/webp", quality: 0.8 };
export const kKept = fileURLToPath(new URL("kept", import.meta.url));
export const kMade = join(repository, "build/gallery/pictures");
/** Entry of the page's list of lights that is not a preset. */
const kNoPreset = "hour";

export const nameOf = (quality, scene, light) => `${quality}/${scene}_${light.replaceAll(" ", "_")}`;
/** Of a page before its first picture: the first views at high quality are kept there. */
export const kPosters = join(repository, "web-client/src/posters");

export function keptPath(name) {
  const scene = /^high\/(\w+)_automatic$/.exec(name)?.[1];
  return scene ? join(kPosters, `${scene}.webp`) : join(kKept, `${name}.webp`);
}
export const madePath = (name) => join(kMade, `${name}.webp`);
/** Written where a picture differs. */
export const differencePath = (name) => join(kMade, `${name}_difference.png`);

/**
 * Makes pictures of a scene.
 * @param {import("playwright-core").BrowserContext} context
 * @param {{scene: string, quality: string, lights?: string[]}} what all presets of the page unless named
 * @returns {AsyncGenerator<{name: string, light: string, file: Buffer}>}
 */
export async function* makePictures(context, { scene, quality, lights }) {
  const page = await DrivenPage.open(context, { scene, quality, size: kSize });
  try {
    await setUp(page, shotOf(scene));
    const presets = (await page.lights()).filter((name) => name !== kNoPreset);
    for (const light of lights ?? presets) {
      if (!presets.includes(light)) throw new Error(`the page has no light "${light}", but ${presets.join(", ")}`);
      await page.light(light);
      yield { name: nameOf(quality, scene, light), light, file: await page.picture(kFile) };
    }
    if (page.complaints.length > 0) throw new Error(`${scene}: ${page.complaints.join("; ")}`);
  } finally {
    await page.close();
  }
}

export function write(path, file) {
  mkdirSync(dirname(path), { recursive: true });
  writeFileSync(path, file);
}

/**
 * Writes a made picture and compares it with the kept one; where they differ, also writes the places.
 * @param {import("playwright-core").Page} scratch any page
 * @returns {Promise<import("./compare.mjs").Difference | undefined>} undefined if none is kept
 */
export async function check(scratch, name, file) {
  write(madePath(name), file);
  rmSync(differencePath(name), { force: true });
  if (!existsSync(keptPath(name))) return undefined;
  const difference = await compare(scratch, readFileSync(keptPath(name)), file);
  if (!difference.isLike && difference.mask) write(differencePath(name), await encodePng(scratch, difference.mask));
  return difference;
}
