// Optical types of water: what it absorbs and scatters, and the colours that follow for the shaders (shaders/water_optics.glsl). Pure.
import type { GreetingInfo } from "../../../client/codec/greeting";
import type { WaterTypeName } from "../../../client/codec/scene_info";
import { mapRgb, type Rgb } from "./light";

/** Inherent optical properties at 650, 550 and 450 nm, per metre. */
interface Properties {
  absorption: Rgb;
  backscattering: Rgb;
  /** kRealPerModelLength if left out. */
  realPerModelLength?: number;
}

/** Pure water absorbs (0.340, 0.0565, 0.0092) /m (Pope & Fry 1997). The rest is plankton, silt and what rivers bring, within the ranges that
 *  Mobley (Light and Water, 1994, chapter 3) reports. */
const kProperties: Record<WaterTypeName, Properties> = {
  // So clear that caustics on the floor stay white.
  pool: { absorption: [0.340, 0.065, 0.026], backscattering: [0.0060, 0.0120, 0.0180], realPerModelLength: 1.4 },
  lagoon: { absorption: [0.345, 0.060, 0.022], backscattering: [0.0050, 0.0085, 0.0130] },
  // So deep that no bed is seen.
  ocean: { absorption: [0.350, 0.068, 0.030], backscattering: [0.0016, 0.0028, 0.0052], realPerModelLength: 20 },
  coast: { absorption: [0.375, 0.090, 0.082], backscattering: [0.0045, 0.0070, 0.0078] },
  harbor: { absorption: [0.460, 0.140, 0.165], backscattering: [0.0080, 0.0155, 0.0165] },
};

/** Scenes are models: this many metres of real water have the colour of one metre of theirs. */
const kRealPerModelLength = 2.5;
/** Reflectance of deep water over b / (a + b), with a the absorption and b the backscattering (Gordon et al. 1975). */
const kReflectancePerRatio = 0.33;
/** Photographs of the sea are exposed for its darkest part. */
const kExposure = 1.5;
/** Backscattering by the bubbles of broken water at all wavelengths (/m), and the share of that light which is seen. */
const kBubblesPerM = 0.35;
const kBubblesShare = 0.55;
/** Way of light through a crest (m), and the share of it that reaches the eye. */
const kCrestM = 1.6;
const kCrestShare = 0.34;

/** Way through a tank, for its colour (m). */
const kTankWayM = 7;

/** Depth of a pool whose lengths count as they are (m). */
const kPoolDeepM = 1.5;

/** Returns by which factor lengths count as longer for the water's colour: tanks of all sizes look alike from the side, and shallow pools of particles like deep ones. */
export function colourRatio({ setting, wave, sideM, widthM, waterExtents }: Pick<GreetingInfo, "setting" | "wave" | "sideM" | "widthM" | "waterExtents">): number {
  if (setting === "pool") return wave ? 1 : Math.max(kPoolDeepM / waterExtents.depthM, 1);
  return setting === "openSea" ? 1 : kTankWayM / Math.min(sideM, widthM);
}

interface WaterOptics {
  /** Share of the light lost per metre of way in the model. */
  lossPerM: Rgb;
  /** Light that deep water sends up at noon. */
  scattered: Rgb;
  /** The same of water full of bubbles. */
  bubbly: Rgb;
  /** Sunlight that a crest lets through, per metre of its height. */
  crest: Rgb;
}

export function waterOpticsOf(type: WaterTypeName): WaterOptics {
  const { absorption, backscattering, realPerModelLength = kRealPerModelLength } = kProperties[type];
  const of = (value: (a: number, b: number) => number): Rgb => mapRgb(absorption, backscattering, value);
  return {
    lossPerM: of((a, b) => realPerModelLength * (a + b)),
    scattered: of((a, b) => (kExposure * kReflectancePerRatio * b) / (a + b)),
    bubbly: of((a, b) => (kBubblesShare * (b + kBubblesPerM)) / (a + b + kBubblesPerM)),
    crest: of((a) => kCrestShare * Math.exp(-kRealPerModelLength * a * kCrestM)),
  };
}
