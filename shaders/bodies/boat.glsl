// State of a boat in registers, and the shape of its hull.
// MOVED: programs that run while another program moves a boat (WaterSim::moveBoat). All others do without, so that water without
// such boats stays the same in every bit.
#ifndef SPINDRIFT_BOAT
#define SPINDRIFT_BOAT

#ifndef MOVED
#define MOVED 0
#endif

#include "shared/boats.h"
#include "shared/sim_uniforms.h"

struct BoatState {
  vec3 centre_m;
  float heading;
  vec2 tilt;        // pitch, roll
  float age_s;
  float id;
  vec3 speed_mps;   // forward, starboard, up
  float yaw_rate;
  vec2 tilt_rate;
  vec2 control;     // throttle, rudder
  vec4 hull_m;      // length, beam, height, draught
  float full_speed_mps;
  float aloft;      // 0: the water carries it; 1: it is in the air, without forces from and on the water
  vec3 water_mps;   // of the water under the hull when last sampled: x, z, up
  float push_mps2;  // acceleration ahead by the water's pressure on the hull
#if MOVED
  bool is_moved;    // from outside
#endif
};

BoatState unpackBoat(vec4 t[BOAT_TEXELS]) {
  return BoatState(t[0].xyz, t[0].w, t[1].xy, t[1].z, t[1].w, t[2].xyz, t[2].w, t[3].xy, t[3].zw, t[4], t[5].x, t[5].y, t[6].xyz, t[6].w
#if MOVED
                   , t[5].z > 0.0
#endif
  );
}

vec2 forwardOf(float heading) { return vec2(cos(heading), sin(heading)); }
vec2 starboardOf(float heading) { return vec2(-sin(heading), cos(heading)); }

/// Half length and half beam over which the hull presses: a hull narrower than three wave cells is spread over three. [m]
vec2 hullHalf(BoatState b) { return max(0.5 * b.hull_m.xy, vec2(1.5 * sim.wave_cell_m)); }

/// Shape of the hull's pressure and of its volume at (along, across) from its centre, 1 in the middle.
float hullShape(vec2 half_m, vec2 at_m) {
  const vec2 q = at_m / half_m;
  if (max(abs(q.x), abs(q.y)) > HULL_REACH) return 0.0;
  const vec2 q2 = q * q;
  return exp(-q2.x * q2.x - q2.y * q2.y);
}

/// Pressure of the hull on the water, as a height of water, where hullShape() is 1. [m] hullPeak * hullShape integrates to
/// the volume of a box of the hull's length, beam and draught; 0.9064 = Gamma(5/4). C++: tests/study/hull_pressure.cpp.
float hullPeak(BoatState b, vec2 half_m) {
  const float volume_share = 0.25 * b.hull_m.x * b.hull_m.y / (half_m.x * half_m.y) / (0.9064 * 0.9064);
  return b.hull_m.w * volume_share * min(b.age_s / BOAT_SETTLING_S, 1.0) * (1.0 - b.aloft);
}

#if MOVED
/// Volume of the hull per metre of its height and square metre of water, where hullShape() is 1: over the hull's area it adds up to
/// length times beam.
float hullFullness(BoatState b, vec2 half_m) {
  return 0.25 * b.hull_m.x * b.hull_m.y / (half_m.x * half_m.y) / (0.9064 * 0.9064);
}

/// Height of the hull at at_m that is between its keel, or the ground, and the level. [m]
float hullBelow(BoatState b, vec2 at_m, float level_m, float depth_m) {
  const float keel_m = b.centre_m.y - 0.5 * b.hull_m.z + at_m.x * b.tilt.x - at_m.y * b.tilt.y;
  return clamp(level_m - max(keel_m, -depth_m), 0.0, b.hull_m.z);
}

/// What a hull that is moved from outside presses with: the water that it displaces under the rest level. [m]
float movedHead(BoatState b, vec2 half_m, vec2 at_m, float depth_m) {
  const float share = hullFullness(b, half_m) * hullShape(half_m, at_m);
  return share * hullBelow(b, at_m, 0.0, depth_m) * min(b.age_s / BOAT_SETTLING_S, 1.0);
}
#endif

/// Cells along x and z that the hull can reach.
ivec2 hullCells(BoatState b, vec2 half_m) {
  const vec2 reach_m = HULL_REACH * (abs(forwardOf(b.heading)) * half_m.x + abs(starboardOf(b.heading)) * half_m.y);
  return 2 * ivec2(ceil(reach_m / sim.wave_cell_m)) + 3;
}

/// Horizontal velocity. [m/s] (x, z)
vec2 velocityOf(BoatState b) {
  return forwardOf(b.heading) * b.speed_mps.x + starboardOf(b.heading) * b.speed_mps.y;
}

void setVelocity(inout BoatState b, vec2 velocity_mps) {
  b.speed_mps.xy = vec2(dot(velocity_mps, forwardOf(b.heading)), dot(velocity_mps, starboardOf(b.heading)));
}

/// The boat after it has moved with its present velocities for some time.
BoatState drifted(BoatState b, float duration_s) {
  const vec2 velocity_mps = velocityOf(b);
  b.age_s += duration_s;
  b.centre_m += duration_s * vec3(velocity_mps.x, b.speed_mps.z, velocity_mps.y);
#if MOVED
  const float tilt_max = b.is_moved ? 1.5 : 0.6;
#else
  const float tilt_max = 0.6;
#endif
  b.tilt = clamp(b.tilt + duration_s * b.tilt_rate, vec2(-tilt_max), vec2(tilt_max));
  b.heading += duration_s * b.yaw_rate;
  if (abs(b.heading) > 3.14159265) b.heading -= 6.2831853 * sign(b.heading);
  setVelocity(b, velocity_mps);  // the heading turns, the velocity does not
  return b;
}

#endif
