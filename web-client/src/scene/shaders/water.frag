// The water's surface: reflected sky by Fresnel, and through it the scene drawn before, refracted by the slope. Its colour is absorbed
// along the path in the water (Beer-Lambert, per channel) and replaced by scattered light. The plain tiers have water_plain.frag.
// MIRROR: solids are reflected as well, as far as they are on the screen; steps of the search for them. BEACH: the water ends where the bed rises above it.
// SHORE: it moves over its ground, ends between cells where its depth is 0, and thin water is as clear as its depth says.
// OPEN_SEA: the simulated water blends into the sea around it, which becomes deeper and hazier with the distance.
// UNEVEN: straight crests are drawn uneven.
// GLASS: water in a tank. SKIRT: its side, through which one looks into it. RIPPLES: waves too short for the simulation. RAIN: with the rings of rain.
// White water where the noise tile ("lace") is above a threshold that falls with the foam. FOAM: the server sends foam; otherwise
// there is only the page's own froth.
#include <sky>
#include <water_optics>
#include <bicubic>

in vec3 v_world;
in vec2 v_level_m;
in float v_view_z;
in float v_top_m;
#ifdef SKIRT
in vec3 v_side_normal;
in float v_heap_m;
#endif

uniform vec3 u_camera_m;
uniform mat4 viewMatrix;
uniform sampler2D u_field;
uniform sampler2D u_behind;
uniform sampler2D u_behind_depth;
uniform vec2 u_resolution;
uniform vec2 u_near_far_m;
uniform vec2 u_extent_m;  // length and width of the water
uniform float u_depth_m;
uniform float u_colour_ratio;  // lengths in the water of a tank count as so much longer for its colour
#ifdef BEACH
#include <bed>
#endif
#ifdef SHORE
#include <shore>
uniform float u_lift_m;  // by which thin water may lie below the ground that is drawn
#endif
#ifdef OPEN_SEA
#include <sea_blend>
in vec2 v_share_away;
#ifdef UNEVEN
in vec2 v_shoreward;
#endif
uniform float u_haze_m;
#endif
#ifdef RIPPLES
#include <ripples>
#endif
#if defined(OPEN_SEA) || defined(RIPPLES)
uniform vec2 u_slope_variances;  // of the swell and of the ripples
#endif
#ifdef FOAM
uniform sampler2D u_foam_from;
uniform sampler2D u_foam_to;
uniform float u_foam_mix;
#endif
#ifdef RAIN
uniform sampler2D u_rain;  // slopes of rings, as a repeating tile
uniform float u_rain_tile_m;
uniform float u_rain_share;
#endif
uniform sampler2D u_froth;
uniform sampler2D u_noise;
uniform float u_lace_m;
#ifdef SHADOWS
#include <shadow>
#endif
layout(location = 0) out vec4 color;

// Variance of the slopes of waves finer than the ripples.
const float kFinestVariance = 0.0006;
// Foam and shade beside what stands in the water reach this far from it along the ray, m.
const float kContactM = 0.8;
// Foam of a crest spills down this far, m.
const float kSpillM = 0.34;

#if (defined(OPEN_SEA) || defined(RIPPLES)) && !defined(SKIRT)
#define GLITTER
#include <glitter>
// The sky changes less from slope to slope than the sun does: it shows this share of a pixel's slopes.
const float kSkyShare = 0.2, kGrazing = 0.13;
const float kCapillaryVariance = 0.012;  // in the lightest breeze (after Cox & Munk 1954)
// Between walls the finest waves mirror the sun over so much more variance than they stir its mirror: glitter, not a few blots.
#ifdef GLASS
const float kSunSpread = 2.5;  // the low waves of a tank are seen from near
#elif defined(RIPPLES)
const float kSunSpread = 6.0;
#else
const float kSunSpread = 1.0;
#endif
#endif

// Albedo of the level bed of coast.ts as solid.frag draws it, on average.
const vec3 kFarBed = vec3(0.224, 0.205, 0.156);

float viewZ(float depth) {
  float near = u_near_far_m.x, far = u_near_far_m.y;
  return near * far / ((far - near) * depth - far);
}

// Distance from `from` along `direction` to the sides or the floor of the water.
float wayOut(vec3 from, vec3 direction) {
#ifdef OPEN_SEA
  vec3 high = vec3(1e5, 1e3, 1e5);
  vec3 low = vec3(-1e5, -u_depth_m, -1e5);
#else
  vec3 high = vec3(0.5 * u_extent_m.x, 1e3, 0.5 * u_extent_m.y);
  vec3 low = vec3(-0.5 * u_extent_m.x, -u_depth_m, -0.5 * u_extent_m.y);
#endif
  vec3 safe = mix(vec3(1e-6), direction, step(vec3(1e-6), abs(direction)));
  vec3 t = max((high - from) / safe, (low - from) / safe);
  return max(min(t.x, min(t.y, t.z)), 0.0);
}

#include <mirror>
#ifdef SKIRT
#include <side>
#else
#include <foam>
#endif

void main() {
  vec2 uv = gl_FragCoord.xy / u_resolution;
  float behind_depth = texture(u_behind_depth, uv).r;
  float edge = 1.0;
#ifdef SHORE
  vec3 shore = shoreAt(v_world.xz, u_extent_m);
  float inner = simulatedShore(v_world.xz, u_extent_m);
  float deep_m = shore.r;
  if (inner < 1.0) deep_m = mix(v_top_m + bedDepth(v_world.xz, u_extent_m, u_depth_m), deep_m, inner);
  if (deep_m <= 0.0) discard;
  if (behind_depth < gl_FragCoord.z) {
    // Ground and thin water are two meshes at nearly the same position: which is in front says nothing there.
    float under_m = viewZ(behind_depth) - v_view_z;
    if (under_m > u_lift_m / max((u_camera_m.y - v_world.y) / length(u_camera_m - v_world), 0.05) || deep_m > 4.0 * u_lift_m) discard;
  }
  edge = smoothstep(0.0, 0.008, deep_m);
#else
  if (behind_depth < gl_FragCoord.z) discard;
#endif
#if defined(BEACH) && !defined(SHORE)
  float deep_m = v_top_m + bedDepth(v_world.xz, u_extent_m, u_depth_m);
  if (deep_m <= 0.0) discard;
  edge = smoothstep(0.0, 0.05 * u_depth_m, deep_m);
#endif

#if defined(SKIRT) && (defined(BEACH) || defined(SHORE))
  // The water's side ends at the ground.
  if (v_world.y < v_top_m - deep_m) discard;
#endif

  vec3 from_eye = v_world - u_camera_m;
  float distance_m = length(from_eye);
  vec3 ray = from_eye / distance_m;
#ifdef SKIRT
  vec3 normal = v_side_normal;
#else
#ifdef UNEVEN
  vec2 place = unevenAt(v_level_m) / u_extent_m + 0.5;
#else
  vec2 place = v_level_m / u_extent_m + 0.5;
#endif
#ifdef OPEN_SEA
  vec4 field = v_share_away.x > 0.0 ? smoothTexel(u_field, place) : vec4(0.0);
#else
  vec4 field = smoothTexel(u_field, place);
#endif
#ifdef UNEVEN
  field *= unevenHeight(v_level_m, field.r);
  // The face of a crest that leans is steeper, and its back is flatter.
  field.gb /= max(1.0 + leanPerRise(field.r) * dot(field.gb, v_shoreward), 0.25);
#endif
  float variance = 0.0;
#ifdef OPEN_SEA
  vec2 sea_at = v_world.xz;
  // Waves smaller than a pixel are flat, and widen the reflection instead.
  vec2 width_m = fwidth(sea_at);
  vec2 lost = smoothstep(vec2(0.004, 0.01), vec2(0.05, 0.08), max(width_m.x, width_m.y) / u_tiles_m);
  // Somewhere far out there is always some wind.
  float far_out = smoothstep(0.5, 6.0, length(sea_at) / max(u_extent_m.x, u_extent_m.y));
  variance = dot(u_slope_variances, lost * vec2(1.0 - v_share_away.x, 1.0)) + 0.012 * far_out + min(kFinestVariance, u_slope_variances.y);
  field.gb = mix(texture(u_swell, sea_at / u_tiles_m.x).gb, field.gb, v_share_away.x);
#endif
  // Foam lies on the waves and damps what is finer.
  vec2 foam_slopes = field.gb;
#ifdef OPEN_SEA
  field.gb += rippleSlopes(sea_at);
#endif
#ifdef RIPPLES
  vec2 width_m = fwidth(v_world.xz);
  variance = 0.8 * kFinestVariance + u_slope_variances.y * smoothstep(0.01, 0.12, max(width_m.x, width_m.y) / u_tiles_m.y);
  field.gb += rippleSlopes(v_world.xz);
#endif
#ifdef RAIN
  if (u_rain_share > 0.0) field.gb += texture(u_rain, v_world.xz / u_rain_tile_m).rg;
#endif
  vec2 level_slopes = field.gb;
#ifdef GLITTER
  vec2 pixel_slopes = pixelSlopes(v_world.xz);
  // Capillary waves ride on the ripples: most of them in the lightest breeze.
  float lost_variance = variance + min(3.0 * u_slope_variances.y, 0.5 * u_slope_variances.y + kCapillaryVariance);
  // At grazing incidence half of them would be turned away, and be dots.
  float facing_up = smoothstep(0.0, kGrazing, dot(vec3(field.g, -1.0, field.b), ray));
  field.gb += kSkyShare * facing_up * sqrt(lost_variance) * pixel_slopes;
#endif
  // What is below is refracted by the waves that are larger than a pixel: finer ones would tear its lines into dots.
  vec3 bending = normalize(vec3(-level_slopes.x, 1.0, -level_slopes.y));
  vec3 normal = normalize(vec3(-field.g, 1.0, -field.b));
  normal = seenNormal(normal, ray, 0.9 * max(-ray.y, 0.03), 0.5 * max(-ray.y, 0.03));
#endif

  float solid_m = distance_m * (viewZ(behind_depth) / v_view_z - 1.0);
#ifndef GLASS
  // What stands in the water is close behind its surface; the bed below shallow water is not meant.
  float contact = 1.0 - smoothstep(0.0, kContactM, solid_m);
#ifdef BEACH
  contact *= smoothstep(0.03, 0.15, deep_m + ray.y * solid_m);
#endif
  // A band narrower than a pixel would be a row of dots.
  contact *= 1.0 - smoothstep(0.4, 1.6, fwidth(solid_m) / kContactM);
#elif !defined(SKIRT)
  // The floor and the panes are close everywhere.
  const float contact = 0.0;
#endif

  // The scene behind, shifted by refraction. If the shifted pixel lies in front of the water, the unshifted one is used.
  float way_m = wayOut(v_world, ray);
  vec2 shifted_uv = uv;
#ifndef SKIRT
  if (dot(bending, ray) > -0.02) bending = normal;
  vec3 bent = refract(ray, bending, 0.75);
  // At most by half of the distance of what is behind, or hulls would end at their waterline.
  float reach_m = min(0.5 * min(way_m, max(solid_m, 0.0)), 0.45);
#ifdef SHORE
  reach_m = min(reach_m, deep_m);
#endif
  vec3 shift = mat3(viewMatrix) * (bent - ray) * reach_m;
  shift.xy *= vec2(u_resolution.y / u_resolution.x, 1.0) / max(-v_view_z, 0.1);
  // Nothing is known beyond the edges of the picture: the shift fades toward them.
  vec2 room = clamp((0.5 - abs(uv - 0.5)) / (4.0 * abs(shift.xy) + 1e-5), 0.0, 1.0);
  shifted_uv = clamp(uv + shift.xy * min(room.x, room.y), 0.001, 0.999);
  float shifted_depth = texture(u_behind_depth, shifted_uv).r;
  if (shifted_depth < gl_FragCoord.z) shifted_uv = uv;
  else behind_depth = shifted_depth;
#endif
  float behind_m = distance_m * (viewZ(behind_depth) / v_view_z - 1.0);
#ifdef OPEN_SEA
  // Outside the square the bed is drawn for a short way only. Elsewhere it has one colour; far away it falls off.
  float undrawn = smoothstep(0.02, 0.35, v_share_away.y / max(u_extent_m.x, u_extent_m.y));
  float sunk = smoothstep(0.8, 5.0, length(v_world.xz) / max(u_extent_m.x, u_extent_m.y));
#ifdef BEACH
  float floor_share = bedDepth(v_world.xz, u_extent_m, u_depth_m) / u_depth_m;
  undrawn *= floor_share * floor_share;
  sunk *= floor_share * floor_share;
#endif
  vec3 far_bed = kFarBed * (1.25 * u_sun_direction.y * u_sun_light + u_ambient_up);
  vec3 behind = undrawn < 1.0 && behind_depth < 1.0 ? mix(textureLod(u_behind, shifted_uv, 0.0).rgb, far_bed, undrawn) : far_bed;
#else
  const float sunk = 0.0;
  vec3 behind = texture(u_behind, shifted_uv).rgb;
#endif
  float path_m = clamp(behind_m, 0.0, way_m) + 9.0 * sunk;
#ifdef SKIRT
  behind = throughSide(v_world, ray, normal, path_m);
#endif
#ifdef SHORE
  // In thin water the way follows from the depth and the refracted ray: the distance between two meshes says little, and a straight ray at
  // a low angle would make a film milky.
  float sine2 = 0.5625 * (1.0 - ray.y * ray.y);
  path_m = mix(deep_m * inversesqrt(1.0 - sine2), path_m, smoothstep(0.15, 0.6, deep_m));
#endif
  // The light is absorbed twice: down to the object and up to the eye.
  vec3 passed = exp(-u_loss_per_m * (u_colour_ratio * path_m * (1.0 + max(-ray.y, 0.25))));
  vec3 scattered = waterScattered(smoothstep(-0.5, 0.9, v_top_m)) * u_water_light;
#ifdef SKIRT
  scattered *= litFromAbove(v_top_m - v_world.y);
#endif
  float sunlit_share = 1.0;
#ifdef SHADOWS
  sunlit_share = sunShare(v_world, vec3(0.0, 1.0, 0.0), 0.9);
  // The sky still lights the water in the shade, but less of it near what casts the shadow.
  scattered *= mix(0.8 * u_ambient_up.g / (u_ambient_up.g + 1.25 * u_sun_direction.y * u_sun_light.g), 1.0, sunlit_share);
#endif
  float against_sun = max(dot(ray, u_sun_direction), 0.0);
  against_sun *= against_sun * sunlit_share;
#ifdef SHORE
  // Of water over land, only its own depth lets light through.
  float crest_m = min(max(v_top_m, 0.0), deep_m);
#else
  float crest_m = max(v_top_m, 0.0);
#endif
#ifndef SKIRT
  // The steep face of a breaker is thin: light from its back comes through whatever the sun's direction.
  against_sun += 0.85 * sunlit_share * smoothstep(0.2, 0.8, length(field.gb));
#endif
  // A crest is thin, a mound of splashed water is not.
  scattered += u_crest * u_sun_light * against_sun * 1.6 * crest_m / (1.0 + 0.8 * crest_m * crest_m);
  vec3 under = behind * passed + scattered * (1.0 - passed);

  float facing = clamp(-dot(normal, ray), 0.0, 1.0);
  float fresnel = waterFresnel(facing);
#ifdef SHORE
  // Thin water is broken by the sand below it, and mirrors less.
  fresnel *= mix(0.6, 1.0, smoothstep(0.02, 0.8, deep_m));
#endif
  vec3 mirrored = reflect(ray, normal);
#if defined(OPEN_SEA) && !defined(SKIRT)
  // A rough surface seen at a low angle shows more of its facing slopes (fit after Bruneton et al. 2010), and reflects higher sky.
  if (variance > 1e-4) {
    float rough = sqrt(variance);
    fresnel = mix(fresnel, fresnel / (1.0 + 22.7 * rough * sqrt(rough)), min(rough * 12.0, 1.0));
    mirrored = normalize(vec3(mirrored.x, abs(mirrored.y) + 1.6 * rough, mirrored.z));
  }
#endif
  fresnel *= edge;
#ifdef SKIRT
  vec3 water = mix(under, skyLight(vec3(mirrored.x, abs(mirrored.y), mirrored.z)), 0.2 * fresnel);
  water = withAir(withMeniscus(water, v_top_m - v_world.y), v_top_m - v_world.y, v_heap_m);
#else
  float upward = mirrored.y;
  mirrored.y = abs(upward);
  vec3 over = mirroredSky(mirrored, variance);
#ifdef MIRROR
  if (fresnel > 0.03) over = mirroredLight(v_world, mirrored, over);
#endif
#ifndef OPEN_SEA
  // What a steep slope mirrors downward is water again.
  over = mix(over, under, 0.9 - 0.9 * smoothstep(-0.07, 0.03, upward));
#endif
  vec3 water = mix(under, over, fresnel);
  // Less of the sky lights the water beside what stands in it.
  water *= 1.0 - 0.45 * contact;
#ifdef GLITTER
  if (u_sun_sharp > 0.0) water += (u_sun_sharp * sunlit_share * edge) * mirroredSun(ray, level_slopes, pixel_slopes, kSunSpread * lost_variance, facing);
#endif
#if !defined(OPEN_SEA) && !defined(GLASS)
  float foam = 0.0;
  water = mix(water, meniscusLight(), climbingShare(solid_m));
#else
  float foam = 0.62 * contact * sqrt(contact);
#endif
  float broken = 0.0;  // of crests that break
#ifdef OPEN_SEA
  if (v_share_away.x > 0.0) {
    vec2 foam_shade = insideSquare(place) * textureLod(u_froth, place, 0.0).rg;
#else
    vec2 foam_shade = textureLod(u_froth, place, 0.0).rg;
#endif
    foam = max(foam, foam_shade.r);
    water *= 1.0 - foam_shade.g;
#ifdef FOAM
    broken = shownFoam(mix(smoothTexel(u_foam_from, place).r, smoothTexel(u_foam_to, place).r, u_foam_mix));
    foam = max(foam, broken);
#endif
#ifdef OPEN_SEA
    // It spills down both sides of the crest, which lies uphill, and thins out. Wind tears it from crests which do not break yet.
    vec2 uphill = kSpillM * field.gb / (max(length(field.gb), 0.1) * u_extent_m);
    vec4 near_crest = textureLod(u_field, place + 0.5 * uphill, 0.0), far_crest = textureLod(u_field, place + uphill, 0.0);
    float curled = crestFoam(v_top_m, u_torn_by_wind * field.a);
    broken = max(max(broken, curled), max(0.8 * crestFoam(near_crest.r, near_crest.a), 0.5 * crestFoam(far_crest.r, far_crest.a)));
    foam = max(foam, broken);
    foam *= v_share_away.x;
  }
#endif
#ifdef BEACH
  // Shallow water at a beach always has a little foam; a moving shore knows where.
#ifdef SHORE
  foam = max(foam, max(0.8 * inner * shore.b, 0.6 * (1.0 - smoothstep(0.0, 0.06, deep_m))));
#else
  foam = max(foam, 0.55 * (1.0 - smoothstep(0.0, 0.055 * u_depth_m, deep_m)));
#endif
#endif
  if (foam > 0.01) {
    vec2 at = placeOfFoam(v_level_m, foam_slopes, v_top_m);
    vec3 foam_normal = normalize(vec3(-level_slopes.x, 1.0, -level_slopes.y));
#if defined(OPEN_SEA) && !defined(UNEVEN)
    // Steep waves draw out the foam of a breaker; ripples tear that of wakes and shores.
    float torn = 1.0 - smoothstep(0.1, 0.4, broken);
    at -= mix(0.25 * foam_slopes, 0.6 * field.gb, torn);
    foam_normal = mix(foam_normal, normal, torn);
#endif
#ifdef SHORE
    float bubbles = smoothstep(0.0, 0.25, deep_m);
#else
    const float bubbles = 1.0;
#endif
    water = withFoam(water, at, foam, bubbles, normalize(foam_normal), sunlit_share);
  }
#endif
#ifdef OPEN_SEA
  float hazy = max(distance_m - 2.0 * max(u_extent_m.x, u_extent_m.y), 0.0) / u_haze_m;
  if (hazy > 0.01) water = mix(water, skyLight(vec3(ray.x, max(ray.y, 0.01), ray.z)), 0.85 * hazy / (1.0 + hazy));
#endif
  color = vec4(toDisplay(water), 1.0);
}
