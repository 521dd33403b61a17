// The passes of one room, each with what it reads and writes, in the order in which they are drawn.
//   waterlines   frames -> where the water stands against hulls
//   field        frames, waterlines -> field (elevation, slopes, curvature of the water)
//   shore        frames, field -> shore, where water moves over its ground (shore/shore_pass.ts)
//   foam         frames -> foam
//   sea          time -> ripples, and in an open sea the waves around the square
//   caustics     field, sea -> sunlight that the waves focus on what is below them; in the tiers from medium on
//   shadow       frames, field -> what the sun sees of solids; in the tiers from medium on
//   solids       sky, ground, rocks, boats, objects -> solids (linear light, depth)
//   particles    frames -> particles; their shadow -> solids (fluid/fluid.ts)
//   whitewater   frames, boats -> drops, foam, bubbles; froth; bubbles -> solids (whitewater/whitewater.ts)
//   flat shadow  solids -> froth; in the tiers below
//   rain rings   time -> rings on the water, under the open sky; in the tiers from medium on
//   water        field, foam, froth, rain, sea, shadow, solids -> canvas
//   present      solids -> canvas where there is no water
//   fluid        particles, froth, solids -> canvas (fluid/fluid.ts)
//   spray        drops, solids -> canvas
//   rain streaks solids -> canvas
//   lamps        solids, field -> canvas, in the dark
//   glass        panes of a tank -> canvas
//   edges        canvas -> the same with smooth outlines; in the tiers from medium on
// Other looks than the natural one draw the water with passes of their own (looks/look_room.ts).
import type { DataTexture } from "three";

import type { GreetingInfo } from "../../client/codec/greeting";
import type { Pass } from "./drawing/pass";
import type { Quality } from "./drawing/quality";
import { EverySecond } from "./drawing/every_second";
import type { WarmUp } from "./drawing/warm_up";
import { makeFluidPasses } from "./fluid/fluid";
import type { StreamedFrames } from "./frames/streamed_frames";
import type { Sky } from "./light/sky";
import { RainRingsPass } from "./rain/rain_rings_pass";
import { RainStreaksPass } from "./rain/rain_streaks_pass";
import { FlatShadowPass } from "./shadows/flat_shadow_pass";
import { ShadowPass } from "./shadows/shadow_pass";
import { shoreOf } from "./shore/shore_ground";
import { ShorePass } from "./shore/shore_pass";
import type { ShoreWetness } from "./shore/shore_wetness";
import { GlassPass } from "./solids/glass_pass";
import { LampsPass } from "./solids/lamps_pass";
import { kInTextures, kOnCanvas, SolidsPass } from "./solids/solids_pass";
import { makeSea } from "./solids/surroundings";
import { CausticsPass } from "./water/caustics_pass";
import { EdgesPass } from "./water/edges_pass";
import { FieldPass } from "./water/field_pass";
import { FoamPass } from "./water/foam_pass";
import type { LocalRipple } from "./water/local_ripple";
import { PresentPass } from "./water/present_pass";
import { WaterlinesPass } from "./water/waterlines_pass";
import { WaterPass } from "./water/water_pass";
import type { DiffuseParticles } from "./whitewater/diffuse_particles";
import { makeWhitewaterPasses } from "./whitewater/whitewater";

/** What passes of all rooms are made with. */
export interface RoomTools {
  frames: StreamedFrames;
  sky: Sky;
  noise: DataTexture;
  quality: Quality;
  /** Outlives the passes of a room, so that another quality keeps wet ground. */
  wetness: ShoreWetness;
  ripple: LocalRipple;
  /** Starts the translation of programs that take long. */
  warmUp: WarmUp;
}

/** What all looks of a room share. `field` undefined: there is no wave. */
export interface RoomBase {
  field: FieldPass | undefined;
  foam: FoamPass | undefined;
  solids: SolidsPass;
  passes: readonly Pass[];
}

/** The water of a room in one look. */
export interface RoomWater {
  readonly passes: readonly Pass[];
  /** Drops, foam and bubbles that the page adds. */
  readonly white?: DiffuseParticles | undefined;
  dispose(): void;
}

export function makeBase(greeting: GreetingInfo, { frames, sky, noise, quality, wetness, ripple, warmUp }: RoomTools): RoomBase {
  const { wave, sideM, widthM } = greeting;
  const cellsOf = shoreOf(greeting);
  const waterlines = wave && greeting.hasBoats ? new WaterlinesPass(greeting, frames, wave.sideM / wave.resolutionCount) : undefined;
  const field = wave && new FieldPass(wave, frames.surfaces, ripple, waterlines, quality, cellsOf);
  const shore = field && cellsOf && new ShorePass(frames, field, wetness, cellsOf, quality);
  const foam = wave && greeting.layers.includes("foam") ? new FoamPass(frames.foam, wave.periodicX, wave.periodicZ) : undefined;
  const sea = makeSea(greeting, quality);
  const isPool = greeting.setting === "pool";
  const caustics = (field || isPool) && quality.caustics ? new CausticsPass(field?.texture, sea, sky, { sideM, widthM, depthM: wave?.depthM ?? greeting.waterExtents.depthM, isPool }, quality.caustics) : undefined;
  const shadow = quality.shadows && new ShadowPass(greeting, sky, field?.texture, quality.shadows.texelsCount);
  const solids = new SolidsPass(greeting, sky, noise, field?.texture, { caustics: caustics?.uniforms, shadow: shadow?.uniforms, shore: shore?.uniforms }, sea, frames, quality, warmUp);
  shadow?.setCasters(solids);
  const shownSea = sea && (quality.sparing ? new EverySecond(sea, 0) : sea);
  return { field, foam, solids, passes: [waterlines, field, shore, foam, shownSea, caustics, shadow, solids].filter((pass) => pass !== undefined) };
}

export function makeNaturalWater(greeting: GreetingInfo, { field, foam, solids }: RoomBase, { frames, sky, noise, quality, warmUp }: RoomTools): RoomWater {
  const { glass } = solids.surroundings;
  const white = field || (greeting.hasBoats && !quality.plain) ? makeWhitewaterPasses(greeting, frames, solids, sky, noise, quality.whitewater) : undefined;
  const { ringTexelsCount, streaksCount } = quality.rain;
  const isRainedOn = field !== undefined && greeting.wind !== undefined;
  const rings = isRainedOn && ringTexelsCount > 0 ? new RainRingsPass(greeting, ringTexelsCount) : undefined;
  const streaks = isRainedOn ? new RainStreaksPass(greeting, solids, sky, streaksCount) : undefined;
  const inputs = field && white && { field: field.texture, foam: foam?.uniforms, froth: white.froth.texture, rain: rings?.uniforms, newest: () => frames.surfaces.newest() };
  const water = inputs && new WaterPass(greeting, solids, { sky, noise, quality, warmUp }, inputs);
  const fluid = greeting.hasParticles ? makeFluidPasses(frames, solids, sky, noise, field?.texture, white?.froth.texture, greeting, quality) : { before: [], after: [] };
  const flatShadow = field && white && !quality.shadows ? new FlatShadowPass(solids, sky, white.froth.target, greeting) : undefined;
  const lamps = greeting.hasBoats || greeting.obstacles.length > 0 ? new LampsPass(solids, field?.texture, greeting) : undefined;
  const edges = quality.plain ? undefined : new EdgesPass();
  if (quality.plain && water) solids.use = plainUse(water);
  else if (quality.sparing && !water) solids.use = () => kOnCanvas;
  // The bubbles are drawn into the solids' textures, which plain water does not show.
  const whiteBefore = (white?.before ?? []).filter(({ name }) => !quality.plain || name !== "bubbles");
  // The flat shadow is drawn into the froth.
  const onWater = [...whiteBefore, flatShadow].map((pass) => (pass && quality.sparing && pass.writes.some((written) => written === "froth") ? new EverySecond(pass, 1) : pass));
  const before = [...fluid.before, ...onWater, rings];
  const after = [new PresentPass(sky, solids, water), ...fluid.after, ...(white?.after ?? []), streaks, lamps, glass && new GlassPass(glass), edges];
  const passes = [...before, water, ...after].filter((pass) => pass !== undefined);
  return { passes, white: white?.particles, dispose: () => passes.forEach((pass) => pass.dispose()) };
}

/** Plain tiers draw the solids on the canvas, whose depth hides what is behind them; a camera in the water looks through their textures. */
function plainUse(water: WaterPass): SolidsPass["use"] {
  return ({ camera }) => (water.isSeenFromBelow(camera) ? kInTextures : kOnCanvas);
}

/** Leaves out passes whose results no later pass reads. */
export function usedPasses(passes: readonly Pass[]): Pass[] {
  const used: Pass[] = [];
  for (const pass of [...passes].reverse())
    if (pass.writes.some((written) => written === "canvas" || used.some(({ reads }) => reads.includes(written)))) used.unshift(pass);
  return used;
}
