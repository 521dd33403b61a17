// The shader texts with their includes, and makeMaterial() for all of them.
import { AddEquation, CustomBlending, DstColorFactor, GLSL3, OneFactor, RawShaderMaterial, ZeroFactor, type IUniform, type ShaderMaterialParameters } from "three";

import bed from "./bed.glsl?raw";
import below from "./below.glsl?raw";
import bicubic from "./bicubic.glsl?raw";
import billows from "./billows.glsl?raw";
import border from "./border.glsl?raw";
import bubblesFrag from "./bubbles.frag?raw";
import caustics from "./caustics.glsl?raw";
import causticsFrag from "./caustics.frag?raw";
import causticsVert from "./caustics.vert?raw";
import cellHash from "./cell_hash.glsl?raw";
import farLand from "./far_land.glsl?raw";
import foam from "./foam.glsl?raw";
import drop from "./drop.glsl?raw";
import dropFrag from "./drop.frag?raw";
import edgesFrag from "./edges.frag?raw";
import elevationFrag from "./elevation.frag?raw";
import fieldFrag from "./field.frag?raw";
import flatShadowFrag from "./flat_shadow.frag?raw";
import flatShadowVert from "./flat_shadow.vert?raw";
import fluidColumnFrag from "./fluid_column.frag?raw";
import fluidDropFrag from "./fluid_drop.frag?raw";
import fluidDropVert from "./fluid_drop.vert?raw";
import fluidPlainFrag from "./fluid_plain.frag?raw";
import fluidPlainVert from "./fluid_plain.vert?raw";
import fluidPlainDropFrag from "./fluid_plain_drop.frag?raw";
import fluidPlainDropVert from "./fluid_plain_drop.vert?raw";
import fluidPlainFloorFrag from "./fluid_plain_floor.frag?raw";
import fluidPlainFloorVert from "./fluid_plain_floor.vert?raw";
import fluidPresentFrag from "./fluid_present.frag?raw";
import fluidShadowFrag from "./fluid_shadow.frag?raw";
import fluidShadowVert from "./fluid_shadow.vert?raw";
import fluidSprayVert from "./fluid_spray.vert?raw";
import fluidSurfaceFrag from "./fluid_surface.frag?raw";
import fluidTileMarkVert from "./fluid_tile_mark.vert?raw";
import fluidTileMarkFrag from "./fluid_tile_mark.frag?raw";
import fluidTileVert from "./fluid_tile.vert?raw";
import fluidLiquid from "./fluid_liquid.glsl?raw";
import fluidVolume from "./fluid_volume.glsl?raw";
import fluidVolumeFrag from "./fluid_volume.frag?raw";
import fluidVolumeVert from "./fluid_volume.vert?raw";
import fluidWords from "./fluid_words.glsl?raw";
import frothFrag from "./froth.frag?raw";
import fullscreenVert from "./fullscreen.vert?raw";
import glassFrag from "./glass.frag?raw";
import glitter from "./glitter.glsl?raw";
import instance from "./instance.glsl?raw";
import lampFrag from "./lamp.frag?raw";
import lampVert from "./lamp.vert?raw";
import levelFrag from "./level.frag?raw";
import lookMap from "./look_map.glsl?raw";
import lookParticleFrag from "./look_particle.frag?raw";
import lookParticleVert from "./look_particle.vert?raw";
import lookSurfaceFrag from "./look_surface.frag?raw";
import lookValueFrag from "./look_value.frag?raw";
import presentBelowFrag from "./present_below.frag?raw";
import mirror from "./mirror.glsl?raw";
import side from "./side.glsl?raw";
import presentFrag from "./present.frag?raw";
import puff from "./puff.glsl?raw";
import rainRingFrag from "./rain_ring.frag?raw";
import rainRingVert from "./rain_ring.vert?raw";
import rainStreakFrag from "./rain_streak.frag?raw";
import rainStreakVert from "./rain_streak.vert?raw";
import ripples from "./ripples.glsl?raw";
import seaBlend from "./sea_blend.glsl?raw";
import seaTileFrag from "./sea_tile.frag?raw";
import shadow from "./shadow.glsl?raw";
import shadowFrag from "./shadow.frag?raw";
import sky from "./sky.glsl?raw";
import shore from "./shore.glsl?raw";
import shoreFrag from "./shore.frag?raw";
import skyBakeFrag from "./sky_bake.frag?raw";
import skyBakeVert from "./sky_bake.vert?raw";
import skyDomeFrag from "./sky_dome.frag?raw";
import skyPlainFrag from "./sky_plain.frag?raw";
import skyPlainVert from "./sky_plain.vert?raw";
import skyDomeVert from "./sky_dome.vert?raw";
import solidFrag from "./solid.frag?raw";
import solidPlain from "./solid_plain.glsl?raw";
import solidPlainFrag from "./solid_plain.frag?raw";
import solidVert from "./solid.vert?raw";
import sprayVert from "./spray.vert?raw";
import tilesFrag from "./tiles.frag?raw";
import waterBelowFrag from "./water_below.frag?raw";
import waterFrag from "./water.frag?raw";
import waterOptics from "./water_optics.glsl?raw";
import waterPlain from "./water_plain.glsl?raw";
import waterPlainFrag from "./water_plain.frag?raw";
import waterVert from "./water.vert?raw";
import whitewaterVert from "./whitewater.vert?raw";

const kPrograms = {
  bubbles: [whitewaterVert, bubblesFrag],
  caustics: [causticsVert, causticsFrag],
  edges: [fullscreenVert, edgesFrag],
  elevation: [fullscreenVert, elevationFrag],
  field: [fullscreenVert, fieldFrag],
  flatShadow: [flatShadowVert, flatShadowFrag],
  fluidColumn: [fullscreenVert, fluidColumnFrag],
  fluidDrop: [fluidDropVert, fluidDropFrag],
  fluidPlain: [fluidPlainVert, fluidPlainFrag],
  fluidPlainDrop: [fluidPlainDropVert, fluidPlainDropFrag],
  fluidPlainFloor: [fluidPlainFloorVert, fluidPlainFloorFrag],
  fluidPresent: [fluidTileVert, fluidPresentFrag],
  fluidShadow: [fluidShadowVert, fluidShadowFrag],
  fluidSpray: [fluidSprayVert, dropFrag],
  fluidSurface: [fluidTileVert, fluidSurfaceFrag],
  fluidTileMark: [fluidTileMarkVert, fluidTileMarkFrag],
  fluidVolume: [fluidVolumeVert, fluidVolumeFrag],
  froth: [whitewaterVert, frothFrag],
  glass: [solidVert, glassFrag],
  lamp: [lampVert, lampFrag],
  level: [fullscreenVert, levelFrag],
  lookParticle: [lookParticleVert, lookParticleFrag],
  lookSurface: [waterVert, lookSurfaceFrag],
  lookValue: [fullscreenVert, lookValueFrag],
  present: [fullscreenVert, presentFrag],
  presentBelow: [skyDomeVert, presentBelowFrag],
  rainRing: [rainRingVert, rainRingFrag],
  rainStreak: [rainStreakVert, rainStreakFrag],
  seaTile: [fullscreenVert, seaTileFrag],
  shadow: [solidVert, shadowFrag],
  shore: [fullscreenVert, shoreFrag],
  skyBake: [skyBakeVert, skyBakeFrag],
  skyDome: [skyDomeVert, skyDomeFrag],
  skyPlain: [skyPlainVert, skyPlainFrag],
  solid: [solidVert, solidFrag],
  solidPlain: [solidVert, solidPlainFrag],
  spray: [sprayVert, dropFrag],
  tiles: [solidVert, tilesFrag],
  water: [waterVert, waterFrag],
  waterPlain: [waterVert, waterPlainFrag],
  waterBelow: [waterVert, waterBelowFrag],
} as const;

// Samplers default to low precision in GLSL ES, which would round elevations on phones.
const kPrecision = ["float", "int", "sampler2D", "samplerCube", "isampler2D"].map((t) => `precision highp ${t};\n`).join("");

const kShared: Record<string, string> = {
  sky,
  bed,
  below,
  bicubic,
  billows,
  border,
  caustics,
  cell_hash: cellHash,
  drop,
  far_land: farLand,
  foam,
  fluid_liquid: fluidLiquid,
  fluid_volume: fluidVolume,
  fluid_words: fluidWords,
  glitter,
  instance,
  look_map: lookMap,
  mirror,
  puff,
  ripples,
  sea_blend: seaBlend,
  shadow,
  shore,
  side,
  solid_plain: solidPlain,
  water_plain: waterPlain,
  water_optics: waterOptics,
};

function withIncludes(source: string): string {
  return source.replace(/#include <(\w+)>/g, (_, name: string) => withIncludes(kShared[name]!));
}

function expand(source: string): string {
  return kPrecision + withIncludes(source);
}

export type Uniforms = Record<string, IUniform>;

/** Parameters of materials that add to what the target has, without a depth. */
export const kAdding = {
  blending: CustomBlending, blendEquation: AddEquation, blendSrc: OneFactor, blendDst: OneFactor,
  depthTest: false, depthWrite: false, transparent: true,
} as const;

/** Parameters of materials that darken the floor that they lie on. */
export const kDarkening = {
  blending: CustomBlending, blendSrc: DstColorFactor, blendDst: ZeroFactor, transparent: true, depthWrite: false,
  polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -4,
} as const;

/** Makes a GLSL ES 3.00 material. `uniforms` is not copied, so that materials can share entries. */
export function makeMaterial(
  program: keyof typeof kPrograms,
  uniforms: Uniforms,
  parameters: ShaderMaterialParameters = {},
): RawShaderMaterial {
  const [vertex, fragment] = kPrograms[program];
  return new RawShaderMaterial({
    name: program,
    glslVersion: GLSL3,
    vertexShader: expand(vertex),
    fragmentShader: expand(fragment),
    uniforms,
    toneMapped: false,
    ...parameters,
  });
}
