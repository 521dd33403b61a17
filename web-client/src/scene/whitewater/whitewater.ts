// White water on the page alone, at no bandwidth: the passes in order.
//   whitewater  frames, boats -> drops, foam, bubbles
//   froth       foam -> texture over the square, which the water shows
//   bubbles     bubbles -> solids, before the water
//   spray       drops -> canvas, after the water
import type { Texture } from "three";

import type { GreetingInfo } from "../../../client/codec/greeting";
import type { Pass } from "../drawing/pass";
import type { WhitewaterQuality } from "../drawing/quality";
import type { StreamedFrames } from "../frames/streamed_frames";
import type { Sky } from "../light/sky";
import type { SolidsPass } from "../solids/solids_pass";
import { BubblesPass } from "./bubbles_pass";
import type { DiffuseParticles } from "./diffuse_particles";
import { FrothPass } from "./froth_pass";
import { SprayPass } from "./spray_pass";
import { WhitewaterPass } from "./whitewater_pass";

interface WhitewaterPasses {
  /** Before the water. */
  before: Pass[];
  /** After the water. */
  after: Pass[];
  froth: FrothPass;
  particles: DiffuseParticles;
}

/** For a room with a wave, or with boats among particles, which have bubbles of their own. */
export function makeWhitewaterPasses(greeting: GreetingInfo, frames: StreamedFrames, solids: SolidsPass, sky: Sky, noise: Texture, quality: WhitewaterQuality): WhitewaterPasses {
  const whitewater = new WhitewaterPass(greeting, frames, solids, quality);
  const { points } = whitewater;
  const froth = new FrothPass(points, greeting, quality.frothTexelsCount);
  return { before: [whitewater, froth, ...(greeting.wave ? [new BubblesPass(points, solids, sky)] : [])], after: [new SprayPass(points, solids, sky, noise)], froth, particles: whitewater.particles };
}
