// Velocities from the actual displacements: predicted velocity plus correction over step.
// Reads SORTED_POSITION, SORTED_VELOCITY (predicted), MOTION_POINT (corrected). Writes PRESSURE_POINT (position, m/rho) and
// ACCELERATION (velocity, rho) for pbf/finish.comp.
// Equation: v = (x - x_old) / dt (Macklin & Mueller 2013, algorithm 1), not faster than max_speed_mps.
#include "shared/groups.h"
#include "particles/population.glsl"
#include "shared/sim_uniforms.h"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = SORTED_POSITION) uniform samplerBuffer sorted_position;
layout(binding = SORTED_VELOCITY) uniform samplerBuffer sorted_velocity;
layout(binding = MOTION_POINT) uniform samplerBuffer motion_point;
layout(std430, binding = PRESSURE_POINT) restrict writeonly buffer PressurePoint { vec4 pressure_point[]; };
layout(std430, binding = ACCELERATION) restrict buffer Acceleration { vec4 acceleration[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const vec3 x = texelFetch(motion_point, int(i)).xyz;
  const float rho = acceleration[i].w;
  vec3 v = texelFetch(sorted_velocity, int(i)).xyz + (x - texelFetch(sorted_position, int(i)).xyz) / sim.dt_s;
  v *= min(1.0, sim.max_speed_mps / max(length(v), 1e-6));
  pressure_point[i] = vec4(x, sim.mass_kg / rho);
  acceleration[i] = vec4(v, rho);
}
