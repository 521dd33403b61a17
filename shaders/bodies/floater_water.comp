// What the water, gravity and a hand do to every floater: its acceleration for the next tick. Floaters that cannot have touched anything
// move before, as in bodies/floater_contacts.comp. One invocation per slot, with samples of its volume.
// Reads FLOATER_NEAR, SURFACE, SURFACE_FLOW, PRESSURE_HEAD (that of the wave steps behind SURFACE), TERRAIN. Updates FLOATERS.
// With phi = elevation + head, the level of the water if nothing pressed on it, each sample feels
//   buoyancy   rho (-g dphi/dx, g, -g dphi/dz) of the volume of it that is under phi
//   drag       rho Cd A |u| u / 2 along each axis of the floater, u relative to the water, A its area across that axis
// and the whole, near the surface, the damping of the waves that it makes. It carries along the water around it: half of
// what it displaces (Lamb 1932, for a sphere). Waves by pressure: bodies/floater_press.comp.
// The forces are those at a position lead_s later, with which the steps of a tick neither feed nor damp an oscillation: with n steps
// per tick (n - 1) / 2n of a tick.
#include "bodies/floater.glsl"
#include "shared/fixed_point.h"
#if VARIED && NONLINEAR
#include "common/terrain_texels.glsl"
#endif

layout(local_size_x = FLOATER_GROUP) in;

layout(std430, binding = FLOATERS) restrict buffer Floaters { vec4 floaters[]; };
layout(binding = SURFACE) uniform samplerBuffer surface_texels;
layout(binding = SURFACE_FLOW) uniform samplerBuffer flow_texels;
layout(binding = PRESSURE_HEAD) uniform isamplerBuffer pressure_head;
layout(std430, binding = FLOATER_NEAR) restrict readonly buffer FloaterNear { uint near[]; };
uniform float lead_s;
uniform uint slot_count;

const float kAddedMass = 0.5;         // of the displaced mass
const float kWaveDamping = 0.12;      // of critical, at half immersion
const float kDentRate_per_s = 4.0;    // how fast the dent follows the immersion; a dent that follows late feeds an oscillation, so that
const float kSteadyShare = 1.5;       // it is the whole from this part of the immersion at rest on
const float kHandRate_per_s = 8.0;    // of the spring of a hand
const float kHandMax_mps2 = 60.0;
const float kHandTurn_per_s = 6.0;

/// Sums over the samples; forces over the density of water.
struct WaterSums {
  float immersed;         // share of the volume
  float level_m;          // mean
  vec3 water_mps;         // times the immersed share
  vec3 buoyancy, moment;  // [m^4/s^2], [m^5/s^2]
  vec3 drag, drag_moment;
};

/// A sample of the volume: position from the middle along its axes [m]; half its extents there. Four samples in a row lie kApart
/// further apart than the middles of quarters, which gives them the moment of area of the whole.
const float kApart = 1.0327956;  // sqrt(16 / 15)
vec3 sampleAt(Floater b, int k, out vec3 half_m) {
  if (b.shape == FLOATER_SPHERE) {
    half_m = b.half_m;
    return vec3(0.0);
  }
  const float row = 0.5 * float(k & 3) - 0.75;
  if (b.shape == FLOATER_BOX) {
    half_m = vec3(0.25, 0.5, 0.25) * b.half_m;
    return vec3(kApart * row, float((k >> 4) & 1) - 0.5, kApart * (0.5 * float((k >> 2) & 3) - 0.75)) * b.half_m;
  }
  // 8 columns of equal area on the circle that has the moments of area of the whole.
  const float angle = 0.78539816 * (float(k >> 2) + 0.5);
  const vec2 across = 0.70710678 * vec2(cos(angle), sin(angle));
  half_m = (b.shape == FLOATER_CYLINDER_X ? vec3(0.25, 0.32, 0.32) : vec3(0.32, 0.25, 0.32)) * b.half_m;
  return (b.shape == FLOATER_CYLINDER_X ? vec3(kApart * row, across) : vec3(across.x, row, across.y)) * b.half_m;
}

/// Share of a sphere below a level at a height over its middle, in radii.
float capShare(float height) {
  const float d = clamp(height + 1.0, 0.0, 2.0);
  return 0.25 * d * d * (3.0 - d);
}

/// Level without pressure [m], its rate [m/s], and whether there is water.
vec3 levelAt(int i) {
  const vec2 eta = texelFetch(surface_texels, i).xy;
#if VARIED && NONLINEAR
  if (eta.x <= -texelFetch(terrain, i).w + 1e-4) return vec3(eta, 0.0);
#endif
  return vec3(eta.x + ELEVATION_UNIT_M * float(texelFetch(pressure_head, i).x), eta.y, 1.0);
}

/// Level, its slopes along x and z, and the share of water around a position, bilinear between cells; the water's velocity.
vec4 waterAt(vec2 xz, out vec3 water_mps) {
  const vec2 u = clamp((xz + waveHalf_m()) / sim.wave_cell_m - 0.5, vec2(-1.0), vec2(waveCounts()));
  const ivec2 c = ivec2(floor(u));
  const vec2 t = u - vec2(c);
  const ivec2 n = waveCounts();
  const ivec2 x = ivec2(waveNeighbourX(c.x, n.x), waveNeighbourX(c.x + 1, n.x));
  const ivec2 z = n.x * ivec2(waveNeighbourZ(c.y, n.y), waveNeighbourZ(c.y + 1, n.y));
  const vec3 a = levelAt(x.x + z.x), b = levelAt(x.y + z.x), d = levelAt(x.x + z.y), e = levelAt(x.y + z.y);
  const vec3 level = mix(mix(a, b, t.x), mix(d, e, t.x), t.y);
  const vec2 slope = vec2(mix(b.x - a.x, e.x - d.x, t.y), mix(d.x - a.x, e.x - b.x, t.x)) / sim.wave_cell_m;
  const vec2 flow_mps = texelFetch(flow_texels, (t.x < 0.5 ? x.x : x.y) + (t.y < 0.5 ? z.x : z.y)).xy;
  water_mps = vec3(flow_mps.x, level.y, flow_mps.y);
  return vec4(level.x, level.z > 0.99 ? slope : vec2(0.0), level.z);
}

void add(inout WaterSums sums, Floater b, int k, vec3 upright, float part, float g) {
  vec3 half_m;
  const vec3 r = rotated(b.rotation, sampleAt(b, k, half_m) - vec3(0.0, b.ballast_m, 0.0));
  vec3 water_mps;
  const vec4 water = waterAt(b.centre_m.xz + r.xz, water_mps);
  const float height_m = water.x - (b.centre_m.y + r.y);
  const float share = b.shape == FLOATER_SPHERE ? capShare(height_m / half_m.x)
                                                : clamp(0.5 + 0.5 * height_m / dot(abs(upright), half_m), 0.0, 1.0);
  const float under = part * share * water.w;
  const vec3 buoyancy = volumeOf(b) * under * g * vec3(-water.y, 1.0, -water.z);
  const vec3 u = rotatedBack(b.rotation, b.velocity_mps + cross(b.spin_radps, r) - water_mps);
  const vec3 area_m2 = 4.0 * b.half_m.yxx * b.half_m.zzy;
  const vec3 drag = b.shape == FLOATER_SPHERE ? -0.5 * 0.47 * 3.14159265 * half_m.x * half_m.x * length(u) * u
                                              : -0.5 * (b.shape == FLOATER_BOX ? 1.05 : 0.85) * area_m2 * abs(u) * u;
  const vec3 dragged = under * rotated(b.rotation, drag);
  sums.immersed += under;
  sums.level_m += part * water.x;
  sums.water_mps += under * water_mps;
  sums.buoyancy += buoyancy;
  sums.moment += cross(r, buoyancy);
  sums.drag += dragged;
  sums.drag_moment += cross(r, dragged);
}

WaterSums sampled(Floater b, float g) {
  const int samples = b.shape == FLOATER_SPHERE ? 1 : FLOATER_SAMPLES;
  const vec3 upright = rotatedBack(b.rotation, vec3(0.0, 1.0, 0.0));
  WaterSums sums = WaterSums(0.0, 0.0, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  for (int k = 0; k < samples; ++k) add(sums, b, k, upright, 1.0 / float(samples), g);
  return sums;
}

/// Shortens a resistance so that it stops what it acts on in a tick, and does not reverse it.
vec3 stopping(vec3 resistance_mps2, vec3 relative_mps) {
  return resistance_mps2 / (1.0 + sim.tick_s * length(resistance_mps2) / max(length(relative_mps), 1e-6));
}

/// What the steps of a tick without contacts make.
Floater movedFreely(Floater b) {
  const vec3 before_mps = b.velocity_mps;
  b.velocity_mps = limited(before_mps + sim.tick_s * b.acceleration_mps2, FLOATER_MAX_MPS);
  b.spin_radps = limited(b.spin_radps + sim.tick_s * b.spin_up_radps2, FLOATER_MAX_RADPS);
  const vec3 after_mps = b.velocity_mps;
  const float late = lead_s / sim.tick_s;
  b.velocity_mps = mix(after_mps, before_mps, late);
  b = drifted(b, sim.tick_s);
  b.velocity_mps = after_mps;
  b.age_s += sim.tick_s;
  return b;
}

void main() {
  const uint own = gl_GlobalInvocationID.x;
  if (own >= slot_count) return;
  const uint at = own * FLOATER_TEXELS;
  vec4 t[FLOATER_TEXELS];
  for (uint i = 0u; i < FLOATER_TEXELS; ++i) t[i] = floaters[at + i];
  Floater b = unpackFloater(t);
  if (b.age_s < 0.0) return;
  if (near[own * FLOATER_NEAR_WORDS] == 0u) b = movedFreely(b);
  const float g = sim.gravity_mps2;
  const WaterSums sums = sampled(drifted(b, lead_s), g);

  const float volume_m3 = volumeOf(b);
  const float immersed = sums.immersed;
  const float mass_m3 = b.density_ratio * volume_m3;  // over the density of water
  const float carried = 1.0 + kAddedMass * immersed / b.density_ratio;
  // As in the implicit midpoint rule, so that a light floater is stable with any tick.
  const float height_m = 2.0 * min(b.half_m.x, min(b.half_m.y, b.half_m.z));
  const float bob2_ps2 = g / (min(b.density_ratio, 1.0) * height_m * carried);
  const float yields = 1.0 + 0.25 * bob2_ps2 * sim.tick_s * sim.tick_s * immersed;
  const vec3 water_mps = sums.water_mps / max(immersed, 1e-6);
  const vec3 relative_mps = b.velocity_mps - water_mps;
  const float at_surface = 4.0 * immersed * (1.0 - immersed);
  const float damping_per_s = 2.0 * kWaveDamping * sqrt(bob2_ps2) * at_surface;
  const vec3 drag_mps2 = stopping(sums.drag / (mass_m3 * carried) - damping_per_s * relative_mps, relative_mps);
  b.acceleration_mps2 = sums.buoyancy / (mass_m3 * carried * yields) + drag_mps2 - vec3(0.0, g / carried, 0.0) * mix(1.0, 1.0 / yields, immersed);
  const vec3 drag_radps2 = stopping(spinOf(b, sums.drag_moment) / (mass_m3 * carried) - damping_per_s * b.spin_radps, b.spin_radps);
  b.spin_up_radps2 = spinOf(b, sums.moment) / (mass_m3 * carried * yields) + drag_radps2;

  if (b.hold.w > 0.0) {
    vec2 way_m = acrossSides(b.hold.xz - b.centre_m.xz);
    const vec3 pull_m = vec3(way_m.x, sums.level_m + b.hold.y - middleOf(b).y, way_m.y);
    b.acceleration_mps2 = kHandRate_per_s * (kHandRate_per_s * pull_m - 2.0 * b.velocity_mps);
    b.acceleration_mps2 *= min(1.0, kHandMax_mps2 / max(length(b.acceleration_mps2), 1e-6));
    b.spin_up_radps2.y = 0.0;
    b.spin_up_radps2 += kHandTurn_per_s * (vec3(0.0, -b.turn_radps, 0.0) - b.spin_radps);
    b.hold.w = max(b.hold.w - sim.tick_s, 0.0);
  }

  // The dent fades as the floater sinks below the surface.
  const float top_m = middleOf(b).y + dot(abs(rotatedBack(b.rotation, vec3(0.0, 1.0, 0.0))), b.half_m);
  const float open = clamp(1.0 - (sums.level_m - top_m) / height_m, 0.0, 1.0);
  const float displaced = min(kSteadyShare * immersed / min(b.density_ratio, 1.0), 1.0) * open;
  b.dent = mix(displaced, b.dent, exp(-kDentRate_per_s * sim.tick_s));
  floaters[at] = vec4(b.centre_m, b.age_s);
  floaters[at + 1u] = b.rotation;
  floaters[at + 2u] = vec4(b.velocity_mps, b.id);
  floaters[at + 3u] = vec4(b.spin_radps, b.dent);
  floaters[at + 6u] = b.hold;
  floaters[at + 7u] = vec4(b.acceleration_mps2, b.turn_radps);
  floaters[at + 8u] = vec4(b.spin_up_radps2, 0.0);
}
