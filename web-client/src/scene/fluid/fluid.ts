// Particles as one liquid, in screen space. Its targets may be smaller than the canvas; the last pass draws on it.
//   particles  frames -> particles on the GPU
//   shadow     particles -> light on the floor of a tank; where there is no wave
//   tiles      particles -> tiles of the screen with fluid; the screen passes below run there only
//   depth      particles -> nearest surface
//   smooth     nearest surface -> smooth surface
//   normal     smooth surface -> normals
//   thickness  particles -> thickness, coverage
//   surface    all of these, sky, solids -> canvas
import type { Texture } from "three";

import type { Pass } from "../drawing/pass";
import type { FluidQuality } from "../drawing/quality";
import type { StreamedFrames } from "../frames/streamed_frames";
import type { Sky } from "../light/sky";
import { tankColourRatio } from "../light/water_optics";
import type { SolidsPass } from "../solids/solids_pass";
import { FluidDepthPass } from "./fluid_depth_pass";
import { FluidNormalPass } from "./fluid_normal_pass";
import { FluidParticles } from "./fluid_particles";
import { FluidShadowPass } from "./fluid_shadow_pass";
import { FluidSmoothPass } from "./fluid_smooth_pass";
import { FluidSurfacePass } from "./fluid_surface_pass";
import { FluidThicknessPass } from "./fluid_thickness_pass";
import { FluidTilesPass } from "./fluid_tiles_pass";

/** The passes of one room's particles, in the order in which they are drawn. */
interface FluidPasses {
  /** Before the water. */
  before: Pass[];
  /** After the water. */
  after: Pass[];
}

/** `field` undefined: no wave around the particles. */
export function makeFluidPasses(frames: StreamedFrames, solids: SolidsPass, sky: Sky, noise: Texture, field: Texture | undefined, size: { sideM: number; widthM: number }, quality: FluidQuality): FluidPasses {
  const { scale, samplesCount, roundsCount } = quality;
  const particles = new FluidParticles(frames.particles, frames.clock, field, size);
  const colourRatio = field ? 1 : tankColourRatio(size);
  const tiles = new FluidTilesPass(particles);
  const depth = new FluidDepthPass(particles, scale);
  const smooth = new FluidSmoothPass(tiles, particles, depth, samplesCount, roundsCount);
  const normal = new FluidNormalPass(tiles, smooth);
  const thickness = new FluidThicknessPass(particles, scale);
  const surface = new FluidSurfacePass({ tiles, smooth, normal, thickness, solids }, sky, noise, particles.uniforms, field !== undefined, colourRatio);
  // A wave has no floor of its own.
  const before = field ? [particles] : [particles, new FluidShadowPass(particles, solids, sky, size.sideM, colourRatio)];
  return { before, after: [tiles, depth, smooth, normal, thickness, surface] };
}
