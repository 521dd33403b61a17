// The README's animation and the tour: pictures at even steps of simulated time, so that they run evenly however slow the machine is.
// Both continue where they were interrupted, unless page, server or film have changed since.
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, readdirSync, readFileSync, renameSync, rmSync, statSync, writeFileSync } from "node:fs";
import { join, relative } from "node:path";

import { repository } from "../server.mjs";
import { DrivenPage, kTickRateHz } from "./driven_page.mjs";

/**
 * @typedef {object} Segment
 * @property {string} scene
 * @property {string} light
 * @property {number} startTick
 * @property {number} picturesCount
 * @property {{eyeM: number[], targetM: number[]}} from where the camera begins
 * @property {{eyeM: number[], targetM: number[]}} [to] where it arrives
 * @property {{atPicture: number, action: object}[]} [commands] sent to the room
 */

/** White water is computed over this many ticks before the first picture. */
const kHistoryTicks = 120;

const kAnimation = {
  name: "animation",
  size: { width: 760, height: 352 },
  ticksPerPicture: 4,
  /** @type {Segment[]} */
  segments: [
    {
      scene: "harbor", light: "golden hour", startTick: 240, picturesCount: 75,
      from: { eyeM: [9.5, 2.6, 12], targetM: [-1, 0, -2] },
      to: { eyeM: [6.5, 2.1, 9.5], targetM: [-1.5, 0, -3] },
    },
  ],
};

const kTour = {
  name: "tour",
  size: { width: 960, height: 540 },
  ticksPerPicture: 3,
  /** @type {Segment[]} */
  segments: [
    {
      scene: "harbor", light: "golden hour", startTick: 270, picturesCount: 100,
      from: { eyeM: [9.5, 2.6, 12], targetM: [-1, 0, -2] },
      to: { eyeM: [6, 1.9, 9], targetM: [-2, 0, -3] },
    },
    {
      scene: "splash", light: "noon", startTick: 60, picturesCount: 60,
      from: { eyeM: [3.5, 2.6, 7], targetM: [0, 0.3, 0] },
      to: { eyeM: [1.5, 2.2, 6.5], targetM: [0, 0.3, 0] },
    },
    {
      scene: "breaking_wave", light: "noon", startTick: 84, picturesCount: 60,
      from: { eyeM: [1.5, 3.2, 12.5], targetM: [-2, -0.2, 0] },
      to: { eyeM: [-3, 2.6, 11], targetM: [-5, -0.2, 0] },
    },
    {
      scene: "open_water", light: "dusk", startTick: 240, picturesCount: 60,
      from: { eyeM: [3, 1.5, 9], targetM: [-2, 0.3, -8] },
      to: { eyeM: [1, 1.3, 7], targetM: [-2, 0.3, -8] },
    },
    {
      scene: "dam_break", light: "noon", startTick: 6, picturesCount: 50,
      from: { eyeM: [0.8, 1.2, 5.2], targetM: [0, -0.1, 0] },
      to: { eyeM: [0.2, 1, 4.6], targetM: [0.2, -0.1, 0] },
    },
    {
      scene: "harbor", light: "moon", startTick: 480, picturesCount: 70,
      from: { eyeM: [2, 2.4, 8], targetM: [-5, 0.4, -6] },
      to: { eyeM: [-1, 2, 5.5], targetM: [-6, 0.4, -7] },
    },
  ],
};

const kPicturesPerS = (film) => kTickRateHz / film.ticksPerPicture;
const gallery = (path) => join(repository, "build/gallery", path);

/** Returns what the pictures depend on. */
function digest(film, quality) {
  const hash = createHash("sha256").update(JSON.stringify([film, quality]));
  const add = (folder) => {
    for (const entry of readdirSync(folder, { withFileTypes: true }).sort((a, b) => (a.name < b.name ? -1 : 1)))
      if (entry.isDirectory()) add(join(folder, entry.name));
      else hash.update(entry.name).update(readFileSync(join(folder, entry.name)));
  };
  for (const folder of ["web-client/dist", "server/scenes"]) add(join(repository, folder));
  return hash.digest("hex");
}

function between({ from, to = from }, share) {
  const eased = share * share * (3 - 2 * share);
  const mix = (a, b) => a.map((value, axis) => value + (b[axis] - value) * eased);
  return { eyeM: mix(from.eyeM, to.eyeM), targetM: mix(from.targetM, to.targetM) };
}

/** Shoots the pictures of a film that are not there yet. @returns {Promise<string>} their folder */
async function shoot(context, film, quality) {
  const folder = gallery(film.name);
  const stamp = join(folder, "made-of");
  const wanted = digest(film, quality);
  if (!existsSync(stamp) || readFileSync(stamp, "utf8") !== wanted) rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  writeFileSync(stamp, wanted);
  let first = 0;
  for (const segment of film.segments) {
    const paths = Array.from({ length: segment.picturesCount }, (_, n) => join(folder, `${String(first + n).padStart(4, "0")}.png`));
    first += segment.picturesCount;
    if (!paths.every((path) => existsSync(path))) await shootSegment(context, { ...film, quality }, segment, paths);
  }
  return folder;
}

async function shootSegment(context, { size, quality, ticksPerPicture: stride }, { scene, light, startTick, commands = [], ...camera }, paths) {
  const page = await DrivenPage.open(context, { scene, quality, light, size });
  try {
    const before = startTick - stride;
    await page.skipTo(before % stride);
    await page.skipTo(Math.max(before - kHistoryTicks + (kHistoryTicks % stride), before % stride));
    if (before > 0) await page.followTo(before, stride);
    else await page.skipTo(stride);
    const last = paths.findLastIndex((path) => !existsSync(path));
    for (const [n, path] of paths.slice(0, last + 1).entries()) {
      for (const { action } of commands.filter(({ atPicture }) => atPicture === n)) await page.command(action);
      if (existsSync(path)) {
        await page.followTo(startTick + n * stride, stride);
        continue;
      }
      await page.goOn(stride);
      await page.look(between(camera, n / Math.max(paths.length - 1, 1)));
      // Whole or not there at all, wherever it is interrupted.
      writeFileSync(`${path}.part`, await page.picture());
      renameSync(`${path}.part`, path);
      console.log(relative(repository, path));
    }
  } finally {
    await page.close();
  }
}

const encode = (film, folder, options, path) => {
  execFileSync("ffmpeg", ["-v", "error", "-y", "-framerate", String(kPicturesPerS(film)), "-i", join(folder, "%04d.png"), ...options, path], { stdio: "inherit" });
  return `${path} (${Math.round(statSync(path).size / 1000)} kB)`;
};

/** Makes the animated picture of the README. @returns {Promise<string>} its path and size */
export async function shootAnimation(context, qualities) {
  const folder = await shoot(context, kAnimation, qualities.at(-1));
  return encode(kAnimation, folder, ["-c:v", "libwebp_anim", "-quality", "40", "-compression_level", "6", "-loop", "0"], join(repository, "web-client/screenshots/harbor.webp"));
}

/** Makes the tour, 20 s of video. @returns {Promise<string>} its path and size */
export async function shootTour(context, qualities) {
  const folder = await shoot(context, kTour, qualities.at(-1));
  return encode(kTour, folder, ["-c:v", "libx264", "-crf", "20", "-preset", "slow", "-pix_fmt", "yuv420p", "-movflags", "+faststart"], gallery("tour.mp4"));
}
