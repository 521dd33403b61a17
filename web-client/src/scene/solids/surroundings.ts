// What is around the water: chooses and owns the parts of the scene's setting.
import type { Object3D, Vector3 } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import type { SettingName, SideName } from "../../../client/codec/scene_info";
import type { ViewedBox } from "../camera/framing";
import { makeCoastGeometry } from "../landscape/coast";
import { Landscape, makeGroundGeometry } from "../landscape/landscape";
import { bedOf } from "../landscape/terrain";
import type { Quality } from "../drawing/quality";
import type { Lamps } from "../light/lamps";
import { OpenSea } from "../sea/open_sea";
import { GlassTank, tileSides } from "./glass_tank";
import { PoolBasin } from "./pool_basin";
import type { SurroundingsContext, WaterEdge } from "./surroundings_context";

/** Cells along each side of a bed with beaches, obstacles or a coast. */
const kBedCells = 96;
const kPlainBedCells = 48;
/** The most of a ground that the server sends. */
const kGroundCells = 256;
const kPlainGroundCells = 96;

/** How much of the water a view has to show: where it continues beyond the picture, only a part. */
const kSettingViews: Record<SettingName, Pick<ViewedBox, "focus" | "raised" | "sideRaised">> = {
  openSea: { focus: { wide: 0.72, tall: 0.5 }, raised: { wide: 1, tall: 1.45 } },
  pool: { focus: { wide: 0.78, tall: 0.52 }, raised: { wide: 1.7, tall: 3.2 }, sideRaised: 4 },
  glassTank: { focus: { wide: 1.05, tall: 0.95 }, raised: { wide: 1.1, tall: 1.6 } },
  flume: { focus: { wide: 1.02, tall: 0.9 }, raised: { wide: 0.8, tall: 1.2 } },
};

/** How far away from land, in sides of the square, the middle of a view is. Views look along z, so land there hides more of the water. */
const kLeanFromLand = { x: 0.04, z: 0.16 };

/** The view from the side looks from the first of these sides without land. */
const kSeenFrom: readonly SideName[] = ["+z", "-x", "-z", "+x"];

/** A tank that is shallower than this share of its side is a tray: one looks at the waves from above, not through the glass. */
const kTrayDepth = 0.2;
const kTrayView = { ...kSettingViews.glassTank, raised: { wide: 1.8, tall: 2.6 } };

/** Returns how a view frames the scene's water; in the open sea away from the land. */
export function viewOf({ setting, wave, firstView }: GreetingInfo): Pick<ViewedBox, "focus" | "raised" | "sideRaised" | "lean" | "seenFrom" | "first"> {
  const framed = setting === "glassTank" && wave && wave.depthM < kTrayDepth * Math.min(wave.sideM, wave.widthM) ? kTrayView : kSettingViews[setting];
  const view = firstView ? { ...framed, first: firstView } : framed;
  if (setting !== "openSea" || !wave) return view;
  const closed = (side: SideName): number => Number(wave.sides[side] === "closed");
  const seenFrom = kSeenFrom.find((side) => closed(side) === 0) ?? "+z";
  return { ...view, seenFrom, lean: { x: kLeanFromLand.x * (closed("-x") - closed("+x")), z: kLeanFromLand.z * (closed("-z") - closed("+z")) } };
}

/** Root mean square slope of the ripples in a pool, in a flume, where waves break, and on water of particles alone. */
const kPoolSlope = 0.016, kFlumeSlope = 0.03, kParticlesSlope = 0.035;
/** Particles alone carry no waves shorter than those of a grid with so many cells along x. */
const kParticlesCells = 112;
const kClosed = { "+x": "closed", "-x": "closed", "+z": "closed", "-z": "closed" } as const;

/** Returns the waves that the simulation does not have: the sea around an open sea's square, and ripples. The caller disposes it. */
export function makeSea({ setting, wave, wind, sideM, widthM, waterExtents }: GreetingInfo, quality: Quality): OpenSea | undefined {
  if (wave && setting === "openSea") return new OpenSea(wave, wind, quality);
  // The simulation of a tray has the shortest waves too.
  if (quality.plain || (wave && setting === "glassTank")) return undefined;
  if (wave) return new OpenSea(wave, undefined, quality, setting === "pool" ? kPoolSlope : kFlumeSlope);
  const box = { sideM, widthM, depthM: waterExtents.depthM, resolutionCount: kParticlesCells, sides: kClosed, spongeWidthM: 0, periodicX: false, periodicZ: false };
  return new OpenSea(box, undefined, quality, kParticlesSlope);
}

export class Surroundings {
  /** Drawn before the water. */
  readonly solids: Object3D[] = [];
  /** Panes of a tank, drawn over everything and blended: they are before whatever they cover. */
  readonly glass: Object3D | undefined;
  readonly edge: WaterEdge;
  /** Height of the floor below the water. */
  floorM: number;
  private readonly sea: OpenSea | undefined;
  private readonly basin: PoolBasin | undefined;
  private readonly tank: GlassTank | undefined;
  private readonly landscape: Landscape | undefined;

  constructor(greeting: GreetingInfo, context: SurroundingsContext) {
    const { setting, wave, obstacles, beaches, hasBed } = greeting;
    const { plain } = context.quality;
    this.sea = context.sea;
    const bed = bedOf(greeting);
    this.floorM = wave ? -wave.depthM : 0;
    const cellsCount = bed.ground ? Math.min(Math.max(bed.ground.countX, bed.ground.countZ), plain ? kPlainGroundCells : kGroundCells) : plain ? kPlainBedCells : kBedCells;
    if (setting === "openSea" && wave && this.sea) {
      this.edge = { kind: "sea", sea: { ...this.sea.uniforms, u_haze_m: context.haze }, sides: wave.sides };
      const isLandless = obstacles.length === 0 && !hasBed && Object.values(wave.sides).every((kind) => kind !== "closed");
      this.landscape = new Landscape(bed, makeCoastGeometry({ bed, sides: wave.sides }, cellsCount, plain), obstacles, context.solid, plain, { isLandless });
      this.solids.push(this.landscape.group);
      return;
    }
    if (setting === "pool") {
      this.edge = { kind: "walls", ripples: this.sea?.uniforms };
      this.basin = new PoolBasin(greeting, context);
      this.solids.push(this.basin.group);
    } else {
      this.edge = { kind: "cut", ripples: this.sea?.uniforms };
      this.tank = new GlassTank(greeting, context);
      this.solids.push(this.tank.group);
      this.glass = this.tank.glass;
    }
    if (obstacles.length > 0 || beaches.length > 0 || hasBed) {
      const ground = makeGroundGeometry(bed, cellsCount, this.tank && tileSides(greeting));
      this.landscape = new Landscape(bed, ground, obstacles, context.solid, plain, { groundMaterial: this.tank?.tiles });
      this.solids.push(this.landscape.group);
    }
  }

  /** Sets the height of the floor, where it comes with the first frame. */
  setFloorM(yM: number): void {
    this.floorM = yM;
    this.basin?.setFloorM(yM);
    this.tank?.setFloorM(yM);
  }

  setParameter(path: string, value: number): void {
    this.sea?.setParameter(path, value);
  }

  look(cameraM: Vector3): void {
    this.tank?.look(cameraM);
  }

  /** Adds the lights of breakwaters at a time of the scene. */
  collectLamps(lamps: Lamps, shownS: number): void {
    this.landscape?.collectLamps(lamps, shownS);
  }

  dispose(): void {
    for (const part of [this.basin, this.tank, this.landscape]) part?.dispose();
  }
}
