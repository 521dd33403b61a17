// Include in water.vert for water_plain.frag: the light from below the surface, for the display, and what else changes slowly over a cell of the grid.
// After the outputs of water.vert.
#include <sky>
#include <water_optics>
uniform sampler2D u_froth;
uniform vec3 u_camera_m;
uniform vec2 u_resolution;
uniform float u_colour_ratio;  // lengths in the water of a tank count as so much longer for its colour
uniform vec3 u_bed_light;      // of the level bed, which is not drawn
#ifdef FOAM
uniform sampler2D u_foam_from;
uniform sampler2D u_foam_to;
uniform float u_foam_mix;
#endif
#ifdef SHORE
#include <shore>
#endif
#ifdef OPEN_SEA
uniform vec2 u_slope_variances;  // of the swell and of the ripples
uniform float u_haze_m;
const float kSpillM = 0.4;  // reach of a crest's foam
#endif

out vec4 v_under;   // light from below the surface times its share; share of the solids below that is seen
out vec3 v_ray;     // from the camera, of length 1
out vec4 v_slopes;  // slopes; share of the ripples that a pixel resolves; rise of the mirrored ray by the others
out vec2 v_shares;  // factor of the reflection; haze
out vec2 v_foam_light;  // share of the surface that is foam; light in the flat shadows
out vec2 v_at;          // on the still water (m)

// exp(-x) for x >= 0.
vec3 fading(vec3 x) { return 1.0 / (1.0 + x * (1.0 + x * (0.5 + x * 0.1667))); }

// `slope` and `curvature` of the simulated water; `bed_m`: depth of the bed below the still water.
void preparePlain(vec2 slope, float curvature, float bed_m) {
  vec2 at = v_world.xz;
  vec3 from_eye = v_world - u_camera_m;
  float distance_m = length(from_eye);
  v_ray = from_eye / distance_m;
  float deep_m = v_top_m + bed_m;
  float undrawn = 0.0;
  v_slopes = vec4(slope, 0.0, 0.0);
  v_shares = vec2(1.0, 0.0);
  v_at = at;
  vec2 place = at / u_extent_m + 0.5;
  vec2 foam_shade = textureLod(u_froth, place, 0.0).rg;
#ifdef OPEN_SEA
  foam_shade *= insideSquare(place);
#endif
#ifdef FOAM
  foam_shade.r = max(foam_shade.r, mix(textureLod(u_foam_from, place, 0.0).r, textureLod(u_foam_to, place, 0.0).r, u_foam_mix));
#endif
#ifdef OPEN_SEA
  // It spills down from the crest, which lies uphill, and wind makes more of it (water.frag).
  vec4 crest = textureLod(u_field, place + kSpillM * slope / (max(length(slope), 0.1) * u_extent_m), 0.0);
  foam_shade.r = max(foam_shade.r, max(crestFoam(v_top_m, u_torn_by_wind * curvature), 0.75 * crestFoam(crest.r, u_torn_by_wind * crest.a)));
#endif
#ifdef OPEN_SEA
  // Waves smaller than a pixel widen the reflection instead of tilting it.
  float side_m = max(u_extent_m.x, u_extent_m.y);
  float pixel_m = distance_m * distance_m * 2.0 / (projectionMatrix[1][1] * u_resolution.y * max(u_camera_m.y - v_world.y, 0.1));
  vec2 seen = 1.0 - smoothstep(vec2(0.004, 0.01), vec2(0.05, 0.08), vec2(pixel_m) / u_tiles_m);
  // Far out the grid's cells are longer than the swell: its slopes at the vertices would be streaks.
  seen.x *= 1.0 - smoothstep(0.1, 0.6, v_share_away.y / side_m);
  float variance = dot(u_slope_variances, (1.0 - seen) * vec2(1.0 - v_share_away.x, 1.0)) + 0.012 * smoothstep(0.5, 6.0, length(at) / side_m) + 0.0006;
  float rough = sqrt(variance);
  v_slopes = vec4(mix(seen.x * textureLod(u_swell, at / u_tiles_m.x, 0.0).gb, slope, v_share_away.x), seen.y, 1.6 * rough);
  // A rough surface seen at a low angle shows more of its facing slopes (fit after Bruneton et al. 2010).
  v_shares.x = mix(1.0, 1.0 / (1.0 + 22.7 * rough * sqrt(rough)), min(rough * 12.0, 1.0));
  float hazy = max(distance_m - 2.0 * side_m, 0.0) / u_haze_m;
  v_shares.y = 0.85 * hazy / (1.0 + hazy);
  foam_shade *= v_share_away.x;
  // Far away, walls below the water are hidden by more of it than is above the bed.
  undrawn = max(smoothstep(0.02, 0.35, v_share_away.y / side_m), smoothstep(0.15, 0.6, distance_m / side_m));
#endif
#ifdef BEACH
  float level = clamp(bed_m / u_depth_m, 0.0, 1.0);
  undrawn *= level * level;
  float still_foam = 0.55 * (1.0 - smoothstep(0.0, 0.055 * u_depth_m, deep_m));
#ifdef SHORE
  float inner = simulatedShore(at, u_extent_m);
  vec3 shore = shoreAt(at, u_extent_m);
  deep_m = mix(deep_m, shore.r, inner);
  still_foam = max(inner * shore.b, 0.4 * (1.0 - smoothstep(0.0, 0.07, deep_m)));
  // None on dry ground, which is drawn at nearly the same height.
  still_foam *= smoothstep(-0.03, 0.0, deep_m);
#endif
  v_shares.x *= smoothstep(0.0, 0.2, deep_m);
  foam_shade.r = max(foam_shade.r, still_foam);
#endif
  deep_m = max(deep_m, 0.0);
  // The light is absorbed twice: down to the bed and, along the refracted ray, up to the eye.
  float path_m = deep_m * inversesqrt(1.0 - 0.5625 * (1.0 - v_ray.y * v_ray.y));
  vec3 passed = fading(u_loss_per_m * (u_colour_ratio * path_m * (1.0 + max(-v_ray.y, 0.25))));
  vec3 scattered = waterScattered(smoothstep(-0.5, 0.9, v_top_m)) * u_water_light;
  float against_sun = max(dot(v_ray, u_sun_direction), 0.0);
  float crest_m = min(max(v_top_m, 0.0), deep_m);
  scattered += u_crest * u_sun_light * ((against_sun * against_sun + 0.6 * smoothstep(0.2, 0.8, length(slope))) * 1.6 * crest_m / (1.0 + 0.8 * crest_m * crest_m));
  // Blending has one share for all colours; the bed's average light makes up for the difference.
  v_under.a = (passed.r + passed.g + passed.b) / 3.0 * (1.0 - undrawn);
  vec3 light = scattered * (1.0 - passed) + u_bed_light * (passed - v_under.a);
  v_under.rgb = toDisplay(max(light, 0.0) / max(1.0 - v_under.a, 0.02)) * (1.0 - v_under.a);
#ifndef OPEN_SEA
  // Without refraction, waves in clear water are seen by the sunlight that their curves focus and spread (thin lenses of index 1.33).
  float focus = clamp(-0.25 * deep_m * curvature, -0.6, 0.6) * v_under.a;
  v_under.rgb += max(focus, 0.0) * 0.5 * toDisplay(vec3(0.6, 0.9, 1.0) * u_water_light);
  v_under.a += 0.6 * min(focus, 0.0);
#endif
  float foam = foam_shade.r;
  // Thin foam is lace that a pixel of these tiers cannot show.
  v_foam_light = vec2(min(1.65 * foam * foam, 0.92), 1.0 - 0.6 * foam_shade.g);
}
