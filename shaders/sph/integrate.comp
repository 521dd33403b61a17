// Moves the particles: kick, drift (symplectic Euler), foam, floor, sides.
// Reads SORTED_POSITION, SORTED_VELOCITY, ACCELERATION, the floor. Writes POSITION, VELOCITY (in sorted order).
// Invariants: every particle ends inside the domain, at least floor_gap_m above the floor, not faster than max_speed_mps plus
// the floor's own speed; a periodic side is re-entered reentry_m inside (thesis 3.6.2: no thrashing).
// variants: PERIODIC_X=1 PERIODIC_Z=1 COUPLED=1 POOL_PARTICLES=0 VARIED=0 HULLS=0 SURFACE_FOAM=0 FOLLOW=0 WAVE_PERIODIC_X=1 WAVE_PERIODIC_Z=1 FOAM=1 | PERIODIC_X=1 PERIODIC_Z=1 COUPLED=1 POOL_PARTICLES=0 VARIED=0 HULLS=1 SURFACE_FOAM=0 FOLLOW=2 WAVE_PERIODIC_X=1 WAVE_PERIODIC_Z=1 FOAM=1 | PERIODIC_X=0 PERIODIC_Z=0 COUPLED=1 POOL_PARTICLES=1 VARIED=1 HULLS=1 SURFACE_FOAM=1 FOLLOW=0 WAVE_PERIODIC_X=0 WAVE_PERIODIC_Z=0 FOAM=1 | PERIODIC_X=0 PERIODIC_Z=0 COUPLED=0 POOL_PARTICLES=0 VARIED=0 HULLS=0 SURFACE_FOAM=0 FOLLOW=0 WAVE_PERIODIC_X=0 WAVE_PERIODIC_Z=0 FOAM=0
#include "shared/groups.h"
#include "include/floor.glsl"
#include "include/foam.glsl"
#include "include/population.glsl"
#if POOL_PARTICLES
#include "include/absorption.glsl"
#endif
#if COUPLED && VARIED
#include "include/terrain.glsl"
#endif
#if HULLS
#include "include/hull.glsl"
#endif

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = SORTED_POSITION) uniform samplerBuffer sorted_position;
layout(binding = SORTED_VELOCITY) uniform samplerBuffer sorted_velocity;
layout(binding = ACCELERATION) uniform samplerBuffer acceleration;
layout(std430, binding = POSITION) restrict writeonly buffer Position { vec4 position[]; };
layout(std430, binding = VELOCITY) restrict writeonly buffer Velocity { vec4 velocity[]; };

/// One axis with walls: stops at the wall and turns the normal speed round.
void keepBetweenWalls(inout float x, inout float v, float low, float high) {
  if (x < low) { x = low; v = abs(v) * sim.wall_restitution; }
  if (x > high) { x = high; v = -abs(v) * sim.wall_restitution; }
}

/// One periodic axis: leaves on one side, enters slightly inside the other.
void wrapAround(inout float x, float low, float high) {
  if (x < low) x = high - sim.reentry_m;
  else if (x >= high) x = low + sim.reentry_m;
}

#if FOLLOW
/// The patch moves: particles that it leaves behind enter it at its front, as high above the water as they were, moving with it.
void carryAlong(inout vec3 x, inout vec3 v) {
  const vec2 low = vec2(sim.min_x_m, sim.min_z_m);
  const vec2 side = vec2(sim.max_x_m, sim.max_z_m) - low;
  const vec2 turns = floor((x.xz - low) / side);
  if (turns == vec2(0.0)) return;
  const Floor f = loadFloor();
  const float gap_m = x.y - floorHeight(f, x.xz);
  x.xz = clamp(x.xz - turns * side, low, low + side);
  vec3 normal;
  x.y = floorState(f, x.xz, normal, v) + gap_m;
}
#endif

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const vec4 old_position = texelFetch(sorted_position, int(i));
  const vec4 old_velocity = texelFetch(sorted_velocity, int(i));
  const vec4 a = texelFetch(acceleration, int(i));

  vec3 v = old_velocity.xyz + sim.dt_s * a.xyz;
  v *= min(1.0, sim.max_speed_mps / max(length(v), 1e-6));
  vec3 x = old_position.xyz + sim.dt_s * v;

#if FOLLOW
  carryAlong(x, v);
#elif PERIODIC_X
  wrapAround(x.x, sim.min_x_m, sim.max_x_m);
#else
  keepBetweenWalls(x.x, v.x, sim.min_x_m, sim.max_x_m);
#endif
#if FOLLOW
#elif PERIODIC_Z
  wrapAround(x.z, sim.min_z_m, sim.max_z_m);
#else
  keepBetweenWalls(x.z, v.z, sim.min_z_m, sim.max_z_m);
#endif

#if HULLS
  pushOutOfHulls(x, v);
#endif
#if COUPLED && VARIED
  pushOutOfRocks(x, v);
#endif

  const Floor f = loadFloor();
  vec3 normal;
  vec3 floor_velocity_mps;
  const float gap_m = x.y - floorState(f, x.xz, normal, floor_velocity_mps);
#if POOL_PARTICLES
  if (gap_m < 0.0) {
    const float approach_mps = floor_velocity_mps.y - v.y;
    if (approach_mps > 0.0 || gap_m < -sim.spacing_m) {
      absorb(x.xz, max(approach_mps, 0.0));
      position[i] = vec4(x, DEAD_ID);
      velocity[i] = vec4(0.0);
      return;
    }
    x.y -= gap_m;  // thrown out by the water below it
  }
#else
  if (gap_m < sim.floor_gap_m) {
    // Lift to the floor in the column, so that a slope cannot push the particle across a side; the velocity loses what
    // points into the floor along its normal.
    x.y += sim.floor_gap_m - gap_m;
    v -= normal * min(dot(v - floor_velocity_mps, normal), 0.0);
  }
#endif
  keepBetweenWalls(x.y, v.y, sim.min_y_m, sim.max_y_m);

#if FOAM
  const float foam = foamStep(old_velocity.w, a.w / sim.rest_density_kgpm3);
#else
  const float foam = 0.0;
#endif
  position[i] = vec4(x, old_position.w);
  velocity[i] = vec4(v, foam);
}
