// Particles as one liquid: a volume of their density, through which the rays of the picture go.
//   particles  frames -> particles on the GPU
//   volume     particles -> density in cells
//   shadow     volume -> light on the floor of a tank; in rooms without a wave
//   tiles      particles -> tiles of the screen with liquid; the surface is searched for there only
//   surface    volume, sky, solids -> canvas
//   drops      particles apart from the liquid -> canvas
import type { Texture } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import type { Pass } from "../drawing/pass";
import type { Quality } from "../drawing/quality";
import type { StreamedFrames } from "../frames/streamed_frames";
import type { Sky } from "../light/sky";
import { colourRatio } from "../light/water_optics";
import type { SolidsPass } from "../solids/solids_pass";
import { FluidDropsPass } from "./fluid_drops_pass";
import { FluidParticles } from "./fluid_particles";
import { FluidShadowPass } from "./fluid_shadow_pass";
import { FluidSurfacePass } from "./fluid_surface_pass";
import { FluidTilesPass } from "./fluid_tiles_pass";
import { FluidVolumePass } from "./fluid_volume_pass";
import { PlainLiquidPass } from "./plain_liquid_pass";

/** The passes of one room's particles, in the order in which they are drawn. */
interface FluidPasses {
  /** Before the water. */
  before: Pass[];
  /** After the water. */
  after: Pass[];
}

/** Drops for each particle that flies apart where drops are all that is drawn. */
const kSparingDropsCount = 3;

/** `field` undefined: no wave around the particles. `froth`: foam that boats leave. */
export function makeFluidPasses(frames: StreamedFrames, solids: SolidsPass, sky: Sky, noise: Texture, field: Texture | undefined, froth: Texture | undefined, greeting: GreetingInfo, { texelType, plain, fluid: quality }: Pick<Quality, "fluid" | "plain" | "texelType">): FluidPasses {
  const particles = new FluidParticles(frames.particles, frames.clock, field, greeting);
  // The wave shows most of the water.
  if (field && !quality) return { before: [particles], after: [new FluidDropsPass(particles, undefined, solids, sky, noise, kSparingDropsCount, true)] };
  if (!quality) return { before: [particles], after: [new PlainLiquidPass(particles, greeting, solids.surroundings, sky, noise, colourRatio(greeting))] };
  const volume = new FluidVolumePass(particles, greeting, field ? undefined : solids.surroundings, quality.cellsPerSpacing, texelType);
  const tiles = new FluidTilesPass(particles, volume);
  // A wave has no floor of its own.
  const floor = field ? undefined : new FluidShadowPass(particles, volume, solids, sky, greeting, { ...quality, texelType, plain });
  const inputs = { tiles, volume, solids, sky, noise, particleUniforms: particles.uniforms, floorUniforms: floor?.uniforms, froth: field ? undefined : froth };
  const surface = new FluidSurfacePass(inputs, field ? 1 : colourRatio(greeting), quality, plain);
  const drops = new FluidDropsPass(particles, volume, solids, sky, noise, quality.dropsCount, field !== undefined, inputs.froth);
  const before = [particles, volume, ...(floor ? [floor] : [])];
  return { before, after: [tiles, surface, drops] };
}
