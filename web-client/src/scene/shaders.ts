// The shader texts with their includes, and makeMaterial() for all of them.
import { GLSL3, RawShaderMaterial, type IUniform, type ShaderMaterialParameters } from "three";

import bed from "./shaders/bed.glsl?raw";
import below from "./shaders/below.glsl?raw";
import bubblesFrag from "./shaders/bubbles.frag?raw";
import caustics from "./shaders/caustics.glsl?raw";
import causticsFrag from "./shaders/caustics.frag?raw";
import causticsVert from "./shaders/caustics.vert?raw";
import cellHash from "./shaders/cell_hash.glsl?raw";
import elevationFrag from "./shaders/elevation.frag?raw";
import fieldFrag from "./shaders/field.frag?raw";
import flatShadowFrag from "./shaders/flat_shadow.frag?raw";
import flatShadowVert from "./shaders/flat_shadow.vert?raw";
import fluidDepthFrag from "./shaders/fluid_depth.frag?raw";
import fluidEllipse from "./shaders/fluid_ellipse.glsl?raw";
import fluidNormalFrag from "./shaders/fluid_normal.frag?raw";
import fluidParticleVert from "./shaders/fluid_particle.vert?raw";
import fluidShadowFrag from "./shaders/fluid_shadow.frag?raw";
import fluidShadowVert from "./shaders/fluid_shadow.vert?raw";
import fluidSizes from "./shaders/fluid_sizes.glsl?raw";
import fluidSmoothFrag from "./shaders/fluid_smooth.frag?raw";
import fluidSurfaceFrag from "./shaders/fluid_surface.frag?raw";
import fluidThicknessFrag from "./shaders/fluid_thickness.frag?raw";
import fluidTileMarkFrag from "./shaders/fluid_tile_mark.frag?raw";
import fluidTileVert from "./shaders/fluid_tile.vert?raw";
import frothFrag from "./shaders/froth.frag?raw";
import fullscreenVert from "./shaders/fullscreen.vert?raw";
import glassFrag from "./shaders/glass.frag?raw";
import lampFrag from "./shaders/lamp.frag?raw";
import lampVert from "./shaders/lamp.vert?raw";
import levelFrag from "./shaders/level.frag?raw";
import lookMap from "./shaders/look_map.glsl?raw";
import lookParticleFrag from "./shaders/look_particle.frag?raw";
import lookParticleVert from "./shaders/look_particle.vert?raw";
import lookSurfaceFrag from "./shaders/look_surface.frag?raw";
import lookValueFrag from "./shaders/look_value.frag?raw";
import presentBelowFrag from "./shaders/present_below.frag?raw";
import presentFrag from "./shaders/present.frag?raw";
import rainRingFrag from "./shaders/rain_ring.frag?raw";
import rainRingVert from "./shaders/rain_ring.vert?raw";
import rainStreakFrag from "./shaders/rain_streak.frag?raw";
import rainStreakVert from "./shaders/rain_streak.vert?raw";
import roomBakeFrag from "./shaders/room_bake.frag?raw";
import seaBlend from "./shaders/sea_blend.glsl?raw";
import seaTileFrag from "./shaders/sea_tile.frag?raw";
import shadow from "./shaders/shadow.glsl?raw";
import shadowFrag from "./shaders/shadow.frag?raw";
import sky from "./shaders/sky.glsl?raw";
import shore from "./shaders/shore.glsl?raw";
import shoreFrag from "./shaders/shore.frag?raw";
import skyBakeFrag from "./shaders/sky_bake.frag?raw";
import skyBakeVert from "./shaders/sky_bake.vert?raw";
import skyDomeFrag from "./shaders/sky_dome.frag?raw";
import skyDomeVert from "./shaders/sky_dome.vert?raw";
import solidFrag from "./shaders/solid.frag?raw";
import solidVert from "./shaders/solid.vert?raw";
import sprayFrag from "./shaders/spray.frag?raw";
import tilesFrag from "./shaders/tiles.frag?raw";
import waterBelowFrag from "./shaders/water_below.frag?raw";
import waterFrag from "./shaders/water.frag?raw";
import waterOptics from "./shaders/water_optics.glsl?raw";
import waterVert from "./shaders/water.vert?raw";
import whitewaterVert from "./shaders/whitewater.vert?raw";

const kPrograms = {
  bubbles: [whitewaterVert, bubblesFrag],
  caustics: [causticsVert, causticsFrag],
  elevation: [fullscreenVert, elevationFrag],
  field: [fullscreenVert, fieldFrag],
  flatShadow: [flatShadowVert, flatShadowFrag],
  fluidDepth: [fluidParticleVert, fluidDepthFrag],
  fluidNormal: [fluidTileVert, fluidNormalFrag],
  fluidShadow: [fluidShadowVert, fluidShadowFrag],
  fluidSmooth: [fluidTileVert, fluidSmoothFrag],
  fluidSurface: [fluidTileVert, fluidSurfaceFrag],
  fluidThickness: [fluidParticleVert, fluidThicknessFrag],
  fluidTileMark: [fluidParticleVert, fluidTileMarkFrag],
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
  roomBake: [skyBakeVert, roomBakeFrag],
  seaTile: [fullscreenVert, seaTileFrag],
  shadow: [solidVert, shadowFrag],
  shore: [fullscreenVert, shoreFrag],
  skyBake: [skyBakeVert, skyBakeFrag],
  skyDome: [skyDomeVert, skyDomeFrag],
  solid: [solidVert, solidFrag],
  spray: [whitewaterVert, sprayFrag],
  tiles: [solidVert, tilesFrag],
  water: [waterVert, waterFrag],
  waterBelow: [waterVert, waterBelowFrag],
} as const;

// Samplers default to low precision in GLSL ES, which would round elevations on phones.
const kPrecision = ["float", "int", "sampler2D", "samplerCube", "isampler2D"].map((t) => `precision highp ${t};\n`).join("");

const kShared: Record<string, string> = {
  sky,
  bed,
  below,
  caustics,
  cell_hash: cellHash,
  fluid_ellipse: fluidEllipse,
  fluid_sizes: fluidSizes,
  look_map: lookMap,
  sea_blend: seaBlend,
  shadow,
  shore,
  water_optics: waterOptics,
};

function withIncludes(source: string): string {
  return source.replace(/#include <(\w+)>/g, (_, name: string) => withIncludes(kShared[name]!));
}

function expand(source: string): string {
  return kPrecision + withIncludes(source);
}

export type Uniforms = Record<string, IUniform>;

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
