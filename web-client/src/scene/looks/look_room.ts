// One look in one room: its passes, the range of its colours, and its probe.
//   value      frames -> the look's value, for looks of the surface
//   particles  frames -> particles, for looks of particles
//   surface    value or foam, field, sea, solids -> canvas
//   spheres    particles, solids -> canvas
//   present    solids -> canvas where there is no water
// There is no liquid, refraction or glass: they would change the colours.
import type { GreetingInfo } from "../../../client/codec/greeting";
import type { Pass } from "../drawing/pass";
import type { Quality } from "../drawing/quality";
import { FluidParticles } from "../fluid/fluid_particles";
import { densityRatio, kDensityRatios, pickParticle, placeM, speedMps } from "../frames/particle_values";
import { pickWater, type Ray } from "../frames/pick";
import type { StreamedFrames } from "../frames/streamed_frames";
import { isCovered } from "../landscape/clearance";
import { bedOf, depthAtM } from "../landscape/terrain";
import type { Sky } from "../light/sky";
import type { SolidsPass } from "../solids/solids_pass";
import type { FieldPass } from "../water/field_pass";
import type { FoamPass } from "../water/foam_pass";
import { PresentPass } from "../water/present_pass";
import { LookColours } from "./look_colours";
import { LookParticlesPass } from "./look_particles_pass";
import { kBluePaint, kGreyPaint, LookSurfacePass, type SurfaceColour } from "./look_surface_pass";
import { LookValuePass } from "./look_value_pass";
import { kLooks, type LookName, type Quantity } from "./looks";
import { breakingCriterion, foamAt, ShownSurface, type Rectangle } from "./surface_values";
import { kBeyondShares, reachOf, ticksOf, type ValueRange } from "./value_range";
import { waterMagnitudes } from "./water_magnitudes";

/** How often the range is measured, on how many values, and what it spans at least: so many steps of a surface's values, or so fast. */
const kMeasureEveryS = 0.5;
const kMeasuredParticles = 4096;
const kLeastSteps = 10;
const kLeastMps = 0.1;

/** What the colour bar shows. */
export interface Legend {
  quantity: Quantity;
  range: ValueRange;
  ticks: number[];
  /** The range follows the values. */
  follows: boolean;
}

/** What the probe reads at a position. */
export interface Reading {
  quantity: Quantity;
  value: number;
  /** Difference of two values that the stream can just tell apart. */
  step: number;
  xM: number;
  yM: number;
  zM: number;
  /** The stream holds back values beyond this bound, which the value has reached. */
  bound?: "low" | "high" | undefined;
}

/** What the passes of a look are made from. `field` undefined: the room has no wave. */
interface LookInputs {
  frames: StreamedFrames;
  field: FieldPass | undefined;
  foam: FoamPass | undefined;
  solids: SolidsPass;
  sky: Sky;
  quality: Quality;
}

export class LookRoom {
  readonly passes: readonly Pass[];
  private readonly quantity: Quantity | undefined;
  private readonly colours: LookColours | undefined;
  private readonly particles: FluidParticles | undefined;
  private readonly rectangle: Rectangle;
  private readonly loweredM: number;
  private measuredAtS = -Infinity;

  constructor(
    private readonly name: LookName,
    private readonly greeting: GreetingInfo,
    private readonly inputs: LookInputs,
  ) {
    const { field, frames, solids, sky, quality } = inputs;
    const { wave, sideM, widthM } = greeting;
    this.rectangle = { sideM, widthM, periodicX: wave?.periodicX ?? false, periodicZ: wave?.periodicZ ?? false };
    this.quantity = kLooks[name].quantity;
    this.colours = this.quantity && new LookColours(this.quantity);
    const hasSurfaceValues = this.quantity?.of === "surface";
    const value = field && (name === "height" || name === "velocity" || name === "breaking") ? new LookValuePass(field, this.rectangle, name === "height" ? "elevation" : "rate") : undefined;
    this.particles = greeting.hasParticles && !hasSurfaceValues ? new FluidParticles(frames.particles, frames.clock, field?.texture, greeting) : undefined;
    this.loweredM = this.particles ? greeting.bandM : 0;
    const paint = name === "thesis" ? kBluePaint : kGreyPaint;
    const surface = field && new LookSurfacePass(greeting, { sky, field: field.texture, solids, quality, paint, loweredM: this.loweredM, colour: this.surfaceColour(value) });
    const colour = this.colours && (name === "speed" || name === "density") ? { of: name, colours: this.colours } : undefined;
    const spheres = this.particles && new LookParticlesPass(this.particles, solids, sky, colour);
    this.passes = [value, this.particles, surface, spheres, new PresentPass(sky, solids, undefined)].filter((pass) => pass !== undefined);
  }

  get legend(): Legend | undefined {
    const { quantity, colours } = this;
    if (!quantity || !colours) return undefined;
    const fixed = typeof quantity.range === "string" ? undefined : quantity.range;
    return { quantity, range: colours.range, ticks: fixed?.ticks ?? ticksOf(colours.range), follows: colours.follows };
  }

  /** Follows the values with the range, after a picture. */
  measure(nowS: number): void {
    if (!this.colours?.follows || nowS - this.measuredAtS < kMeasureEveryS) return;
    const measured = this.particles ? this.measureParticles() : this.measureSurface();
    if (!measured) return;
    this.measuredAtS = nowS;
    this.colours.note(measured.reach, measured.least, nowS);
  }

  /**
   * Returns the value where the ray meets the water of the last picture, which shows the time `shownS`; undefined where there is no
   * value. Call it before the next frame arrives.
   */
  probe(ray: Ray, shownS: number): Reading | undefined {
    const { quantity } = this;
    if (!quantity) return undefined;
    return quantity.of === "particles" ? this.probeParticles(ray, quantity) : this.probeSurface(ray, quantity, shownS);
  }

  dispose(): void {
    for (const pass of this.passes) pass.dispose();
    this.colours?.dispose();
  }

  private surfaceColour(value: LookValuePass | undefined): SurfaceColour | undefined {
    const { colours, name } = this;
    if (!colours) return undefined;
    if (value) return { of: name === "breaking" ? "breaking" : "value", value, colours };
    const { foam } = this.inputs;
    return name === "foam" && foam ? { of: "foam", foam: foam.uniforms, colours } : undefined;
  }

  /** The surface of the last picture; undefined before the first frame. */
  private surface(): ShownSurface | undefined {
    const shown = this.inputs.field?.shown;
    // A frame's buffer goes back to the worker when the ring drops it.
    if (!shown || shown.frames.some(({ buffer }) => buffer.byteLength === 0)) return undefined;
    return new ShownSurface(this.rectangle, shown);
  }

  private measureSurface(): { reach: number; least: number } | undefined {
    const surface = this.surface();
    if (!surface) return undefined;
    const magnitudes = waterMagnitudes(surface, this.greeting, this.name === "height" ? "elevation" : "rate");
    const step = this.name === "height" ? surface.quantumM : surface.rateQuantumMps;
    const least = kLeastSteps * step || kLeastMps;
    return { reach: reachOf(magnitudes, least, kBeyondShares.surface), least };
  }

  private measureParticles(): { reach: number; least: number } | undefined {
    const values = this.particles?.values;
    if (!values) return undefined;
    const { count } = values.frame;
    const every = Math.max(Math.ceil(count / kMeasuredParticles), 1);
    const magnitudes = new Float64Array(Math.ceil(count / every));
    for (let i = 0; i < magnitudes.length; ++i) magnitudes[i] = speedMps(values, i * every);
    return { reach: reachOf(magnitudes, kLeastMps, kBeyondShares.particles), least: kLeastMps };
  }

  private probeSurface(ray: Ray, quantity: Quantity, shownS: number): Reading | undefined {
    const surface = this.surface();
    const place = surface && pickWater(ray, { ...this.rectangle, ...surface.boundsM(), elevationAtM: (xM, zM) => surface.elevationM(xM, zM) });
    if (!place) return undefined;
    const { xM, zM } = place;
    const bed = bedOf(this.greeting);
    const yM = surface.elevationM(xM, zM);
    if (yM + depthAtM(bed, xM, zM) <= 0 || isCovered(this.greeting.obstacles, xM, zM)) return undefined;
    const at = { quantity, xM, yM, zM };
    if (this.name === "height") return { ...at, value: yM, step: surface.quantumM };
    if (this.name === "foam") {
      const shown = this.inputs.frames.foam.around(shownS);
      return shown && { ...at, value: (100 / 255) * foamAt(this.rectangle, shown, xM, zM), step: 100 / 255 };
    }
    // With a single frame the velocity is not known.
    if (surface.rateQuantumMps === 0) return undefined;
    if (this.name === "velocity") return { ...at, value: surface.rateMps(xM, zM), step: surface.rateQuantumMps };
    const { gravityMps2 } = this.greeting;
    return { ...at, value: breakingCriterion(surface, bed, gravityMps2, xM, zM), step: surface.rateQuantumMps / Math.sqrt(gravityMps2 * bed.depthM) };
  }

  private probeParticles(ray: Ray, quantity: Quantity): Reading | undefined {
    const values = this.particles?.values;
    const index = values && pickParticle(ray, values, this.surfaceAheadM(ray));
    if (index === undefined) return undefined;
    const [xM, yM, zM] = placeM(values!, index);
    const at = { quantity, xM, yM, zM };
    if (this.name === "speed") return { ...at, value: speedMps(values!, index), step: values!.frame.maxSpeedMps / 127 };
    const value = densityRatio(values!, index);
    const { low, high } = kDensityRatios;
    return { ...at, value, step: (high - low) / 255, bound: value <= low ? "low" : value >= high ? "high" : undefined };
  }

  /** Distance to the surface, which hides the particles below it. */
  private surfaceAheadM({ originM, direction }: Ray): number {
    const surface = this.surface();
    if (!surface) return Infinity;
    const { minM, maxM } = surface.boundsM();
    const loweredM = this.loweredM;
    const elevationAtM = (xM: number, zM: number): number => surface.elevationM(xM, zM) - loweredM;
    const place = pickWater({ originM, direction }, { ...this.rectangle, minM: minM - loweredM, maxM: maxM - loweredM, elevationAtM });
    if (!place) return Infinity;
    const to = [place.xM, elevationAtM(place.xM, place.zM), place.zM];
    return to.reduce((sum, value, axis) => sum + (value - originM[axis]!) * direction[axis]!, 0);
  }
}
