// Quantizes particles for the stream: number of packed particles, number of live particles, then three words per
// particle, the layout of core::ParticleView.
// Reads POSITION, VELOCITY, ACCELERATION.w (density) in cell order. Writes PACKED_WORDS, 2 + 3 words per particle, from
// first_word on; the first word must be 0 before. If there are more than budget_count particles, a hash of their ids
// chooses which are packed: the same ones in every frame while their number stays, and a smaller budget chooses a
// subset of a larger one.
#include "shared/groups.h"
#include "common/finite.glsl"
#include "common/hash.glsl"
#include "particles/population.glsl"

layout(local_size_x = PARTICLE_GROUP) in;

layout(binding = POSITION) uniform samplerBuffer position;
layout(binding = VELOCITY) uniform samplerBuffer velocity;
layout(binding = ACCELERATION) uniform samplerBuffer acceleration;
layout(std430, binding = PACKED_WORDS) restrict buffer PackedWords { uint packed_words[]; };
uniform uint first_word;
uniform uint budget_count;

/// 0..1 to 0..high; a NaN becomes 0.
uint quantized(float unit, float high) {
  return isNaN(unit) ? 0u : uint(round(clamp(unit, 0.0, 1.0) * high));
}

/// -1..1 to a signed byte.
uint quantizedSigned(float unit) {
  return isNaN(unit) ? 0u : uint(int(round(clamp(unit, -1.0, 1.0) * 127.0))) & 0xffu;
}

/// The mean number of chosen particles is four standard deviations below the budget, so that the random choice fits
/// into it.
bool isChosen(float id, uint count) {
  const float budget = float(budget_count);
  const float share = (budget - 4.0 * sqrt(budget)) / float(count);
  // Converted through int: uint() of -1, the mark of an absorbed particle, is undefined.
  return float(hashed(uvec3(uint(int(id)), 0u, 0u)).x >> 8) < share * 16777216.0;
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  const uint count = particleCount();
  if (i >= count) return;
  const vec4 place = texelFetch(position, int(i));
  uint slot = i;
  if (count > budget_count) {
    if (!isChosen(place.w, count)) return;
    slot = atomicAdd(packed_words[first_word], 1u);
    if (slot >= budget_count) return;
  } else if (i == 0u) {
    packed_words[first_word] = count;
  }
  if (slot == 0u) packed_words[first_word + 1u] = count;
  const vec3 low = vec3(sim.frame_min_x_m, sim.min_y_m, sim.frame_min_z_m);
  const vec3 high = vec3(sim.frame_max_x_m, sim.max_y_m, sim.frame_max_z_m);
  const vec3 u = (place.xyz - low) / (high - low);
  const vec4 motion = texelFetch(velocity, int(i));
  const vec3 v = motion.xyz / sim.max_speed_mps;
  const float density_ratio = texelFetch(acceleration, int(i)).w / sim.rest_density_kgpm3;
  const uint word = first_word + 2u + 3u * slot;
  packed_words[word] = quantized(u.x, 65535.0) | quantized(u.z, 65535.0) << 16;
  packed_words[word + 1u] = quantized(u.y, 65535.0) | quantizedSigned(v.x) << 16 | quantizedSigned(v.y) << 24;
  packed_words[word + 2u] =
      quantizedSigned(v.z) | quantized((density_ratio - 0.5) / 0.6, 255.0) << 8 | quantized(motion.w, 255.0) << 16;
}
