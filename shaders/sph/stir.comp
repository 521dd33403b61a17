// Effects in a scene without a wave: they set the particles themselves in motion, once a tick.
// Reads EventUniforms, POSITION. Adds to VELOCITY [m/s]. (Scenes with a wave move the surface instead: shaders/wave.)
// A splash drives its disc down and its rim outward and up, with the speed of a fall through its depth; a crest gives the water under
// it the speed that belongs to its height, u = a sqrt(g/d) (long waves), in its direction. The gains of a pulse sum to the whole.
// variants: PERIODIC_X=1 PERIODIC_Z=1 | PERIODIC_X=0 PERIODIC_Z=0
#include "shared/groups.h"
#include "include/event_shapes.glsl"
#include "include/population.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = POSITION) uniform samplerBuffer position;
layout(std430, binding = VELOCITY) restrict buffer Velocity { vec4 velocity[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= unsortedCount()) return;
  const vec3 x = texelFetch(position, int(i)).xyz;
  const float depth_m = sim.band_m;
  const float half_side_m = 0.5 * (sim.max_x_m - sim.min_x_m);
  // Full at the top of the resting water, nothing at the floor.
  const float reach = clamp((x.y + depth_m) / depth_m, 0.0, 1.0);
  vec3 gain_mps = vec3(0.0);
  for (uint k = 0u; k < splash_count; ++k) {
    const EventUniform e = splashes[k];
    const vec2 r_m = x.xz - vec2(e.x_m, e.z_m);
    const float fall_mps = e.gain_m * sqrt(2.0 * sim.gravity_mps2 / max(e.depth_m, 1e-3));
    gain_mps.y += reach * fall_mps * splashElevation(r_m, e.radius_m);
    gain_mps.xz -= reach * fall_mps / e.radius_m * splashDisplacement(r_m, e.radius_m);
  }
  for (uint k = 0u; k < crest_count; ++k) {
    const EventUniform e = crests[k];
    const float at = max(crestElevation(e, x.xz, half_side_m), 0.0);
    gain_mps.xz += e.gain_m * at * sqrt(sim.gravity_mps2 / depth_m) * vec2(e.direction_x, e.direction_z);
  }
  velocity[i].xyz += gain_mps;
}
