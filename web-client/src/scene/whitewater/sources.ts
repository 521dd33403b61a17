// Where white water begins, from what the server streams: at breaking crests, at hulls, and where the surface rises against rocks
// and breakwaters. Every source adds a mean number per second and area or length, so that the picture does not depend on the rates of
// frames and pictures. Pure: no renderer.
import type { BoatDetail } from "../../../client/codec/greeting";
import type { ObstacleInfo } from "../../../client/codec/scene_info";
import type { BodyPose } from "../../../client/codec/bodies";
import { clamp, mix, ramp } from "../maths/interpolate";
import { kinds, type Birth, type DiffuseParticles } from "./diffuse_particles";
import type { Surface, SurfaceMotion } from "./moving_surface";

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

/** Puffs of fine drops among large ones: their share, radii [m], and how long they last until they have come apart [s]. */
interface Puffs {
  share: number;
  radiiM: readonly [number, number];
  livesS: readonly [number, number];
}

/** Where water breaks, or meets rock. */
const kBreakerPuffs: Puffs = { share: 0.5, radiiM: [0.05, 0.29], livesS: [0.4, 1] };
const kBowPuffs: Puffs = { share: 0.2, radiiM: [0.045, 0.1], livesS: [0.2, 0.5] };

type Motion = Pick<Birth, "xM" | "yM" | "zM" | "vxMps" | "vyMps" | "vzMps">;

/** Few drops are large: radii from 4 mm to 2 cm. Puffs cost by the pixel: they become fewer faster than drops do. */
function thrown({ random, scale, sizeRatio }: Births, { share, radiiM, livesS }: Puffs, motion: Motion): Birth {
  if (random() < share * Math.min(scale * scale, 1)) return { ...motion, kind: kinds.puff, radiusM: sizeRatio * mix(...radiiM, random() ** 2), lifeS: mix(...livesS, random()) };
  return { ...motion, kind: kinds.spray, radiusM: sizeRatio * (0.004 + 0.016 * random() ** 3), lifeS: 1 + 1.5 * random() };
}

function bubble(random: () => number, xM: number, yM: number, zM: number): Birth {
  return { kind: kinds.bubble, xM, yM: yM - 0.05 - 0.3 * random(), zM, vxMps: 0, vyMps: 0, vzMps: 0, radiusM: 0.008 + 0.02 * random(), lifeS: 2.5 };
}

function froth(random: () => number, xM: number, yM: number, zM: number, vxMps: number, vzMps: number): Birth {
  return { kind: kinds.foam, xM, yM, zM, vxMps, vyMps: 0, vzMps, radiusM: 0.1 + 0.15 * random(), lifeS: 2 + 3 * random() };
}

/** Per s and m^2 of a crest that curls over and rises fast. */
const kCrestDropsPerM2S = 1100;
const kCrestBubblesPerM2S = 12;
/** Elevations [m] and curvatures [1/m] between which a crest begins to curl over and is all foam (sea_blend.glsl). */
const kCurledM = [0.15, 0.45] as const;
const kCurledPerM = [0.45, 1.8] as const;
const kCrestSpeedsMps = [0.25, 1.2] as const;
const kMostCrestMps = 3.5;
/** Its front is so many times as long as it is high there; flatter water has none. */
const kFrontHeights = 1.3;
const kLeastSlope = 0.05;
/** Its lip falls ahead of it, by so much per square of its height. */
const kLipPerM = 0.8;

/** The front of a crest that breaks: where the surface rises, below water that curls over. */
export function addCrests(births: Births, surface: Surface, stepS: number): void {
  const { particles, random, scale, sizeRatio } = births;
  const speedRatio = Math.sqrt(sizeRatio);
  const areaM2 = surface.cellM ** 2;
  const around = (atM: number): number => atM + spread(random, surface.cellM / 2);
  const curledAt = ({ elevationM, curvaturePerM }: Readonly<SurfaceMotion>): number => ramp(...kCurledM, elevationM / sizeRatio) * ramp(...kCurledPerM, -curvaturePerM * sizeRatio);
  surface.visitAbove(kCurledM[0] * sizeRatio, (xM, zM, own) => {
    const { elevationM, riseMps, slopeX, slopeZ } = own;
    const rising = ramp(...kCrestSpeedsMps, riseMps / speedRatio);
    const slope = Math.hypot(slopeX, slopeZ);
    if (rising <= 0 || slope < kLeastSlope) return;
    const [dx, dz] = [-slopeX / slope, -slopeZ / slope];
    const curledHere = curledAt(own);
    const frontM = kFrontHeights * elevationM;
    const crest = surface.motionAt(xM - dx * frontM, zM - dz * frontM);
    const expected = Math.max(curledHere, crest ? curledAt(crest) : 0) * rising * areaM2 * stepS * scale;
    for (let left = countOf(kCrestBubblesPerM2S * expected, random); left > 0; --left) particles.add(bubble(random, around(xM), elevationM, around(zM)));
    // It travels down its slope with the speed rise / slope.
    const alongMps = Math.min(riseMps / slope, kMostCrestMps * speedRatio);
    const lipM = (kLipPerM / sizeRatio) * elevationM ** 2;
    for (let left = countOf((kCrestDropsPerM2S / sizeRatio ** 2.5) * expected, random); left > 0; --left) {
      const speedMps = alongMps * (0.3 + 0.7 * random());
      const upMps = 0.3 * speedRatio + riseMps * (0.2 + random() ** 2);
      const asideMps = 0.4 * speedRatio;
      const motion = {
        xM: around(xM + dx * lipM), yM: elevationM + 0.03 * sizeRatio, zM: around(zM + dz * lipM),
        vxMps: dx * speedMps + spread(random, asideMps), vyMps: upMps, vzMps: dz * speedMps + spread(random, asideMps),
      };
      particles.add(thrown(births, kBreakerPuffs, motion));
    }
  });
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
      particles.add(thrown(births, kBowPuffs, { xM: px, yM: elevationM + 0.03, zM: pz, vxMps: fx * alongMps - fz * outMps, vyMps: upMps, vzMps: fz * alongMps + fx * outMps }));
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
const kRimDropsPerMS = 260;
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
      particles.add(thrown(births, kBreakerPuffs, { xM: xM - normalZ * along, yM: elevationM, zM: zM + normalX * along, vxMps: normalX * outMps + spread(random, 0.3), vyMps: upMps, vzMps: normalZ * outMps + spread(random, 0.3) }));
      if (random() < 0.3) particles.add(froth(random, xM, elevationM, zM, 0.3 * normalX, 0.3 * normalZ));
    }
  }
}
