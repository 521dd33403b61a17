// Where white water begins, from what the server streams: at breaking crests (new foam), at hulls, and where the surface rises against rocks
// and breakwaters. Every source adds a mean number per second and area or length, so that the picture does not depend on the rates of
// frames and pictures. Pure: no renderer.
import type { BoatDetail } from "../../../client/codec/greeting";
import type { ObstacleInfo } from "../../../client/codec/scene_info";
import type { FoamFrame } from "../../net/messages";
import type { BodyPose } from "../../../client/codec/bodies";
import { clamp, mix, ramp } from "../maths/interpolate";
import { kinds, type Birth, type DiffuseParticles } from "./diffuse_particles";
import type { Surface } from "./moving_surface";

/** What the sources add to. */
export interface Births {
  particles: DiffuseParticles;
  random: () => number;
  /** 1 for the densities below, less where fewer particles are wanted. */
  scale: number;
  /** Size of the water's breakers over those of a sea: lengths below shrink with it, speeds with its root (Froude's law). */
  sizeRatio: number;
}

/** Narrower water has smaller breakers, down to a share of those of a sea. */
const kSeaM = 6;
const kLeastSizeRatio = 0.25;

/** Returns `sizeRatio` of water with this shorter side. */
export function sizeRatioOf(sideM: number): number {
  return clamp(sideM / kSeaM, kLeastSizeRatio, 1);
}

/** Returns a whole number with the mean `expected`. */
function countOf(expected: number, random: () => number): number {
  const whole = Math.floor(expected);
  return whole + Number(random() < expected - whole);
}

const spread = (random: () => number, by: number): number => by * (2 * random() - 1);

/** Mist among drops: share of the drops, radii of the puffs [m], and how long they last if not as long as drops [s]. */
interface Mist {
  share: number;
  radiiM: readonly [number, number];
  livesS?: readonly [number, number];
}

/** Where water meets rock or falls over. */
const kBreakerMist: Mist = { share: 0.2, radiiM: [0.12, 0.37] };
/** Sheets of the finest drops. */
const kBowMist: Mist = { share: 0.35, radiiM: [0.026, 0.06], livesS: [0.2, 0.5] };

/** Few drops are large: radii from 4 mm to 2 cm. */
function drop(random: () => number, xM: number, yM: number, zM: number, vxMps: number, vyMps: number, vzMps: number): Birth {
  return { kind: kinds.spray, xM, yM, zM, vxMps, vyMps, vzMps, radiusM: 0.004 + 0.016 * random() ** 3, lifeS: 1 + 1.5 * random() };
}

/** Puffs cost by the pixel: where fewer drops are wanted, fewer of them are mist. */
function dropOrMist({ random, scale, sizeRatio }: Births, { share, radiiM, livesS }: Mist, ...motion: [xM: number, yM: number, zM: number, vxMps: number, vyMps: number, vzMps: number]): Birth {
  const flying = drop(random, ...motion);
  if (random() >= share * scale) return { ...flying, radiusM: sizeRatio * flying.radiusM };
  const radiusM = sizeRatio * mix(...radiiM, random());
  return { ...flying, radiusM, ...(livesS && { lifeS: mix(...livesS, random()) }) };
}

function bubble(random: () => number, xM: number, yM: number, zM: number): Birth {
  return { kind: kinds.bubble, xM, yM: yM - 0.05 - 0.3 * random(), zM, vxMps: 0, vyMps: 0, vzMps: 0, radiusM: 0.008 + 0.02 * random(), lifeS: 2.5 };
}

function froth(random: () => number, xM: number, yM: number, zM: number, vxMps: number, vzMps: number): Birth {
  return { kind: kinds.foam, xM, yM, zM, vxMps, vyMps: 0, vzMps, radiusM: 0.1 + 0.15 * random(), lifeS: 2 + 3 * random() };
}

/** Foam that grows by this much (of 255) between frames is new: the water breaks there. */
export const kNewFoam = 24;
/** Per m^2 of water whose foam grows from none to white. */
const kCrestDropsPerM2 = 90;
const kCrestBubblesPerM2 = 12;
const kCrestSpeedsMps = [0.25, 1.2] as const;
const kMostCrestMps = 6;

/** Breaking crests: foam that grew from one frame to the next. */
export function addCrests(births: Births, from: FoamFrame, to: FoamFrame, surface: Surface): void {
  const n = to.resolutionCount;
  if (from.resolutionCount !== n || from.countZ !== to.countZ) return;
  const { particles, random, scale, sizeRatio } = births;
  const speedRatio = Math.sqrt(sizeRatio);
  const [before, after] = [new Uint8Array(from.buffer), new Uint8Array(to.buffer)];
  const cellM = to.sideM / n;
  for (let at = 0; at < n * to.countZ; ++at) {
    const grown = after[at]! - before[at]!;
    if (grown < kNewFoam) continue;
    const xM = ((at % n) + 0.5) * cellM - to.sideM / 2;
    const zM = (Math.floor(at / n) + 0.5) * (to.widthM / to.countZ) - to.widthM / 2;
    const motion = surface.motionAt(xM, zM);
    if (!motion) continue;
    const { elevationM, riseMps, slopeX, slopeZ } = motion;
    const fresh = (grown / 255) * cellM * cellM * scale;
    for (let left = countOf(kCrestBubblesPerM2 * fresh, random); left > 0; --left)
      particles.add(bubble(random, xM + spread(random, cellM / 2), elevationM, zM + spread(random, cellM / 2)));
    // A crest's front rises: it travels down its slope with the speed rise / slope.
    const slope = Math.hypot(slopeX, slopeZ);
    const alongMps = slope > 0.02 ? Math.min(Math.max(riseMps, 0) / slope, kMostCrestMps) : 0;
    const [dx, dz] = slope > 0 ? [-slopeX / slope, -slopeZ / slope] : [0, 0];
    const drops = countOf((kCrestDropsPerM2 / sizeRatio ** 2) * fresh * ramp(...kCrestSpeedsMps, riseMps / speedRatio), random);
    for (let left = drops; left > 0; --left) {
      const speedMps = alongMps * (0.7 + 0.5 * random());
      const upMps = 0.4 * speedRatio + 1.3 * riseMps * (0.4 + random());
      const asideMps = 0.4 * speedRatio;
      particles.add(dropOrMist(births, kBreakerMist, xM + spread(random, cellM / 2), elevationM + 0.03 * sizeRatio, zM + spread(random, cellM / 2), dx * speedMps + spread(random, asideMps), upMps, dz * speedMps + spread(random, asideMps)));
    }
  }
}

/** A hull throws spray above this speed, over sqrt(g L). */
const kSprayFroude = 0.2;
/** Per s and m of hull at a Froude number of 1 above it. */
const kBowDropsPerMS = 500;
const kWakeFrothPerMS = 70;
/** Foam along the sides, which the bow throws out. */
const kSideFrothPerMS = 90;

/** Bow waves and wakes. `poses` are the first `boats.length` or fewer boats drawn now. */
export function addHulls(births: Births, poses: readonly BodyPose[], hulls: ReadonlyMap<number, BoatDetail>, surface: Surface, gravityMps2: number, stepS: number): void {
  const { particles, random, scale } = births;
  for (const { boatId, xM, zM, headingRad, speedMps } of poses) {
    const hull = hulls.get(boatId);
    if (!hull) continue;
    const { lengthM, beamM } = hull;
    const [fx, fz] = [Math.cos(headingRad), Math.sin(headingRad)];
    const place = (along: number, across: number): [number, number] => [xM + fx * along - fz * across, zM + fz * along + fx * across];
    const froude = speedMps / Math.sqrt(Math.max(gravityMps2, 0.1) * lengthM);
    const above = Math.max(froude - kSprayFroude, 0);
    const [bowX, bowZ] = place(0.46 * lengthM, 0);
    const bow = surface.motionAt(bowX, bowZ);
    if (!bow) continue;
    const { elevationM, riseMps } = bow;
    // The bow meets a rising surface harder.
    const hit = above * above * (1 + 2 * ramp(0, 1.5, riseMps));
    for (let left = countOf(kBowDropsPerMS * hit * lengthM * stepS * scale, random); left > 0; --left) {
      const side = random() < 0.5 ? -1 : 1;
      const [px, pz] = place(lengthM * (0.46 - 0.22 * random()), side * beamM * (0.15 + 0.3 * random()));
      const outMps = side * speedMps * (0.15 + 0.25 * random());
      const alongMps = speedMps * (0.45 + 0.4 * random());
      const upMps = speedMps * (0.12 + 0.25 * random());
      particles.add(dropOrMist(births, kBowMist, px, elevationM + 0.03, pz, fx * alongMps - fz * outMps, upMps, fz * alongMps + fx * outMps));
    }
    const wake = ramp(0.1, 0.6, froude) * lengthM * stepS * scale;
    // Foam begins all along the way of this step, or it would lie in heaps.
    const behindM = (): number => speedMps * stepS * random();
    for (let left = countOf(kWakeFrothPerMS * wake, random); left > 0; --left) {
      const [px, pz] = place(-0.5 * lengthM - behindM(), spread(random, 0.4 * beamM));
      // The screw throws the water astern.
      const asternMps = -0.15 * speedMps;
      const sternM = surface.elevationAtM(px, pz);
      if (sternM === undefined) continue;
      particles.add(froth(random, px, sternM, pz, fx * asternMps + spread(random, 0.15), fz * asternMps + spread(random, 0.15)));
      if (random() < 0.4) particles.add(bubble(random, px, sternM, pz));
    }
    for (let left = countOf(kSideFrothPerMS * wake, random); left > 0; --left) {
      const side = random() < 0.5 ? -1 : 1;
      // Most of it at the stem.
      const astern = random() * random();
      const [px, pz] = place(lengthM * (0.48 - 0.8 * astern) - behindM(), side * beamM * Math.min(0.1 + 0.5 * random() + astern, 0.6));
      const outMps = side * speedMps * (0.02 + 0.2 * random() * random());
      const alongMps = 0.15 * speedMps;
      particles.add({ ...froth(random, px, elevationM, pz, fx * alongMps - fz * outMps, fz * alongMps + fx * outMps), lifeS: 1 + 1.5 * random() });
    }
  }
}

/** A position at the water line of an obstacle; the normal points to the water, and each stands for `lengthM` of the line. */
export interface RimPoint {
  xM: number;
  zM: number;
  normalX: number;
  normalZ: number;
  lengthM: number;
}

const kRimSpacingM = 0.4;
const kMostRimPoints = 4000;
/** Distance of the positions from the obstacle, where the surface is that of the water. */
const kRimAwayM = 0.15;

/** Returns the positions along the water lines of rocks and breakwaters. */
export function rimOf(obstacles: readonly ObstacleInfo[]): RimPoint[] {
  const rim: RimPoint[] = [];
  for (const obstacle of obstacles) {
    if (obstacle.shape === "rock") {
      const radiusM = obstacle.radiusM + kRimAwayM;
      const count = clamp(Math.ceil((2 * Math.PI * radiusM) / kRimSpacingM), 6, kMostRimPoints);
      for (let n = 0; n < count; ++n) {
        const [normalX, normalZ] = [Math.cos((2 * Math.PI * n) / count), Math.sin((2 * Math.PI * n) / count)];
        rim.push({ xM: obstacle.xM + radiusM * normalX, zM: obstacle.zM + radiusM * normalZ, normalX, normalZ, lengthM: (2 * Math.PI * radiusM) / count });
      }
    } else {
      const { xM, zM, lengthM, widthM, headingRad } = obstacle;
      const [ax, az] = [Math.cos(headingRad), Math.sin(headingRad)];
      const edge = (halfM: number, alongM: number, ux: number, uz: number, vx: number, vz: number): void => {
        const count = clamp(Math.ceil(alongM / kRimSpacingM), 1, kMostRimPoints);
        for (let n = 0; n < count; ++n)
          for (const side of [-1, 1]) {
            const at = ((n + 0.5) / count - 0.5) * alongM;
            const outM = side * (halfM + kRimAwayM);
            rim.push({ xM: xM + ux * at + vx * outM, zM: zM + uz * at + vz * outM, normalX: side * vx, normalZ: side * vz, lengthM: alongM / count });
          }
      };
      edge(widthM / 2, lengthM, ax, az, -az, ax);
      edge(lengthM / 2, widthM, -az, ax, ax, az);
    }
    if (rim.length > kMostRimPoints) break;
  }
  return rim.slice(0, kMostRimPoints);
}

/** Drops per s and m of water line where the surface rises by 1 m/s more than the first of these speeds. */
const kRimDropsPerMS = 160;
const kRimSpeedsMps = [0.3, 1.3] as const;

/** Water that rises against rocks and breakwaters. */
export function addRims(births: Births, rim: readonly RimPoint[], surface: Surface, stepS: number): void {
  const { particles, random, scale } = births;
  for (const { xM, zM, normalX, normalZ, lengthM } of rim) {
    const motion = surface.motionAt(xM, zM);
    if (!motion) continue;
    const { elevationM, riseMps } = motion;
    const hit = ramp(...kRimSpeedsMps, riseMps);
    if (hit <= 0) continue;
    for (let left = countOf(kRimDropsPerMS * hit * lengthM * stepS * scale, random); left > 0; --left) {
      const along = spread(random, lengthM / 2);
      const outMps = riseMps * (0.1 + 0.5 * random());
      const upMps = riseMps * (1 + 1.6 * random()) + 0.4;
      particles.add(dropOrMist(births, kBreakerMist, xM - normalZ * along, elevationM, zM + normalX * along, normalX * outMps + spread(random, 0.3), upMps, normalZ * outMps + spread(random, 0.3)));
      if (random() < 0.3) particles.add(froth(random, xM, elevationM, zM, 0.3 * normalX, 0.3 * normalZ));
    }
  }
}
