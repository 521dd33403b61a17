// Quantizes the elevation for the stream: two int16 a word, value = round(eta / quantum), saturating.
// Reads ELEVATION [n x n, units]. Writes PACKED_WORDS [n * n / 2].
#include "shared/fixed_point.h"
#include "shared/groups.h"
#include "shared/sim_uniforms.h"

layout(local_size_x = WAVE_GROUP_X) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(std430, binding = PACKED_WORDS) restrict writeonly buffer PackedWords { uint packed_words[]; };

uint quantized(int i) {
  const float q = float(texelFetch(elevation, i).x) * (ELEVATION_UNIT_M / sim.surface_quantum_m);
  return uint(int(round(clamp(q, -32767.0, 32767.0)))) & 0xffffu;
}

void main() {
  const uint word = gl_GlobalInvocationID.x;
  if (word >= sim.wave_n * sim.wave_n / 2u) return;
  const int i = int(2u * word);
  packed_words[word] = quantized(i) | quantized(i + 1) << 16;
}
