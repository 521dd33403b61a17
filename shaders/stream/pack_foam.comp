// Quantizes the surface's foam for the stream: a byte a sample, all sources together, four samples a word.
// Reads FOAM_FIELD [(n/2)^2]. Writes PACKED_WORDS [(n/2)^2 / 4].
#include "shared/groups.h"
#include "shared/sim_uniforms.h"

layout(local_size_x = WAVE_GROUP_X) in;

layout(binding = FOAM_FIELD) uniform samplerBuffer foam;
layout(std430, binding = PACKED_WORDS) restrict writeonly buffer PackedWords { uint packed_words[]; };

uint quantized(int i) {
  const vec4 f = texelFetch(foam, i);
  const float white = f.x + f.y + f.z;
  return isnan(white) ? 0u : uint(round(clamp(white, 0.0, 1.0) * 255.0));
}

void main() {
  const uint word = gl_GlobalInvocationID.x;
  if (word >= sim.wave_n * sim.wave_n / 16u) return;
  const int i = int(4u * word);
  packed_words[word] = quantized(i) | quantized(i + 1) << 8 | quantized(i + 2) << 16 | quantized(i + 3) << 24;
}
