// What the contacts of every floater that can touch something change in a part of a tick. One invocation per floater: the contacts of
// its points with surfaces.
// Reads FLOATERS, FLOATER_NEAR, TERRAIN, BOATS. Adds to FLOATER_PUSH (bodies/floater_move.comp applies it), BOAT_PUSH.
// Contacts are springs and dampers that never pull, with Coulomb friction. All act at once, and both sides of a contact get the same
// impulse: momentum stays. The factors are in units of the mass m that a contact moves and of the step h: an impulse of
// m (kStiffness overlap / h + kDamping approach), divided among neighbours, is stable for a floater that is touched on all sides.
#include "bodies/floater_shape.glsl"
#include "bodies/floater_texels.glsl"
#if HULLS
#include "bodies/boat.glsl"
#endif
#if VARIED
#include "common/terrain.glsl"
#endif

layout(local_size_x = FLOATER_GROUP) in;

layout(std430, binding = FLOATER_PUSH) restrict buffer FloaterPush { int floater_push[]; };
layout(std430, binding = FLOATER_NEAR) restrict readonly buffer FloaterNear { uint near[]; };
#if HULLS
layout(binding = BOATS) uniform samplerBuffer boats;
layout(std430, binding = BOAT_PUSH) restrict buffer BoatPush { int boat_push[]; };
#endif
uniform float step_s;

const float kStiffness = 0.08;
const float kDamping = 0.2;
const float kOverlapMost = 0.2;       // of half the length: a deeper overlap pushes no more
const float kFriction = 0.5;          // of wood on wood
const float kShareFrom = 3.0;         // neighbours from which on they share the impulse

/// Change of velocity and of spin, and number of contacts.
struct Push {
  vec3 velocity_mps;
  vec3 spin_radps;
  int contacts;
};

ivec3 pushUnits(vec3 change) { return ivec3(round(clamp(change, vec3(-64.0), vec3(64.0)) * PUSH_UNITS)); }

void give(uint slot, Push push) {
  if (push.contacts == 0) return;
  const ivec3 velocity = pushUnits(push.velocity_mps);
  const ivec3 spin = pushUnits(push.spin_radps);
  for (int axis = 0; axis < 3; ++axis) {
    atomicAdd(floater_push[8u * slot + axis], velocity[axis]);
    atomicAdd(floater_push[8u * slot + 3u + axis], spin[axis]);
  }
  atomicAdd(floater_push[8u * slot + 6u], push.contacts);
}

/// Inverse of the mass that an impulse along n at r moves, over the mass. [1]
float yieldOf(Floater b, vec3 r, vec3 n) {
  const vec3 lever = cross(r, n);
  return 1.0 + dot(lever, spinOf(b, lever));
}

/// Impulse over the mass [m/s] of a contact at r from the centre of mass, pushed along n, against something that moves with other_mps.
/// `lightness` is the other's inverse mass along n over the inverse mass of this one; `share` the part of the impulse that is applied.
vec3 impulseOf(Floater b, vec3 r, vec3 n, float overlap_m, vec3 other_mps, float lightness, float share) {
  const vec3 relative_mps = b.velocity_mps + cross(b.spin_radps, r) - other_mps;
  const float approach_mps = -dot(relative_mps, n);
  const float mass = share / (yieldOf(b, r, n) + lightness);
  const float pressed = mass * max(kStiffness * min(overlap_m, kOverlapMost * b.half_m.x) / step_s + kDamping * approach_mps, 0.0);
  const vec3 sliding_mps = relative_mps + approach_mps * n;
  const float speed_mps = length(sliding_mps);
  const float held = min(kFriction * pressed, mass * kDamping * speed_mps);
  return overlap_m > 0.0 ? pressed * n - held / max(speed_mps, 1e-6) * sliding_mps : vec3(0.0);
}

/// Adds an impulse over the mass of a floater at r from its centre.
void add(inout Push push, Floater b, vec3 r, vec3 impulse_mps, bool touches) {
  push.velocity_mps += impulse_mps;
  push.spin_radps += spinOf(b, cross(r, impulse_mps));
  push.contacts += touches ? 1 : 0;
}

/// Contact with something that does not move.
void touch(inout Push push, Floater b, vec3 r, vec3 n, float overlap_m) {
  add(push, b, r, impulseOf(b, r, n, overlap_m, vec3(0.0), 0.0, 1.0), overlap_m > 0.0);
}

/// Contact of the points of one floater with the surface of another.
void meetFloater(inout Push push, Floater b, uint own, uint other, float share) {
  // Only lists that differ by a rounding leave the other one out: nobody would apply its push.
  if (near[other * FLOATER_NEAR_WORDS] == 0u) return;
  const Floater o = floaterAt(other);
  Push other_push = Push(vec3(0.0), vec3(0.0), 0);
  vec3 apart_m = o.centre_m - b.centre_m;
  apart_m.xz = acrossSides(apart_m.xz);
  // Two at one position separate by their order.
  if (dot(apart_m, apart_m) < 1e-6 * b.half_m.x * b.half_m.x) apart_m.x += (own < other ? 1e-3 : -1e-3) * b.half_m.x;
  const float mass_ratio = b.density_ratio * volumeOf(b) / (o.density_ratio * volumeOf(o));
  const float radius_m = pointRadius(b);
  const int count = pointCount(b);
  // First which points touch, then the impulses of these: a loop ends when no lane of a vector has one left, a condition skips nothing.
  uint touching = 0u;
  for (int k = 0; k < count; ++k)
    touching |= surfaceOf(o, pointOf(b, k) - apart_m).w < radius_m ? 1u << k : 0u;
  while (touching != 0u) {
    const vec3 point = pointOf(b, findLSB(touching));
    touching &= touching - 1u;
    const vec4 there = surfaceOf(o, point - apart_m);
    const vec3 r = point - radius_m * there.xyz;
    const vec3 ro = r - apart_m;
    const float overlap_m = radius_m - there.w;
    const vec3 impulse_mps =
        impulseOf(b, r, there.xyz, overlap_m, o.velocity_mps + cross(o.spin_radps, ro), mass_ratio * yieldOf(o, ro, there.xyz), share);
    add(push, b, r, impulse_mps, overlap_m > 0.0);
    add(other_push, o, ro, -mass_ratio * impulse_mps, overlap_m > 0.0);
  }
  give(other, other_push);
}

/// Contact of a point with the bed, rocks and the sides.
void meetGround(inout Push push, Floater b, int k) {
  const float radius_m = pointRadius(b);
  const vec3 r = pointOf(b, k);
  const vec3 at = b.centre_m + r;
  float bed_m = -sim.wave_depth_m;
  vec3 up = vec3(0.0, 1.0, 0.0);
#if VARIED
  const vec4 t = terrainAt(at.xz);
  bed_m = -t.w;
  const bool is_in_rock = t.x < radius_m && t.w <= 0.0;
  if (is_in_rock && radius_m - t.x < bed_m - at.y + radius_m) {
    const vec3 n = vec3(t.y, 0.0, t.z);
    touch(push, b, r - radius_m * n, n, radius_m - t.x);
    bed_m = -1e6;
  } else if (at.y - radius_m < bed_m) {
    const float cell_m = sim.wave_cell_m;
    const vec2 deeper = vec2(terrainAt(at.xz + vec2(cell_m, 0.0)).w - terrainAt(at.xz - vec2(cell_m, 0.0)).w,
                             terrainAt(at.xz + vec2(0.0, cell_m)).w - terrainAt(at.xz - vec2(0.0, cell_m)).w);
    up = normalize(vec3(deeper.x, 2.0 * cell_m, deeper.y));
  }
#endif
  touch(push, b, r - radius_m * up, up, (bed_m - at.y + radius_m) * up.y);
  const vec2 beyond_m = abs(at.xz) + radius_m - waveHalf_m();
  const vec2 inward = -sign(at.xz);
#if !WAVE_PERIODIC_X
  touch(push, b, r - vec3(radius_m * inward.x, 0.0, 0.0), vec3(inward.x, 0.0, 0.0), beyond_m.x);
#endif
#if !WAVE_PERIODIC_Z
  touch(push, b, r - vec3(0.0, 0.0, radius_m * inward.y), vec3(0.0, 0.0, inward.y), beyond_m.y);
#endif
}

#if HULLS
/// A hull as a box that turns about the vertical only, for the contacts of this step.
struct Hull {
  vec3 centre_m, half_m, velocity_mps;
  vec2 forward, starboard;
  float mass_ratio;  // of the floater over the boat
};

/// Adds an impulse at `at` from the floater's centre, along n from the hull; the boat gets the opposite.
void meetHull(inout Push push, inout vec2 given_mps, Floater b, Hull hull, vec3 at, vec3 n, float overlap_m) {
  // A boat moves once per tick: its share of an impulse must last for all steps.
  const vec3 impulse_mps = impulseOf(b, at, n, overlap_m, hull.velocity_mps, hull.mass_ratio, step_s / sim.tick_s);
  add(push, b, at, impulse_mps, overlap_m > 0.0);
  given_mps -= hull.mass_ratio * impulse_mps.xz;
}

vec3 fromHull(Hull hull, vec3 v) {
  return vec3(hull.forward.x * v.x + hull.starboard.x * v.z, v.y, hull.forward.y * v.x + hull.starboard.y * v.z);
}

/// Contacts with the hulls of boats: points of the floater with the hull, and 12 points of the hull with the floater.
void meetBoats(inout Push push, Floater b) {
  const float radius_m = pointRadius(b);
  const int count = pointCount(b);
  for (int slot = 0; slot < int(boat_place_count); ++slot) {
    vec4 t[BOAT_TEXELS];
    for (int i = 0; i < BOAT_TEXELS; ++i) t[i] = texelFetch(boats, slot * BOAT_TEXELS + i);
    const BoatState boat = unpackBoat(t);
    if (boat.age_s < 0.0) continue;
    const vec2 hull_mps = velocityOf(boat);
    const Hull hull = Hull(boat.centre_m, 0.5 * boat.hull_m.xzy, vec3(hull_mps.x, boat.speed_mps.z, hull_mps.y), forwardOf(boat.heading),
                           starboardOf(boat.heading), b.density_ratio * volumeOf(b) / (boat.hull_m.x * boat.hull_m.y * boat.hull_m.w));
    vec3 apart_m = b.centre_m - hull.centre_m;
    apart_m.xz = acrossSides(apart_m.xz);
    vec2 given_mps = vec2(0.0);
    for (int k = 0; k < count; ++k) {
      const vec3 r = pointOf(b, k);
      const vec3 d = apart_m + r;
      const vec4 local = boxDistance(vec3(dot(d.xz, hull.forward), d.y, dot(d.xz, hull.starboard)), hull.half_m);
      const vec3 n = fromHull(hull, local.xyz);
      meetHull(push, given_mps, b, hull, r - radius_m * n, n, radius_m - local.w);
    }
    for (int k = 0; k < 12; ++k) {
      const vec3 corner = vec3(float(k % 3 - 1), float(((k / 3) & 1) * 2 - 1), float((k / 6) * 2 - 1));
      const vec3 at = fromHull(hull, corner * hull.half_m) - apart_m;
      const vec4 here = surfaceOf(b, at);
      meetHull(push, given_mps, b, hull, at, -here.xyz, -here.w);
    }
    const ivec2 given = ivec2(round(clamp(given_mps, vec2(-64.0), vec2(64.0)) * PUSH_UNITS));
    atomicAdd(boat_push[2 * slot], given.x);
    atomicAdd(boat_push[2 * slot + 1], given.y);
  }
}
#endif

void main() {
  const uint own = gl_GlobalInvocationID.x;
  if (own >= uint(near.length()) / FLOATER_NEAR_WORDS || near[own * FLOATER_NEAR_WORDS] == 0u) return;
  const Floater b = floaterAt(own);
  Push push = Push(vec3(0.0), vec3(0.0), 0);
  const uint list = own * FLOATER_NEAR_WORDS;
  const uint near_count = near[list] & (FLOATER_GROUNDED - 1u);
  for (uint k = 0u; k < near_count; ++k) {
    const uint other = near[list + 1u + k];
    const uint crowd = max(near_count, near[other * FLOATER_NEAR_WORDS] & (FLOATER_GROUNDED - 1u));
    meetFloater(push, b, own, other, min(1.0, kShareFrom / float(crowd)));
  }
  const int ground_points = near[list] >= FLOATER_GROUNDED ? pointCount(b) : 0;
  for (int k = 0; k < ground_points; ++k) meetGround(push, b, k);
#if HULLS
  if (ground_points > 0) meetBoats(push, b);
#endif
  give(own, push);
}
