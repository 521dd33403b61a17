// Include: sunlight focused by the waves, from water/caustics_pass.ts.
#include <bicubic>
uniform sampler2D u_caustics;       // light relative to level water, at the floor and at kUpperLayer of its depth
uniform float u_caustic_depth_m;    // of the floor
uniform vec2 u_caustic_extent_m;
uniform sampler2D u_caustic_ripples;  // light that a pool's ripples focus on its floor, a repeating tile
uniform float u_caustic_tile_m;

const float kUpperLayer = 0.4;
const float kSoftLevel = 2.2;   // mip level
const float kLeastLight = 0.2;

// Light at `deep_m` below the still water, whose way through level water began at `crossed`. Mean 1.
float focusedLight(vec2 crossed, float deep_m) {
  vec2 uv = crossed / u_caustic_extent_m + 0.5;
  // The sun's disc softens the edges of light under high waves, where the grid's triangles would show.
  vec2 layers = mix(texture(u_caustics, uv).rg, textureLod(u_caustics, uv, kSoftLevel).rg, 0.5);
  // The grid is coarser than the filaments of light: what is bright is narrower and brighter in truth. Other waves fill the shade between them.
  layers = kLeastLight + (1.0 - kLeastLight) * layers * (0.72 + 0.28 * layers);
  layers = 1.35 * layers / (1.0 + 0.35 * layers);
  float share = clamp(deep_m / u_caustic_depth_m, 0.0, 1.0);
  float focus = share < kUpperLayer ? mix(1.0, layers.g, share / kUpperLayer) : mix(layers.g, layers.r, (share - kUpperLayer) / (1.0 - kUpperLayer));
  vec2 inside = smoothstep(0.5, 0.485, abs(uv - 0.5));
  float fine = 1.0;
  if (textureSize(u_caustic_ripples, 0).x > 1) {  // of pools alone
    // The map's triangles have edges: from near they are smoothed, from afar the pixels do it.
    vec2 tile_at = crossed / u_caustic_tile_m + 0.5;
    vec2 texels = 0.5 * fwidth(tile_at) * vec2(textureSize(u_caustic_ripples, 0));
    fine = mix(smoothTexel(u_caustic_ripples, tile_at, 1).r, texture(u_caustic_ripples, tile_at).r, smoothstep(0.3, 1.0, max(texels.x, texels.y)));
    fine = 1.4 * fine / (1.0 + 0.4 * fine);
  }
  return mix(1.0, focus * mix(1.0, fine, share), inside.x * inside.y);
}
