// The sea outside the simulated square: two cascades of waves and how they blend with the simulated water. The longer cascade is the
// wind sea that the server lets in through the open sides, wave for wave, so heights agree where the layers of these sides have replaced
// the simulated water by it (docs/wind_sea.md). The shorter one is ripples.
import { Vector2, Vector4 } from "three";

import { kSideNames, type SideName, type WaveInfo, type WindInfo } from "../../../client/codec/scene_info";
import type { Pass, Picture } from "../drawing/pass";
import type { Quality } from "../drawing/quality";
import type { Uniforms } from "../shaders/materials";
import { makeRipples, rippleSlope, tornByWind } from "./ripples";
import { seaStateOf, withParameter, type PlaneWave, type SeaWater } from "./sea_state";
import { SeaTile, slopeVariance } from "./sea_tile";

/** As in the server: a sea fades into the next one in this time (wind_sea.cpp). */
const kFadeS = 4;
/** A tile of long waves is this many sides of the square: the wider, the less a wave is bent to fit it. */
const kSwellTileSides = { plain: 2, full: 4 };
/** Ripples begin where the simulated grid ends, at 8 cells, and the tile is this many of the longest. */
const kLongestRippleCells = 8;
const kRippleRange = 5;
const kRippleTileLengths = 9;
/** How many waves, how sharp their crests are (sea_tile.frag), and which share of the slope is drawn. In the plain tiers a sharp tile
 * takes too long, and with all of the slope the sun's image, which only drawn ripples widen, would break up. */
const kRipples = { plain: { count: 20, chop: 0, share: 0.6 }, full: { count: 40, chop: 3, share: 1 } };
/** Water outside periodic sides repeats the simulated water and fades within this share of the side. */
const kPeriodicFadeSides = 0.3;
/** Blending at an open side without a layer. */
const kLeastBlendSides = 0.06;
/** Never reached: at a closed side the simulated water does not blend with anything. */
const kNever = 1e6;

/**
 * Returns the uniforms of sea_blend.glsl for the sides +x, -x, +z, -z: `beyondM`, how far outside a side the simulated water's share
 * becomes 0, and `widthM`, over which it falls from 1.
 */
export function blendOf(wave: Pick<WaveInfo, "sides" | "sideM" | "widthM" | "spongeWidthM">): { beyondM: number[]; widthM: number[] } {
  const of = (side: SideName): [number, number] => {
    const kind = wave.sides[side];
    const sideM = side[1] === "x" ? wave.sideM : wave.widthM;
    if (kind === "closed") return [kNever, 1];
    if (kind === "periodic") return [kPeriodicFadeSides * sideM, kPeriodicFadeSides * sideM];
    return [0, Math.max(wave.spongeWidthM, kLeastBlendSides * sideM)];
  };
  return { beyondM: kSideNames.map((side) => of(side)[0]), widthM: kSideNames.map((side) => of(side)[1]) };
}

export class OpenSea implements Pass {
  readonly name = "sea";
  readonly reads = [] as const;
  readonly writes = ["sea"] as const;
  /** For the shaders of the water. */
  readonly uniforms: Uniforms;
  private readonly swell: SeaTile;
  private readonly ripples: SeaTile;
  private readonly rippleWaves: PlaneWave[];
  private readonly rippleShare: number;
  private readonly variances = new Vector2();
  private wave: SeaWater;
  private wind: WindInfo | undefined;
  private shown: PlaneWave[] = [];
  private shownSlope: number;
  private next: { waves: PlaneWave[]; slope: number; beganS: number } | undefined;
  private lastS = 0;

  /** `slope`: root mean square of the ripples' slopes, instead of what follows from the wind. */
  constructor(wave: SeaWater, wind: WindInfo | undefined, { plain, seaTexelsCount, texelType }: Pick<Quality, "plain" | "seaTexelsCount" | "texelType">, private readonly givenSlope?: number) {
    this.wave = wave;
    this.wind = wind;
    const kind = plain ? "plain" : "full";
    const { count, chop, share } = kRipples[kind];
    const longestM = (kLongestRippleCells * wave.sideM) / wave.resolutionCount;
    this.swell = new SeaTile(kSwellTileSides[kind] * Math.max(wave.sideM, wave.widthM), seaTexelsCount, !plain, texelType, 0);
    this.ripples = new SeaTile(kRippleTileLengths * longestM, seaTexelsCount, !plain, texelType, chop);
    this.rippleWaves = makeRipples(count, longestM / kRippleRange, longestM, wind?.directionDeg ?? 30, wind?.gravityMps2 ?? 9.81);
    this.rippleShare = share;
    const { beyondM, widthM } = blendOf(wave);
    this.uniforms = {
      u_swell: { value: this.swell.texture },
      u_ripples: { value: this.ripples.texture },
      u_tiles_m: { value: new Vector2(this.swell.tileM, this.ripples.tileM) },
      u_slope_variances: { value: this.variances },
      u_torn_by_wind: { value: 1 },
      u_blend_beyond_m: { value: new Vector4(...beyondM) },
      u_blend_width_m: { value: new Vector4(...widthM) },
    };
    this.shown = this.waves();
    this.shownSlope = this.slope();
  }

  get longestRippleM(): number {
    return this.ripples.tileM / kRippleTileLengths;
  }

  /** Root mean square of the ripples' curvature. */
  get rippleCurvaturePerM(): number {
    return this.shownSlope * Math.sqrt(this.rippleWaves.reduce((sum, { amplitudeM, kxRadpm, kzRadpm }) => sum + 0.5 * (amplitudeM * (kxRadpm ** 2 + kzRadpm ** 2)) ** 2, 0));
  }

  /** Follows a parameter of the room, by its path in the scene. */
  setParameter(path: string, value: number): void {
    if (path === "wave.depth_m" && value > 0) this.wave = { ...this.wave, depthM: value };
    if (!this.wind) return;
    const wind = withParameter(this.wind, path, value);
    if (wind === this.wind && path !== "wave.depth_m") return;
    this.wind = wind;
    // A change during a fade shortens it.
    if (this.next) [this.shown, this.shownSlope] = [this.next.waves, this.next.slope];
    this.next = { waves: this.waves(), slope: this.slope(), beganS: this.lastS };
  }

  /** Draws both cascades at the time shown. */
  draw({ renderer, shownS }: Picture): void {
    if (shownS === undefined) return;
    this.lastS = shownS;
    let faded = 0;
    if (this.next) {
      // Time that has gone back is that of a scene that started again.
      faded = shownS < this.next.beganS ? 1 : Math.min((shownS - this.next.beganS) / kFadeS, 1);
      if (faded >= 1) {
        [this.shown, this.shownSlope] = [this.next.waves, this.next.slope];
        this.next = undefined;
        faded = 0;
      }
    }
    // Like the server's: the energies of two independent seas add up.
    const angle = (faded * Math.PI) / 2;
    const [from, to] = [Math.cos(angle), Math.sin(angle)];
    this.swell.render(renderer, shownS, [{ waves: this.shown, share: from }, { waves: this.next?.waves ?? [], share: to }]);
    const slope = this.shownSlope + ((this.next?.slope ?? 0) - this.shownSlope) * (this.next ? faded : 0);
    const drawnSlope = this.rippleShare * slope;
    this.ripples.render(renderer, shownS, [{ waves: this.rippleWaves, share: drawnSlope }]);
    this.variances.set(from ** 2 * slopeVariance(this.shown) + to ** 2 * slopeVariance(this.next?.waves ?? []), drawnSlope ** 2);
    this.uniforms["u_torn_by_wind"]!.value = tornByWind(slope);
  }

  dispose(): void {
    this.swell.dispose();
    this.ripples.dispose();
  }

  private waves(): PlaneWave[] {
    return this.wind ? seaStateOf(this.wave, this.wind) : [];
  }

  private slope(): number {
    return this.givenSlope ?? rippleSlope(this.wind);
  }
}
