// Tiles and slabs with joints: floor and walls of a pool, rim and deck, table tops. Under water, crests focus the sunlight (caustics),
// and walls shade the floor. Reads v_color: colour, and the side of a tile in sides of the water.
// PLAIN: also for the display. DECK: around a pool or a tank, slabs of natural stone. WET: water splashes on them.
// CAUSTICS: from a photon grid; otherwise from the surface's curvature.
#include <sky>
#include <cell_hash>
#ifdef CAUSTICS
#include <caustics>
#endif
#ifdef SHADOWS
#include <shadow>
#endif

in vec3 v_world;
in vec3 v_normal;
in vec4 v_color;
#ifndef CAUSTICS
uniform sampler2D u_field;
#endif
uniform vec2 u_extent_m;  // length and width of the water
uniform vec2 u_half_m;
uniform float u_level_m;    // of the resting water
uniform bool u_has_water;
#ifdef DECK
uniform sampler2D u_noise;
uniform vec3 cameraPosition;
// Reach of splashed water on the deck, m, and the sizes of the stone's clouds and grain.
const float kWetM = 1.0, kCloudsM = 3.1, kGrainM = 0.7;
#else
const float kStonesPerSheet = 5.0;  // along its side
#endif
layout(location = 0) out vec4 color;

// Brightness about 1 of tiles with sides of `side_m`: `shades` is the range from the darkest to the lightest, `joint` what joints differ by,
// which reach `joint_sides` into each. Detail finer than a pixel fades to its mean, so that distant tiles neither flicker nor show as blocks.
float tiles(vec2 at, float side_m, float shades, float joint_sides, float joint) {
  vec2 cell = at / side_m;
  vec2 step_cells = fwidth(cell);
  float blur = max(step_cells.x, step_cells.y);
  float fine = 1.0 - smoothstep(0.2, 0.7, blur);
  float mean = 1.0 + 4.0 * joint_sides * joint;
  if (fine <= 0.0) return mean;
  vec2 edge = 0.5 - abs(fract(cell) - 0.5);
  float share = 1.0 - smoothstep(joint_sides - 0.5 * blur, joint_sides + 0.6 * blur, min(edge.x, edge.y));
  return mix(mean, 1.0 + shades * (cellHash(floor(cell)) - 0.5) + min(0.14 / blur, 1.0) * joint * share, fine);
}

#ifdef DECK
// Albedo of the stone `out_m` from the water, and how wet it is there.
vec4 stoneAt(vec3 albedo, vec2 at, float tile_m, float out_m) {
  float clouds = texture(u_noise, at / kCloudsM).r - 0.5;
  float grain = texture(u_noise, at.yx / kGrainM).r - 0.5;
  vec2 slab = floor(at / tile_m);
  // Slabs of one quarry are warmer, cooler, lighter and darker.
  albedo *= mix(vec3(1.10, 1.0, 0.88), vec3(0.90, 0.97, 1.04), cellHash(slab + 41.0)) * (0.86 + 0.28 * cellHash(slab + 7.0));
  albedo *= 1.0 + 0.22 * clouds + 0.30 * grain;
#ifdef WET
  float wet = 1.0 - smoothstep(0.1, 0.75, out_m / kWetM + 0.5 * clouds + 0.15 * grain);
#else
  const float wet = 0.0;
#endif
  return vec4(albedo * (1.0 - 0.36 * wet), wet);
}
#endif

#ifndef CAUSTICS
// Sunlight gathered by the curvature of the surface at the point where the light came in, for a way of `deep_m` below it.
float focusedLight(vec2 crossed, float deep_m) {
  float curvature = textureLod(u_field, crossed / u_extent_m + 0.5, 0.0).a;
  return 1.0 / clamp(1.0 + 0.25 * deep_m * curvature, 0.3, 4.0);
}
#endif

void main() {
  vec3 normal = normalize(v_normal);
  vec3 steep = abs(normal);
  vec2 at = steep.y > max(steep.x, steep.z) ? v_world.xz : steep.x > steep.z ? v_world.zy : v_world.xy;
  float tile_m = v_color.a * max(u_extent_m.x, u_extent_m.y);
#ifdef DECK
  vec2 outside_m = abs(v_world.xz) - u_half_m;
  float out_m = max(outside_m.x, outside_m.y);
  vec4 stone = stoneAt(v_color.rgb * tiles(at, tile_m, 0.14, 0.016, -0.46), at, tile_m, out_m);
  vec3 albedo = stone.rgb;
#else
  // A tile is a sheet of mosaic, whose stones have light joints.
  vec3 albedo = v_color.rgb * tiles(at, tile_m, 0.14, 0.02, -0.22) * tiles(at, tile_m / kStonesPerSheet, 0.14, 0.05, 0.1);
#endif
  float deep_m = u_level_m - v_world.y;
#ifdef DECK
  const bool below = false;
#else
  bool below = u_has_water && deep_m > 0.0 && all(lessThanEqual(abs(v_world.xz), u_half_m * 1.001));
#endif
  vec3 ambient = mix(u_ambient_down, u_ambient_up, normal.y * 0.5 + 0.5);
  vec3 toward_sun = u_sun_direction;
  vec3 sun_light = u_sun_light;
  float sun;
  if (below) {
    // Refracted at the level surface the light comes from higher up.
    sun_light = u_sun_below;
    toward_sun = normalize(vec3(u_sun_direction.xz * 0.75, 0.0).xzy + vec3(0.0, sqrt(1.0 - 0.5625 * dot(u_sun_direction.xz, u_sun_direction.xz)), 0.0));
    vec2 crossed = v_world.xz + toward_sun.xz / toward_sun.y * deep_m;
    vec2 over_m = u_half_m - abs(crossed);
    float lit = smoothstep(-0.1, 0.1, min(over_m.x, over_m.y) / (0.2 * deep_m + 0.02 * max(u_extent_m.x, u_extent_m.y)) + 0.05);
#ifdef SHADOWS
    // What is above the water; the walls' own shade is softer than the map's.
    lit *= sunShare(vec3(crossed.x, u_level_m, crossed.y), vec3(0.0, 1.0, 0.0), 0.12 * deep_m);
#endif
    // Walls take part of the light that the water scatters.
    float focus = focusedLight(crossed, deep_m);
    sun = lit * (max(dot(normal, toward_sun), 0.0) * 0.9 + 0.1) * 0.96 * mix(1.0, focus, 0.88 * u_sun_sharp);
    ambient *= vec3(0.75, 0.95, 1.0) * (1.0 - 0.25 * smoothstep(0.0, 1.0, deep_m / (0.12 * max(u_extent_m.x, u_extent_m.y))));
  } else {
    sun = max(dot(normal, toward_sun), 0.0);
#ifdef SHADOWS
    if (sun > 0.0) sun *= sunShare(v_world, normal, 0.0);
#endif
    // The rim's shade on the inner walls.
    if (steep.y < 0.5) ambient *= 0.85;
  }
  vec3 lit = albedo * (sun_light * 1.25 * sun + ambient);
#ifdef DECK
  vec3 ray = normalize(v_world - cameraPosition);
  float past = 1.0 - clamp(-ray.y, 0.0, 1.0);
  float mirror = stone.a * max(normal.y, 0.0) * (0.03 + 0.55 * past * past * past * past);
  lit = mix(lit, skyLight(vec3(ray.x, abs(ray.y), ray.z)), mirror);
#endif
#ifdef PLAIN
  if (u_is_displayed) lit = toDisplay(lit);
#endif
  color = vec4(lit, 1.0);
}
