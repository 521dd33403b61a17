// Light from the particles' liquid to the eye. A ray goes through the volume to the surface, where the sky is mirrored by Fresnel. The
// refracted ray goes on through the liquid, is reflected where no light leaves, and shows what lies behind the liquid; on its way light is
// absorbed and scattered (water_optics.glsl), and white water hides it.
// Reads the volume, the solids' colour and depth, the map of the floor. Blends over the picture; writes the surface's depth.
// WAVE: the liquid is one body with the wave, which lies in the picture already. Toward the wave's surface it fades into it. Without it the
// volume is a pool, or with GLASS a tank. AGAIN: a ray that has left the liquid may enter it again. RIPPLES: the
// surface mirrors with waves too short for particles. FROTH: boats leave foam (HEAPED: foam.glsl).
#include <sky>
#include <water_optics>
#include <fluid_volume>
#ifdef RIPPLES
#include <ripples>
const float kGlint = 1800.0, kGleam = 0.12;  // ripples spread the sun
#else
const float kGlint = 700.0, kGleam = 0.5;
#endif
#ifndef WAVE
#include <border>
#endif

in vec2 v_uv;
uniform sampler2D u_behind;
uniform sampler2D u_behind_depth;
uniform sampler2D u_noise;
uniform vec4 u_ray;            // view ray (x, y, -1) = ndc * u_ray.xy + u_ray.zw
uniform vec2 u_near_far_m;
uniform mat4 u_projection;
uniform mat4 u_camera_world;
uniform vec3 u_camera_m;
uniform float u_radius_m;      // of a particle
uniform float u_colour_ratio;  // lengths in the liquid count as so much longer for its colour
uniform float u_floor_m;
#ifdef WAVE
uniform sampler2D u_field;
uniform vec2 u_extent_m;       // length and width of the wave
#else
uniform sampler2D u_floor_light;  // the floor of the tank from above
uniform vec2 u_floor_size_m;
const float kMapped = 0.485;   // share of the map without the rim, which hides the floor from above
#endif
#ifdef FROTH
uniform sampler2D u_froth;
uniform float u_lace_m;        // size of one tile of the foam's lace
#include <foam>
const float kFrothCover = 0.72;  // the lace of a pool's froth is never closed
#endif
#include <fluid_liquid>
layout(location = 0) out vec4 color;

const float kFromAir = 0.75, kFromWater = 1.333;  // ratios of refractive indices
// Step of a ray near the liquid.
const float kStepCells = 0.85;
// Where no kernel reaches, the surface is at least so many particle radii away.
const float kEmptyRadii = 3.6;
const int kMostSteps = 256, kMostStepsInside = 96;
// Parts of the ray in the liquid, between reflections.
const int kParts = 3;
// Whiteness: light that it scatters over one particle radius. Sunlight on white water that faces away from the sun, and toward it.
#ifdef WAVE
const float kRoom = 0.25;              // share of the way to the picture's edge by which what is behind may be shifted
const float kWhiteness = 0.14;
const vec2 kFrothSun = vec2(0.0, 1.05);
// Thickness of the mist around white water, as density, that hides what is behind it over one particle radius.
const float kMist = 0.25;
#else
const float kRoom = 1.0;
#ifdef GLASS
const float kLitRadii = 26.0;  // height over the floor above which water is lit fully, in particle radii
const float kWhiteness = 0.9;  // of broken water at a pane
const float kLongestWaySides = 1.2;  // longest way through water that counts for its colour, in shorter sides of the tank
#elif defined(AGAIN)
const float kWhiteness = 0.012;  // of two sheets
#else
const float kWhiteness = 0.1;
#endif
const vec2 kFrothSun = vec2(0.6, 1.2);       // little of it, which light passes
#endif

const vec3 kFroth = vec3(0.93, 0.96, 0.97);
const float kAwayLit = 0.5, kTowardLit = 1.1;
// Normals of steep water that face the eye by less than this cosine are turned (seenNormal).
const float kSeenFrom = 0.3;
// Mip level of what is mirrored: clouds are blurred.
const float kMirrorLevel = 4.0;

vec3 skyAlong(vec3 ray) { return textureLod(u_sky, vec3(ray.x, abs(ray.y), ray.z), kMirrorLevel).rgb; }

float distanceAt(vec2 uv) {
  float near = u_near_far_m.x, far = u_near_far_m.y;
  return near * far / (far - (far - near) * texture(u_behind_depth, uv).r);
}

// How far a position lies above the wave, in particle radii.
float overWave(vec3 at_m) {
#ifdef WAVE
  return (at_m.y - texture(u_field, at_m.xz / u_extent_m + 0.5).r) / u_radius_m;
#else
  return 1e3;
#endif
}

// The normal as far as the eye sees it; level water is seen at low angles, too.
vec3 facingEye(vec3 normal, vec3 ray) {
  float from = mix(kSeenFrom, min(kSeenFrom, 0.9 * max(-ray.y, 0.03)), clamp(normal.y, 0.0, 1.0));
  return seenNormal(normal, ray, from, 0.5 * from);
}

// Where the picture shows a position, and how far away it is along the axis of the view.
vec3 shownAt(vec3 at_m) {
  vec3 at = transpose(mat3(u_camera_world)) * (at_m - u_camera_m);
  return vec3(((at.xy / max(-at.z, 1e-3) - u_ray.zw) / u_ray.xy) * 0.5 + 0.5, -at.z);
}

// The light along a ray at a distance: that of the picture of the solids at the place where it shows it. Toward the picture's edges and
// where something stands in front of the liquid it is that of a place nearer to this pixel; for rays that rise past the edges, of the sky.
vec3 behindAt(vec3 from, vec3 ray, float away_m, float surface_m) {
  vec3 at = shownAt(from + ray * away_m);
  vec2 uv = at.xy;
  vec2 away = uv - v_uv;
  vec2 most = max(step(0.0, away) - v_uv, v_uv - step(0.0, away)) / max(abs(away), vec2(1e-5));
  vec2 shown = v_uv + away * min(kRoom * min(most.x, most.y), 1.0);
  for (int i = 0; i < 3 && distanceAt(shown) < surface_m; ++i) shown = mix(shown, v_uv, i == 2 ? 1.0 : 0.5);
  vec2 rim = smoothstep(0.5, 0.47, abs(uv - 0.5));
  float is_sky = smoothstep(-0.05, 0.05, ray.y) * (1.0 - (at.z > 0.0 ? rim.x * rim.y : 0.0));
  return mix(texture(u_behind, shown).rgb, textureLod(u_sky, ray, 1.0).rgb, is_sky);
}

// What a ray from the surface meets: the sky; in gardens what is around the pool, and the walls of a tank, as far as they are on the screen.
vec3 lightAround(vec3 from, vec3 ray) {
  ray.y = abs(ray.y);
  vec3 light = skyAlong(ray);
#ifndef WAVE
  light = behindShrubs(light, ray);
  vec2 extent_m = u_volume_max_m.xz - u_volume_min_m.xz;
  vec3 at = shownAt(atBorder(from, ray, extent_m));
  if (distanceAt(clamp(at.xy, 0.0, 1.0)) > 0.5 * at.z) light = mix(light, texture(u_behind, at.xy).rgb, pictureShare(at.xy) * step(0.0, at.z));
#ifdef GLASS
  at = shownAt(atSides(from, ray, 0.5 * extent_m));
  if (distanceAt(clamp(at.xy, 0.0, 1.0)) < at.z + u_radius_m) light = mix(light, texture(u_behind, at.xy).rgb, pictureShare(at.xy));
#endif
#endif
  return light;
}

void main() {
  vec3 view_ray = vec3((v_uv * 2.0 - 1.0) * u_ray.xy + u_ray.zw, -1.0);
  float per_m = length(view_ray);
  vec3 ray = mat3(u_camera_world) * view_ray / per_m;
  float solid_m = distanceAt(v_uv) * per_m;
  vec2 way_m = throughVolume(u_camera_m, ray);
  float end_m = min(way_m.y, solid_m);
  float at_m = max(way_m.x, 0.0) + 1e-4, before_m = at_m;
  if (at_m >= end_m) discard;
  // The first step differs from pixel to pixel, so that steps make no bands.
  float step_m = kStepCells * u_cell_m;
  float first_m = step_m * fract(52.98 * fract(0.067 * gl_FragCoord.x + 0.0058 * gl_FragCoord.y));

  vec2 liquid = liquidAt(u_camera_m + ray * at_m);
  bool is_pane = liquid.x > 0.0;
  float mist = 0.0;
  for (int i = 0; i < kMostSteps && liquid.x <= 0.0 && at_m < end_m; ++i) {
    before_m = at_m;
    at_m = min(at_m + (i == 0 ? first_m : liquid.x <= -kSurface ? max(step_m, kEmptyRadii * u_radius_m) : step_m), end_m);
    liquid = liquidAt(u_camera_m + ray * at_m);
#ifdef WAVE
    // Hidden by the wave.
    if (overWave(u_camera_m + ray * at_m) < -1.0) break;
    mist += (at_m - before_m) * max(liquid.x + kSurface - 0.2, 0.0) * liquid.y * liquid.y;
#endif
  }
#ifdef WAVE
  mist = 1.0 - exp(-kMist / u_radius_m * mist);
#endif
  vec3 froth = kFroth * (u_sun_light * 0.7 + u_ambient_up * vec3(1.05, 0.98, 0.91));
  if (liquid.x <= 0.0) {
    if (mist < 0.01) discard;
    color = vec4(toDisplay(froth), mist);
    gl_FragDepth = clamp(0.5 * (u_projection[3][2] * per_m / before_m - u_projection[2][2]) + 0.5, 0.0, 1.0);
    return;
  }
  if (!is_pane) at_m = crossing(u_camera_m, ray, before_m, at_m);
  vec3 surface = u_camera_m + ray * at_m;
  float raised = smoothstep(1.0, 2.4, overWave(surface));
  if (raised <= 0.0) discard;
  vec3 bending = facingEye(is_pane ? sideAt(surface) : normalAt(surface), ray);
  vec3 normal = bending;
#ifdef RIPPLES
  // Of level water only in what is mirrored: refracted by them, what lies below would be torn.
  normal.xz -= rippleSlopes(surface.xz) * max(normal.y, 0.0) * (1.0 - liquid.y);
#ifdef GLASS
  if (!is_pane) {
    vec2 along = rippleSlopes(surface.yz) * abs(bending.x), across = rippleSlopes(surface.xy) * abs(bending.z);
    vec3 steep = vec3(across.x, along.x + across.y, along.y) * (1.0 - liquid.y);
    normal -= steep;
    bending = facingEye(normalize(bending - steep), ray);
  }
#endif
  normal = facingEye(normalize(normal), ray);
#endif
  // Behind the pane's inner face.
  float ahead_m = (at_m + (is_pane ? 0.1 * u_radius_m : 0.0)) / per_m;

  // Through the liquid to where the ray leaves it, reflected less than kParts times.
  vec3 from = surface, bent = refract(ray, bending, kFromAir), leaving = bent;
  float length_m = 0.0, white_m = 0.0, past_m = 0.0;
  bool is_floor = false;
  float caught;  // share of the light that is reflected back into the liquid where the rest leaves it; it comes from the floor
  for (int part = 0; part < kParts; ++part) {
    caught = 0.0;
    float along_m = 0.2 * u_radius_m;
    float most_m = throughVolume(from, bent).y;
    bool is_side = true;
    for (int i = 0; i < kMostStepsInside; ++i) {
      float next_m = min(along_m + 2.0 * step_m, most_m);
      vec3 at = from + bent * next_m;
      vec2 through = liquidAt(at);
      if (through.x < 0.0) {
        next_m = crossing(from, bent, along_m, next_m);
        is_side = false;
      }
      white_m += (next_m - along_m) * through.y * through.y;
      along_m = next_m;
      if (!is_side || along_m >= most_m || overWave(at) < 0.0) break;
    }
    from += bent * along_m;
    length_m += along_m;
    leaving = bent;
    is_floor = is_side && from.y < u_volume_min_m.y + 0.5 * u_cell_m;
    if (is_floor || overWave(from) < 0.0) break;
    vec3 outward = is_side ? sideAt(from) : normalAt(from);
#ifndef WAVE
    // A sheet has parallel sides: it hardly turns what is seen through it, and mirrors nothing totally.
    if (part == 0 && !is_side) outward = normalize(mix(-bending, outward, smoothstep(4.0 * u_radius_m, 10.0 * u_radius_m, along_m)));
#endif
    leaving = refract(bent, -outward, kFromWater);
    past_m = max(solid_m - at_m - length_m, 0.5 * u_radius_m);
    if (dot(leaving, leaving) > 0.0) {
      caught = waterFresnel(clamp(dot(leaving, outward), 0.0, 1.0));
      break;
    }
    past_m = 0.0;
    caught = 1.0;
    bent = leaving = reflect(bent, outward);
    from += 0.2 * u_radius_m * bent;
  }
#ifdef WAVE
  float own_m = length_m;
  // Further down it is the wave's water.
  if (leaving.y < -0.05) {
    float down_m = clamp((from.y - u_floor_m) / -leaving.y, 0.0, 40.0);
    // As far as in water.frag.
    past_m = min(down_m, 0.45);
    length_m += down_m;
  }
#else
  // What stands in the liquid is seen through less of it.
  length_m = min(length_m, max(solid_m - at_m, 0.0) + 2.0 * u_radius_m);
#endif
  // Beyond the air behind it there may be liquid again.
  vec4 again = vec4(0.0);  // what it mirrors, and the share of it
#ifdef AGAIN
  if (!is_floor) {
    float most_m = min(throughVolume(from, leaving).y, past_m);
    for (float along_m = u_radius_m; along_m < most_m; along_m += 2.0 * step_m) {
      vec3 at = from + leaving * along_m;
      vec2 through = liquidAt(at);
      if (through.x <= 0.0) continue;
      length_m += 2.0 * step_m;
      white_m += 2.0 * step_m * through.y * through.y;
      if (again.a > 0.0) continue;
      vec3 turned = facingEye(normalAt(at), leaving);
      again = vec4(skyAlong(reflect(leaving, turned)), waterFresnel(-dot(turned, leaving)));
    }
  }
#endif
#ifdef WAVE
  vec3 behind = behindAt(from, leaving, past_m, ahead_m);
#else
  // Unless something stands before it.
  vec3 at_floor = shownAt(from);
  float shown_m = distanceAt(at_floor.xy);
  bool is_shown = all(lessThan(abs(at_floor.xy - 0.5), vec2(0.5))) && shown_m < at_floor.z - 2.0 * u_radius_m;
  // The rim of a pool does not stand in it.
  vec2 inside_m = min(u_volume_max_m.xz, -u_volume_min_m.xz) - abs(u_camera_m + (from - u_camera_m) * (shown_m / at_floor.z)).xz;
  is_shown = is_shown && min(inside_m.x, inside_m.y) > u_radius_m;
  vec3 floor_light = texture(u_floor_light, vec2(1.0, -1.0) * clamp(from.xz / u_floor_size_m, -kMapped, kMapped) + 0.5).rgb;
  vec3 behind = is_floor && !is_shown ? floor_light : mix(behindAt(from, leaving, past_m, ahead_m), floor_light, caught);
#endif
  behind = mix(behind, again.rgb, again.a);
#ifdef GLASS
  // Along a tank it is hardly darker than across.
  vec2 volume_m = (u_volume_max_m - u_volume_min_m).xz;
  float most_m = kLongestWaySides * min(volume_m.x, volume_m.y);
  length_m = most_m * (1.0 - exp(-length_m / most_m));
#endif
  vec3 passed = exp(-u_loss_per_m * length_m * u_colour_ratio);
  float sun = clamp(dot(normal, u_sun_direction) * 0.5 + 0.5, 0.0, 1.0);
  float against_sun = max(dot(ray, u_sun_direction), 0.0);
  vec3 scattered = waterScattered(0.25 + 0.4 * clamp(normal.y, 0.0, 1.0)) * u_water_light * mix(kAwayLit, kTowardLit, sun);
#ifdef GLASS
  // Light comes from above: a crest is bright, the foot of a wave is dark.
  scattered *= 0.75 + 0.8 * smoothstep(0.0, kLitRadii, (surface.y - u_volume_min_m.y) / u_radius_m);
#endif
  scattered += u_crest * u_sun_light * against_sun * against_sun * 0.35;
  vec3 lit_froth = kFroth * (u_sun_light * mix(kFrothSun.x, kFrothSun.y, sun * sun) + 1.15 * u_ambient_up);
#ifdef GLASS
  // Through glass its bubbles are seen from near.
  vec3 bubbles_at = surface / u_radius_m;
  float mottled = -1.2;
  for (int i = 0; i < 3; ++i) {
    // Each octave turned, or the noise's grid would show.
    bubbles_at = vec3(0.8 * bubbles_at.x - 0.6 * bubbles_at.y, 0.6 * bubbles_at.x + 0.8 * bubbles_at.y, bubbles_at.z).yzx * 2.3;
    mottled += lumps(bubbles_at);
  }
  white_m *= clamp(0.85 + 0.6 * mottled, 0.5, 1.6);
#endif
  float white = 1.0 - exp(-kWhiteness * white_m / u_radius_m);
  vec3 under = mix(behind * passed + scattered * (1.0 - passed), lit_froth, white);

  // Glass hides most of the reflection of the water behind it.
  float fresnel = waterFresnel(clamp(-dot(normal, ray), 0.0, 1.0)) * (is_pane ? 0.15 : 1.0 - 0.7 * white);
  vec3 mirrored = reflect(ray, normal);
  vec3 mirrored_light = lightAround(surface, mirrored);
  float at_sun = dot(mirrored, u_sun_direction);
  if (is_pane) under = mix(under, meniscusLight(), 0.3 * smoothstep(0.05, 0.01, liquid.x) * (1.0 - white));
  float glint = is_pane || at_sun < 0.9 ? 0.0 : u_sun_sharp * (pow(at_sun, kGlint) * 9.0 + pow(at_sun, 70.0) * kGleam) * (0.1 + fresnel) * (1.0 - white);
  float alpha = raised;
#ifdef WAVE
  // Where the solids were drawn on the canvas, what is there shows through by the green share of its light that passes.
  if (textureSize(u_behind, 0).x == 1) {
    vec3 own_passed = exp(-u_loss_per_m * own_m);
    float kept = own_passed.g * (1.0 - white) * (1.0 - fresnel) * (1.0 - mist);
    under = mix(scattered * (1.0 - own_passed), lit_froth, white) / max(1.0 - kept, 0.02);
    alpha *= 1.0 - kept;
    fresnel = min(fresnel / max(1.0 - kept, 0.02), 1.0);
  }
#endif
  vec3 light = mix(under, mirrored_light, fresnel) + glint * u_sun_light;
#ifdef FROTH
  if (!is_pane) {
    vec2 foam_shade = textureLod(u_froth, surface.xz / (u_volume_max_m.xz - u_volume_min_m.xz) + 0.5, 0.0).rg;
    light *= 1.0 - foam_shade.g;
    if (foam_shade.r > 0.01) light = withFoam(light, surface.xz, kFrothCover * foam_shade.r, 1.0, normal, 1.0);
  }
#endif
  color = vec4(toDisplay(mix(light, froth, mist)), alpha);
  gl_FragDepth = clamp(0.5 * (u_projection[3][2] / ahead_m - u_projection[2][2]) + 0.5, 0.0, 1.0);
#ifdef WAVE
  // Drawn in front of the wave's surface, from which it can hardly be told.
  gl_FragDepth -= 1e-4 * (1.0 - raised);
#endif
}
