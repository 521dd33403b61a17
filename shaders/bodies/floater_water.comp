// What the water, gravity and a hand do to every floater: its acceleration for the next tick. Floaters that cannot have touched anything
// move before, as in bodies/floater_move.comp. One invocation per slot, with columns of its volume.
// Reads FLOATER_NEAR, SURFACE, SURFACE_FLOW, PRESSURE_HEAD (that of the wave steps behind SURFACE), TERRAIN. Updates FLOATERS.
// With phi = elevation + head, the level of the water if nothing pressed on it, each column feels
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

const float kAddedMass = 0.5;         // of the displaced mass
const float kWaveDamping = 0.12;      // of critical, at half immersion
const float kDentRate_per_s = 4.0;    // how fast the dent follows the immersion
const float kSteadyShare = 1.5;       // dent over immersion, at most 1: a dent that followed each bob, late, would feed it
const float kHandRate_per_s = 8.0;    // of the spring of a hand
const float kHandMax_mps2 = 60.0;
const float kHandTurn_per_s = 6.0;

/// Sums over the columns; forces over the density of water.
struct WaterSums {
  float immersed;         // share of the volume
  float level_m;          // mean
  vec3 water_mps;         // times the immersed share
  vec3 buoyancy, moment;  // [m^4/s^2], [m^5/s^2]
  vec3 drag, drag_moment;
};

/// A column of the volume, in the water's axes: its middle from the centre of mass, half its length upward [m], and its share of the
/// volume. Columns of a box stand on the face that looks down most; those of a cylinder along its axis, or across it if it lies. Four
/// in a row lie kApart further apart than the middles of quarters, which gives them the moment of area of the whole.
struct Column {
  vec3 middle_m;
  vec3 half_m;
  float share;
};
const float kApart = 1.0327956;  // sqrt(16 / 15)
const float kChordShare = 1.2511359;  // makes the shares of four chords of a circle 1

Column columnAt(Floater b, int k) {
  const float row = kApart * (0.5 * float(k & 3) - 0.75);
  const float other_row = kApart * (0.5 * float(k >> 2) - 0.75);
  const vec3 h = b.half_m;
  const vec3 upright = rotatedBack(b.rotation, vec3(0.0, 1.0, 0.0));
  Column c = Column(vec3(0.0), vec3(0.0), 1.0 / float(FLOATER_COLUMNS));
  if (b.shape == FLOATER_BOX) {
    const vec3 steep = abs(upright);
    const bool along_x = steep.x > max(steep.y, steep.z);
    const bool along_z = !along_x && steep.z > steep.y;
    c.middle_m = along_x ? vec3(0.0, row, other_row) : (along_z ? vec3(row, other_row, 0.0) : vec3(row, 0.0, other_row));
    c.half_m = along_x ? vec3(1.0, 0.0, 0.0) : (along_z ? vec3(0.0, 0.0, 1.0) : vec3(0.0, 1.0, 0.0));
    c.middle_m *= h;
    c.half_m *= h;
  } else {
    const bool is_x = b.shape == FLOATER_CYLINDER_X;
    const vec3 axis = is_x ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    const float radius_m = h.z;
    const vec3 steep = upright - dot(upright, axis) * axis;
    const vec3 side = is_x ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0);
    if (abs(dot(upright, axis)) > 0.7071) {
      // 4 columns in the inner half of the radius and 12 around, at the radii that give the moments of area.
      const bool is_inner = k < 4;
      const float angle = is_inner ? 1.57079633 * (float(k) + 0.5) : 0.52359878 * float(k - 4);
      const vec2 across_m = radius_m * (is_inner ? 0.35355339 : 0.79056942) * vec2(cos(angle), sin(angle));
      c.middle_m = across_m.x * side + across_m.y * cross(axis, side);
      c.half_m = axis * dot(axis, h);
    } else {
      const vec3 up = steep / max(length(steep), 1e-6);
      const float chord = sqrt(max(1.0 - other_row * other_row, 0.0));
      c.middle_m = row * dot(axis, h) * axis + other_row * radius_m * cross(axis, up);
      c.half_m = chord * radius_m * up;
      c.share *= kChordShare * chord;
    }
  }
  c.middle_m = rotated(b.rotation, c.middle_m - vec3(0.0, b.ballast_m, 0.0));
  c.half_m = rotated(b.rotation, c.half_m);
  c.half_m *= c.half_m.y < 0.0 ? -1.0 : 1.0;
  return c;
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

/// Adds a part of the volume: what of it is under water is at `r` from the centre of mass.
void add(inout WaterSums sums, Floater b, vec3 r, float under, vec4 water, vec3 water_mps, float g) {
  const vec3 buoyancy = volumeOf(b) * under * g * vec3(-water.y, 1.0, -water.z);
  const vec3 u = rotatedBack(b.rotation, b.velocity_mps + cross(b.spin_radps, r) - water_mps);
  const vec3 h = b.half_m;
  const vec3 drag = b.shape == FLOATER_SPHERE ? -0.5 * 0.47 * 3.14159265 * h.x * h.x * length(u) * u
                                              : -0.5 * (b.shape == FLOATER_BOX ? 1.05 : 0.85) * 4.0 * h.yxx * h.zzy * abs(u) * u;
  const vec3 dragged = under * rotated(b.rotation, drag);
  sums.immersed += under;
  sums.water_mps += under * water_mps;
  sums.buoyancy += buoyancy;
  sums.moment += cross(r, buoyancy);
  sums.drag += dragged;
  sums.drag_moment += cross(r, dragged);
}

WaterSums sampled(Floater b, float g) {
  WaterSums sums = WaterSums(0.0, 0.0, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  const vec3 middle = middleOf(b) - b.centre_m;
  vec3 water_mps;
  const int columns = b.shape == FLOATER_SPHERE ? 0 : FLOATER_COLUMNS;
  for (int k = 0; k < columns; ++k) {
    const Column c = columnAt(b, k);
    const vec4 water = waterAt(b.centre_m.xz + c.middle_m.xz, water_mps);
    const float height_m = water.x - (b.centre_m.y + c.middle_m.y);
    const float share = clamp(0.5 + 0.5 * height_m / max(c.half_m.y, 1e-6), 0.0, 1.0);
    add(sums, b, c.middle_m + (share - 1.0) * c.half_m, c.share * share * water.w, water, water_mps, g);
    sums.level_m += water.x / float(FLOATER_COLUMNS);
  }
  if (columns > 0) return sums;
  const vec4 water = waterAt(b.centre_m.xz + middle.xz, water_mps);
  add(sums, b, middle, capShare((water.x - b.centre_m.y - middle.y) / b.half_m.x) * water.w, water, water_mps, g);
  sums.level_m = water.x;
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
  if (own >= uint(near.length()) / FLOATER_NEAR_WORDS) return;
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
