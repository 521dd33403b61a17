// First half of a tick of every boat: it moves with its velocities, then leaves its contacts. One invocation per boat,
// all in one group.
// Updates BOATS; reads TERRAIN, BOAT_PUSH. The second half is bodies/kick.comp, which says how both are second order.
// Contacts: three circles along each hull against other boats, obstacles, shallow ground and sides. Each boat moves by half
// of the overlap and loses its approaching speed.
// MOVED: a boat that another program moves continues as it is; others bounce off it.
// Invariant: boats stay inside the domain and out of obstacles; nothing depends on the order of invocations.
#include "bodies/boat.glsl"
#if PUSHED
#include "shared/floaters.h"
#endif
#include "wave/wave_cell.glsl"
#if VARIED
#include "common/terrain.glsl"
#endif

layout(local_size_x = MAX_BOATS) in;

layout(std430, binding = BOATS) restrict buffer Boats { vec4 boats[]; };

#if PUSHED
layout(std430, binding = BOAT_PUSH) restrict readonly buffer BoatPush { int boat_push[]; };
#endif

const float kBounce = 0.3;
const float kPushMax_mps = 4.0;       // by floaters in a tick
const float kGroundingDepth = 1.1;    // depth over draught at which a boat runs aground

BoatState boatAt(uint place) {
  vec4 t[BOAT_TEXELS];
  for (uint k = 0u; k < BOAT_TEXELS; ++k) t[k] = boats[place * BOAT_TEXELS + k];
  return unpackBoat(t);
}

/// Centre of the k-th of three circles along the hull, k = -1, 0, 1; their radius is half the beam.
vec2 circleOf(BoatState b, int k) {
  return b.centre_m.xz + forwardOf(b.heading) * (float(k) * 0.5 * max(b.hull_m.x - b.hull_m.y, 0.0));
}

/// Pushes the boat out of a contact at `normal` by depth_m; the speed against it is weakly reversed.
void pushBack(inout vec2 shift_m, inout vec2 velocity_mps, vec2 normal, float depth_m, float approach_mps) {
  shift_m += normal * depth_m;
  velocity_mps += normal * max(approach_mps, 0.0) * (1.0 + kBounce);
}

/// All invocations read the same state, from before the tick.
void meetBoats(BoatState b, uint own, inout vec2 shift_m, inout vec2 velocity_mps) {
  for (uint other = 0u; other < boat_place_count; ++other) {
    const BoatState before = boatAt(other);
    if (other == own || before.age_s < 0.0) continue;
    const BoatState o = drifted(before, sim.tick_s);
    float deepest_m = 0.0;
    vec2 normal = vec2(0.0);
    for (int k = -1; k <= 1; ++k) {
      for (int j = -1; j <= 1; ++j) {
        const vec2 d = acrossSides(circleOf(b, k) - circleOf(o, j));
        const float distance_m = length(d);
        const float overlap_m = 0.5 * (b.hull_m.y + o.hull_m.y) - distance_m;
        if (overlap_m > deepest_m) {
          deepest_m = overlap_m;
          // Two boats at the same position separate by their order.
          normal = distance_m > 1e-4 ? d / distance_m : vec2(own < other ? 1.0 : -1.0, 0.0);
        }
      }
    }
    if (deepest_m <= 0.0) continue;
#if MOVED
    const float share = o.is_moved ? 1.0 : o.hull_m.x * o.hull_m.y / (b.hull_m.x * b.hull_m.y + o.hull_m.x * o.hull_m.y);
#else
    const float share = o.hull_m.x * o.hull_m.y / (b.hull_m.x * b.hull_m.y + o.hull_m.x * o.hull_m.y);
#endif
    pushBack(shift_m, velocity_mps, normal, share * deepest_m, share * dot(velocityOf(o) - velocityOf(b), normal));
  }
}

#if VARIED
void meetGround(BoatState b, inout vec2 shift_m, inout vec2 velocity_mps) {
  for (int k = -1; k <= 1; ++k) {
    const vec2 p = circleOf(b, k);
    const vec4 t = terrainAt(p);
    const float overlap_m = 0.5 * b.hull_m.y - t.x;
    if (overlap_m > 0.0) pushBack(shift_m, velocity_mps, t.yz, overlap_m, -dot(velocity_mps, t.yz));
#if !NONLINEAR
    // Aground: moves slowly toward deeper water, and not further onto the ground.
    const float missing_m = kGroundingDepth * b.hull_m.w - t.w;
    if (missing_m > 0.0 && t.x > 0.0) {
      const float step_m = 2.0 * sim.wave_cell_m;
      const vec2 deeper = vec2(terrainAt(p + vec2(step_m, 0.0)).w - terrainAt(p - vec2(step_m, 0.0)).w,
                               terrainAt(p + vec2(0.0, step_m)).w - terrainAt(p - vec2(0.0, step_m)).w);
      const vec2 normal = deeper / max(length(deeper), 1e-6);
      pushBack(shift_m, velocity_mps, normal, min(missing_m, 0.5 * sim.tick_s * b.hull_m.x), -dot(velocity_mps, normal));
    }
#endif
  }
}
#endif

void meetSides(BoatState b, inout vec2 shift_m, inout vec2 velocity_mps) {
#if WAVE
  const vec2 inside_m = waveHalf_m() - 0.5 * b.hull_m.y;
#else
  const vec2 inside_m = vec2(sim.max_x_m, sim.max_z_m) - 0.5 * b.hull_m.y;
#endif
  for (int k = -1; k <= 1; ++k) {
    const vec2 over_m = circleOf(b, k) + shift_m;
    const vec2 beyond_m = clamp(over_m, -inside_m, inside_m) - over_m;
#if !WAVE_PERIODIC_X
    if (beyond_m.x != 0.0) pushBack(shift_m, velocity_mps, vec2(sign(beyond_m.x), 0.0), abs(beyond_m.x), -sign(beyond_m.x) * velocity_mps.x);
#endif
#if !WAVE_PERIODIC_Z
    if (beyond_m.y != 0.0) pushBack(shift_m, velocity_mps, vec2(0.0, sign(beyond_m.y)), abs(beyond_m.y), -sign(beyond_m.y) * velocity_mps.y);
#endif
  }
}

#if MOVED
/// Centre of a boat that is moved from outside, kept over the water: there is a wave, or no boat is moved.
vec2 movedCentre(vec2 centre_m) {
  const vec2 inside_m = waveHalf_m();
#if !WAVE_PERIODIC_X
  centre_m.x = clamp(centre_m.x, -inside_m.x, inside_m.x);
#endif
#if !WAVE_PERIODIC_Z
  centre_m.y = clamp(centre_m.y, -inside_m.y, inside_m.y);
#endif
  return acrossSides(centre_m);
}
#endif

void main() {
  const uint own = gl_LocalInvocationID.x;
  BoatState b = boatAt(min(own, boat_place_count - 1u));  // the buffer may end after the last one
  const bool is_here = own < boat_place_count && b.age_s >= 0.0;
  if (is_here) {
    b = drifted(b, sim.tick_s);
    vec2 shift_m = vec2(0.0);
    vec2 velocity_mps = velocityOf(b);
#if PUSHED
    const vec2 push_mps = vec2(boat_push[2u * own], boat_push[2u * own + 1u]) / PUSH_UNITS;
    velocity_mps += push_mps * min(1.0, kPushMax_mps / max(length(push_mps), 1e-6));
#endif
#if MOVED
    if (b.is_moved) b.centre_m.xz = movedCentre(b.centre_m.xz);
    const bool is_free = !b.is_moved;
#else
    const bool is_free = true;
#endif
    if (is_free) {
      meetBoats(b, own, shift_m, velocity_mps);
#if VARIED
      meetGround(b, shift_m, velocity_mps);
#endif
      meetSides(b, shift_m, velocity_mps);
      b.centre_m.xz = acrossSides(b.centre_m.xz + shift_m);
      setVelocity(b, velocity_mps);
    }
  }
  // Barrier: all invocations have read the boats before any writes them.
  memoryBarrierBuffer();
  barrier();
  if (!is_here) return;
  const uint at = own * BOAT_TEXELS;
  boats[at] = vec4(b.centre_m, b.heading);
  boats[at + 1u] = vec4(b.tilt, b.age_s, b.id);
  boats[at + 2u] = vec4(b.speed_mps, b.yaw_rate);
}
