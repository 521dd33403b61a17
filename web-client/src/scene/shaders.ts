// The shader texts with their includes, and makeMaterial() for all of them.
import { GLSL3, RawShaderMaterial, type IUniform, type ShaderMaterialParameters } from "three";

import bed from "./shaders/bed.glsl?raw";
import cellHash from "./shaders/cell_hash.glsl?raw";
import elevationFrag from "./shaders/elevation.frag?raw";
import fieldFrag from "./shaders/field.frag?raw";
import fullscreenVert from "./shaders/fullscreen.vert?raw";
import glassFrag from "./shaders/glass.frag?raw";
import particleColor from "./shaders/particle_color.glsl?raw";
import particleFrag from "./shaders/particle.frag?raw";
import particlePlainFrag from "./shaders/particle_plain.frag?raw";
import particleVert from "./shaders/particle.vert?raw";
import presentFrag from "./shaders/present.frag?raw";
import roomBakeFrag from "./shaders/room_bake.frag?raw";
import seaBlend from "./shaders/sea_blend.glsl?raw";
import seaTileFrag from "./shaders/sea_tile.frag?raw";
import sky from "./shaders/sky.glsl?raw";
import skyBakeFrag from "./shaders/sky_bake.frag?raw";
import skyBakeVert from "./shaders/sky_bake.vert?raw";
import skyDomeFrag from "./shaders/sky_dome.frag?raw";
import skyDomeVert from "./shaders/sky_dome.vert?raw";
import solidFrag from "./shaders/solid.frag?raw";
import solidVert from "./shaders/solid.vert?raw";
import tilesFrag from "./shaders/tiles.frag?raw";
import waterFrag from "./shaders/water.frag?raw";
import waterVert from "./shaders/water.vert?raw";

const kPrograms = {
  elevation: [fullscreenVert, elevationFrag],
  field: [fullscreenVert, fieldFrag],
  glass: [solidVert, glassFrag],
  particle: [particleVert, particleFrag],
  particlePlain: [particleVert, particlePlainFrag],
  present: [fullscreenVert, presentFrag],
  roomBake: [skyBakeVert, roomBakeFrag],
  seaTile: [fullscreenVert, seaTileFrag],
  skyBake: [skyBakeVert, skyBakeFrag],
  skyDome: [skyDomeVert, skyDomeFrag],
  solid: [solidVert, solidFrag],
  tiles: [solidVert, tilesFrag],
  water: [waterVert, waterFrag],
} as const;

// Samplers default to low precision in GLSL ES, which would round elevations on phones.
const kPrecision = ["float", "int", "sampler2D", "samplerCube", "isampler2D"].map((t) => `precision highp ${t};\n`).join("");

const kShared: Record<string, string> = { sky, bed, cell_hash: cellHash, particle_color: particleColor, sea_blend: seaBlend };

function expand(source: string): string {
  return kPrecision + source.replace(/#include <(\w+)>/g, (_, name: string) => kShared[name]!);
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
