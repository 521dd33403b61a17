// Moves the particles: kick, drift (symplectic Euler), foam, collisions.
// Reads SORTED_POSITION, SORTED_VELOCITY, ACCELERATION, FOAM_SOURCE (with NEIGHBOUR_FOAM), the floor. Writes POSITION, VELOCITY (in sorted order).
// Invariants: every particle ends inside the domain, at least floor_gap_m above the floor, not faster than
// max_speed_mps plus the floor's own speed. A particle that crosses a periodic side enters reentry_m inside the other
// one, so that it does not oscillate across the side (thesis 3.6.2).
#include "shared/groups.h"
#include "common/finite.glsl"
#include "particles/foam.glsl"
#include "particles/population.glsl"
#include "particles/surroundings.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = SORTED_POSITION) uniform samplerBuffer sorted_position;
layout(binding = SORTED_VELOCITY) uniform samplerBuffer sorted_velocity;
layout(binding = ACCELERATION) uniform samplerBuffer acceleration;
#if NEIGHBOUR_FOAM
layout(binding = FOAM_SOURCE) uniform samplerBuffer foam_source;
#endif
layout(std430, binding = POSITION) restrict writeonly buffer Position { vec4 position[]; };
layout(std430, binding = VELOCITY) restrict writeonly buffer Velocity { vec4 velocity[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const vec4 old_position = texelFetch(sorted_position, int(i));
  const vec4 old_velocity = texelFetch(sorted_velocity, int(i));
  const vec4 a = texelFetch(acceleration, int(i));
  if (!isFinite(old_position.xyz)) {
    // Left unchanged for diagnostics to count: min() and max() at a wall would turn the NaN into a valid position.
    position[i] = old_position;
    velocity[i] = old_velocity;
    return;
  }

  vec3 v = old_velocity.xyz + sim.dt_s * a.xyz;
  v *= min(1.0, sim.max_speed_mps / max(length(v), 1e-6));
  vec3 x = old_position.xyz + sim.dt_s * v;

  if (!meetSurroundings(x, v)) {
#if POOL_PARTICLES
    position[i] = vec4(x, DEAD_ID);
    velocity[i] = vec4(0.0);
#endif
    return;
  }

#if FOAM
  float foam = foamStep(old_velocity.w, a.w / sim.rest_density_kgpm3);
#if NEIGHBOUR_FOAM
  foam = max(foam, texelFetch(foam_source, int(i)).x);
#endif
#else
  const float foam = 0.0;
#endif
  position[i] = vec4(x, old_position.w);
  velocity[i] = vec4(v, foam);
}
