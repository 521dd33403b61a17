// Health of the particles: one partial result per invocation, summed on the host in double precision.
// Reads POSITION, VELOCITY, ACCELERATION.w, CROWDED. Writes PARTIAL_SUM, 12 words per invocation, floats as their bits:
// non-finite values, escaped particles, max speed, max density; sum of density, sum of v^2, sum of y, 0; four words 0,
// except the first of these in invocation 0: CROWDED[0].
// Particles that were absorbed in the last substep are left out.
#include "shared/groups.h"
#include "common/finite.glsl"
#include "particles/population.glsl"

layout(local_size_x = REDUCE_GROUP) in;

layout(binding = POSITION) uniform samplerBuffer position;
layout(binding = VELOCITY) uniform samplerBuffer velocity;
layout(binding = ACCELERATION) uniform samplerBuffer acceleration;
layout(binding = CROWDED) uniform usamplerBuffer crowded;
layout(std430, binding = PARTIAL_SUM) restrict writeonly buffer PartialSum { uvec4 partial_sum[]; };

void main() {
  const uint share = gl_GlobalInvocationID.x;
  const uint shares = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  const uint count = particleCount();
  const vec3 low = vec3(sim.min_x_m, sim.min_y_m, sim.min_z_m);
  const vec3 high = vec3(sim.max_x_m, sim.max_y_m, sim.max_z_m);
  vec4 worst = vec4(0.0);
  vec4 sum = vec4(0.0);
  for (uint i = share; i < count; i += shares) {
    const vec4 place = texelFetch(position, int(i));
#if POOL_PARTICLES
    if (place.w == DEAD_ID) continue;
#endif
    const vec3 x = place.xyz;
    const vec3 v = texelFetch(velocity, int(i)).xyz;
    const float rho = texelFetch(acceleration, int(i)).w;
    const float v2 = dot(v, v);
    if (isFinite(x.x + x.y + x.z) && isFinite(v2) && isFinite(rho)) {
      const bool inside = all(greaterThanEqual(x, low)) && all(lessThanEqual(x, high));
      worst.y += inside ? 0.0 : 1.0;
      worst.zw = max(worst.zw, vec2(sqrt(v2), rho));
      sum += vec4(rho, v2, x.y, 0.0);
    } else {
      worst.x += 1.0;
    }
  }
  partial_sum[3u * share] = floatBitsToUint(worst);
  partial_sum[3u * share + 1u] = floatBitsToUint(sum);
  partial_sum[3u * share + 2u] = uvec4(share == 0u ? texelFetch(crowded, 0).x : 0u, 0u, 0u, 0u);
}
