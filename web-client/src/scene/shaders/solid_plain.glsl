// Include in solid.vert for solid_plain.frag: the light of a solid at its vertices.
#include <sky>
uniform vec3 u_camera_m;
uniform sampler2D u_noise;
uniform float u_grain_m;  // size of one tile of the noise
uniform float u_wet_m;    // height over the still water up to which stone is wet
uniform vec3 u_veiled_sky[3];  // zenith, middle, horizon
uniform float u_haze_m;   // half of the light at this distance; 0: no haze
uniform float u_darkness; // 0 by day, 1 at night
#ifndef FLOATS
uniform vec2 u_extent_m;  // length and width of the water
#endif
out vec3 v_light;  // linear, or for the display
out vec4 v_leaves; // place on the noise; 1: a plant, which has leaves; how far its clump faces the eye, else 1
out vec2 v_wet;    // height over the still water in u_wet_m; share of the light that water takes
#ifdef SHORE
#include <shore>
out vec2 v_shore;  // wetness of the ground, foam of the swash
#endif

void lightSolid(vec3 world, vec3 normal, vec4 paint, bool is_over_water) {
  float grain = max(paint.a, 0.0);
  vec3 albedo = paint.rgb;
  if (grain > 0.0) albedo *= 1.0 + 0.55 * grain * (textureLod(u_noise, world.xz / (2.3 * u_grain_m), 0.0).r - 0.5);
  float plant = step(1.6, grain);
  v_leaves = vec4(vec2(world.x - 0.7 * world.z, world.y + 0.3 * world.z) / (1.7 * u_grain_m), plant, mix(1.0, dot(normal, normalize(u_camera_m - world)), plant));
  vec3 lit = albedo * (1.25 * u_sun_light * max(dot(normal, u_sun_direction), 0.0) + mix(u_ambient_down, u_ambient_up, 0.5 * normal.y + 0.5));
  // Lamps are painted brighter than white.
  lit += 1.5 * max(paint.rgb - 1.0, 0.0);
  v_wet = vec2(is_over_water ? 1e3 : world.y / u_wet_m, 0.24 * min(grain, 1.0));
#ifdef SHORE
  vec3 shore = shoreAt(world.xz, u_extent_m);
#ifdef TANK
  // Foam on standing water is the water's: on the bed of a tank it would be large patches.
  shore.b *= 1.0 - smoothstep(0.004, 0.03, shore.r);
#endif
  v_shore = simulatedShore(world.xz, u_extent_m) * step(grain, 0.95) * step(0.8, normal.y) * step(1e-3, grain) * shore.gb;
#endif
  if (u_haze_m > 0.0) {
    float hazy = max(length(world - u_camera_m) - 2.0 * max(u_extent_m.x, u_extent_m.y), 0.0) / u_haze_m;
    lit = mix(lit, u_veiled_sky[2], 0.9 * hazy / (1.0 + hazy));
  }
  if (paint.a < 0.0) lit = mix(lit, 5.0 * paint.rgb, u_darkness);
  v_light = u_is_displayed ? toDisplay(lit) : lit;
}
