// Quantizes particles for the stream: three words each, the layout of core::ParticleView.
// Reads POSITION, VELOCITY, ACCELERATION.w (density) in cell order. Writes PACKED_WORDS, 3 a particle.
// variants: POOL_PARTICLES=0 | POOL_PARTICLES=1
#include "shared/groups.h"
#include "include/population.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = POSITION) uniform samplerBuffer position;
layout(binding = VELOCITY) uniform samplerBuffer velocity;
layout(binding = ACCELERATION) uniform samplerBuffer acceleration;
layout(std430, binding = PACKED_WORDS) restrict writeonly buffer PackedWords { uint packed_words[]; };

/// 0..1 to 0..high; a NaN becomes 0.
uint quantized(float unit, float high) {
  return isnan(unit) ? 0u : uint(round(clamp(unit, 0.0, 1.0) * high));
}

/// -1..1 to a signed byte.
uint quantizedSigned(float unit) {
  return isnan(unit) ? 0u : uint(int(round(clamp(unit, -1.0, 1.0) * 127.0))) & 0xffu;
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= particleCount()) return;
  const vec3 low = vec3(sim.frame_min_x_m, sim.min_y_m, sim.frame_min_z_m);
  const vec3 high = vec3(sim.frame_max_x_m, sim.max_y_m, sim.frame_max_z_m);
  const vec3 u = (texelFetch(position, int(i)).xyz - low) / (high - low);
  const vec4 motion = texelFetch(velocity, int(i));
  const vec3 v = motion.xyz / sim.max_speed_mps;
  const float density_ratio = texelFetch(acceleration, int(i)).w / sim.rest_density_kgpm3;
  packed_words[3u * i] = quantized(u.x, 65535.0) | quantized(u.z, 65535.0) << 16;
  packed_words[3u * i + 1u] = quantized(u.y, 65535.0) | quantizedSigned(v.x) << 16 | quantizedSigned(v.y) << 24;
  packed_words[3u * i + 2u] =
      quantizedSigned(v.z) | quantized((density_ratio - 0.5) / 0.6, 255.0) << 8 | quantized(motion.w, 255.0) << 16;
}
