// Include: light on its way to an eye in the water. After <sky> and <water_optics>.
// CAUSTICS: what the waves focus is seen as shafts; SHADOWS: boats cut them. OPEN_SEA: the water continues.
uniform sampler2D u_field;
uniform vec2 u_extent_m;  // length and width of the water
uniform float u_depth_m;
uniform vec2 u_near_far_m;
uniform vec3 u_floor_albedo;  // where the floor is not on the screen
#ifdef OPEN_SEA
#include <sea_blend>
#endif
#ifdef CAUSTICS
#include <caustics>
#ifdef SHADOWS
#include <shadow>
#endif
const int kShaftSteps = 10;
const float kShaftReachM = 9.0;
#endif

// Light that leaves its way besides what is absorbed. Less than the scattering that gives water its colour from above: most of it continues.
const float kVeilPerM = 0.06;
const float kGlowPerM = 0.15;
// An eye in the water gets this many times the light that leaves it upward: water scatters mostly forward.
const float kGlowPerScattered = 3.0;

// exp(-x) for x >= 0.
vec3 fadingBelow(vec3 x) {
#ifdef PLAIN
  return 1.0 / (1.0 + x * (1.0 + x * (0.5 + x * 0.1667)));
#else
  return exp(-x);
#endif
}

float viewZ(float depth) {
  float near = u_near_far_m.x, far = u_near_far_m.y;
  return near * far / ((far - near) * depth - far);
}

// Elevation of the water, as water.vert draws it.
float waterLevel(vec2 at) {
  float level = textureLod(u_field, at / u_extent_m + 0.5, 0.0).r;
#ifdef OPEN_SEA
  float share = simulatedShare(at, u_extent_m);
  if (share < 1.0) level = mix(textureLod(u_swell, at / u_tiles_m.x, 0.0).r, level, share);
#endif
  return level;
}

bool isInWater(vec3 at) {
#ifndef OPEN_SEA
  if (any(greaterThan(abs(at.xz), 0.5 * u_extent_m))) return false;
#endif
  return at.y < waterLevel(at.xz);
}

// Distance from `from` along `direction` to the sides or the floor of the water.
float wayOut(vec3 from, vec3 direction) {
#ifdef OPEN_SEA
  const vec2 half_m = vec2(1e4);
#else
  vec2 half_m = 0.5 * u_extent_m;
#endif
  vec3 high = vec3(half_m.x, 1e3, half_m.y);
  vec3 low = vec3(-half_m.x, -u_depth_m, -half_m.y);
  vec3 safe = mix(vec3(1e-6), direction, step(vec3(1e-6), abs(direction)));
  vec3 t = max((high - from) / safe, (low - from) / safe);
  return max(min(t.x, min(t.y, t.z)), 0.0);
}

vec3 floorLight() { return u_floor_albedo * (1.25 * u_sun_direction.y * u_sun_light + u_ambient_up); }

// Sunlight that is scattered along the way, relative to level water without shadows.
float shaftsAlong(vec3 from, vec3 ray, float way_m) {
#ifdef CAUSTICS
  vec3 down = refract(-u_sun_direction, vec3(0.0, 1.0, 0.0), 0.75);
  float jitter = 0.5;
  float reach_m = min(way_m, kShaftReachM);
  float sum = 0.0;
  for (int i = 0; i < kShaftSteps; ++i) {
    vec3 at = from + ray * (reach_m * (float(i) + jitter) / float(kShaftSteps));
    // Where this light crossed the level surface.
    vec2 crossed = at.xz - down.xz / down.y * at.y;
    vec2 layers = textureLod(u_caustics, crossed / u_caustic_extent_m + 0.5, 1.5).rg;
    float focus = mix(layers.g, layers.r, clamp(-at.y / u_caustic_depth_m, 0.0, 1.0));
    vec2 inside = step(abs(crossed), 0.5 * u_caustic_extent_m);
    focus = mix(1.0, focus, inside.x * inside.y);
#ifdef SHADOWS
    focus *= texture(u_shadow, (u_shadow_matrix * vec4(crossed.x, 0.0, crossed.y, 1.0)).xyz);
#endif
    sum += focus;
  }
  return mix(1.0, sum / float(kShaftSteps), u_sun_sharp);
#else
  return 1.0;
#endif
}

// `light` from the end of a way through the water, as it arrives at its beginning.
vec3 throughWater(vec3 light, vec3 from, vec3 ray, float way_m, float shafts) {
  vec3 toward_sun = -refract(-u_sun_direction, vec3(0.0, 1.0, 0.0), 0.75);
  float ahead = max(dot(ray, toward_sun), 0.0);
  ahead *= ahead;
  // Water is brighter above than below, and toward the sun, because it scatters mostly forward.
  vec3 glow = kGlowPerScattered * waterScattered(0.35) * u_water_light * mix(0.40, 1.05, smoothstep(-0.8, 0.7, ray.y));
  glow += u_crest * u_sun_below * (0.12 + 1.1 * ahead * ahead) * shafts * shafts;
  vec3 passed = fadingBelow((0.6 * u_loss_per_m + kVeilPerM) * way_m);
  return light * passed + glow * (1.0 - fadingBelow(vec3(kGlowPerM * way_m)).x);
}
