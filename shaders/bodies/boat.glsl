// State of a boat in registers, and the shape of its hull.
#ifndef SPINDRIFT_BOAT
#define SPINDRIFT_BOAT

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
};

BoatState unpackBoat(vec4 t[BOAT_TEXELS]) {
  return BoatState(t[0].xyz, t[0].w, t[1].xy, t[1].z, t[1].w, t[2].xyz, t[2].w, t[3].xy, t[3].zw, t[4], t[5].x, t[5].y);
}

vec2 forwardOf(float heading) { return vec2(cos(heading), sin(heading)); }
vec2 starboardOf(float heading) { return vec2(-sin(heading), cos(heading)); }

/// Height of water that the hull displaces at (along, across) from its centre: its pressure on the surface. [m] The
/// norm makes the integral equal to the volume of a box of the hull's length, beam and draught. A hull narrower than
/// three wave cells is spread over three.
float hullHead(BoatState b, vec2 at_m) {
  const vec2 half_m = max(0.5 * b.hull_m.xy, vec2(1.5 * sim.wave_cell_m));
  const vec2 q = at_m / half_m;
  if (max(abs(q.x), abs(q.y)) > HULL_REACH) return 0.0;
  const vec2 q2 = q * q;
  const float volume_share = 0.25 * b.hull_m.x * b.hull_m.y / (half_m.x * half_m.y) / (0.9064 * 0.9064);
  return b.hull_m.w * volume_share * exp(-q2.x * q2.x - q2.y * q2.y) * min(b.age_s / BOAT_SETTLING_S, 1.0) * (1.0 - b.aloft);
}

#endif
