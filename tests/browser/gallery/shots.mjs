// What the gallery shows: the first view of each shipped scene at a tick. A scene that is not listed is shown at kDefault.
import { readdirSync } from "node:fs";

import { repository } from "../server.mjs";

/**
 * @typedef {object} Shot
 * @property {number} tick the water shown
 * @property {number} [historyTicks] before it, for what the page keeps of them: kHistoryTicks unless it is longer
 * @property {object[]} [visitors] commands at tick 0, where a scene shows what it is for only with somebody in it
 */

const kRacers = [[-9.5, 0.5, -15], [-9, -9.5, -10], [-2, -9.5, -20], [-12, 3.5, -20], [-7, -4.5, -15], [-3, -1, -30]].map(([x_m, z_m, heading_deg]) => ({
  spawn_boat: { boat: { x_m, z_m, heading_deg, length_m: 2.6, beam_m: 0.95, density_ratio: 0.3, max_speed_mps: 4, throttle_ratio: 0.6 } },
}));

/** @type {Shot} */
const kDefault = { tick: 180 };
/** Ticks at which something is to be seen: a crown, a crest about to break, a wake. @type {Record<string, Shot>} */
const kShots = {
  beach: { tick: 510, historyTicks: 300 },
  boat_wake: { tick: 300 },
  boat_wake_particles: { tick: 474 },
  boat_wake_wave: { tick: 300 },
  breaking_wave: { tick: 111 },
  breaking_wave_particles: { tick: 94 },
  breaking_wave_wave: { tick: 105 },
  dam_break: { tick: 108 },
  flume: { tick: 906 },
  flotsam: { tick: 300 },
  harbor: { tick: 1410 },
  island: { tick: 222, historyTicks: 210 },
  kelvin: { tick: 840 },
  open_water: { tick: 300 },
  particles_only: { tick: 24, visitors: [{ splash: { x_m: 0, z_m: -0.2, radius_m: 0.35, depth_m: 0.3 } }] },
  pool: { tick: 78 },
  regatta: { tick: 188, visitors: kRacers },
  river_mouth: { tick: 800, historyTicks: 300 },
  ripple_tank: { tick: 600 },
  rain_rings: { tick: 206 },
  splash: { tick: 72 },
  splash_particles: { tick: 85 },
  splash_wave: { tick: 84 },
  still_pool: { tick: 60 },
  thesis: { tick: 420 },
  wave_only: { tick: 69 },
};

/** Pictures of both qualities have this size. */
export const kSize = { width: 400, height: 225 };
/** White water lives for some seconds, and wet ground longer: they are computed over this many ticks before the picture, in steps of kStride. */
const kHistoryTicks = 120;
const kStride = 6;

/** Returns the names of the shipped scenes. */
export function shippedScenes() {
  return readdirSync(`${repository}/server/scenes`)
    .filter((name) => name.endsWith(".textproto"))
    .map((name) => name.slice(0, -".textproto".length))
    .sort();
}

/** Returns the scene of a picture named SCENE_LIGHT; a scene's name may begin with another's. */
export function sceneOf(name) {
  return shippedScenes().filter((scene) => name.startsWith(`${scene}_`)).sort((a, b) => b.length - a.length)[0];
}

export const shotOf = (scene) => kShots[scene] ?? kDefault;

/** Brings a scene to the tick of its picture. @param {import("./driven_page.mjs").DrivenPage} page */
export async function setUp(page, { tick, historyTicks = kHistoryTicks, visitors = [] }) {
  for (const command of visitors) await page.command(command);
  await page.skipTo(tick % kStride);
  await page.skipTo(Math.max(tick - historyTicks, tick % kStride));
  await page.followTo(tick, kStride);
}

/** These are shown in every light, the others in the light of their first view. */
const kInEveryLight = ["harbor"];

/** Returns the lights of a scene's pictures; undefined: all. */
export const lightsOf = (scene) => (kInEveryLight.includes(scene) ? undefined : ["automatic"]);
