// Quantizes the surface's foam for the stream: one byte per sample, the sum of all sources, four samples per word. With
// fewer samples than cells, a sample is the mean over the square that it covers.
// Reads FOAM_FIELD [(n/2)^2]. Writes PACKED_WORDS [target_count^2 / 4 from first_word on].
#include "shared/groups.h"
#include "shared/sim_uniforms.h"
#include "stream/cover.glsl"

layout(local_size_x = WAVE_GROUP_X) in;

layout(binding = FOAM_FIELD) uniform samplerBuffer foam;
layout(std430, binding = PACKED_WORDS) restrict writeonly buffer PackedWords { uint packed_words[]; };
uniform uint first_word;
uniform uint target_count;

float whiteOf(int i) {
  const vec4 f = texelFetch(foam, i);
  const float white = f.x + f.y + f.z;
  return isnan(white) ? 0.0 : clamp(white, 0.0, 1.0);
}

float meanWhite(int i) {
  const int n = int(sim.wave_n) / 2;
  if (int(target_count) == n) return whiteOf(i);
  const Cover x = coverOf(i % int(target_count), n, int(target_count));
  const Cover z = coverOf(i / int(target_count), n, int(target_count));
  float sum = 0.0;
  for (int c = z.first; c <= z.last; ++c) {
    for (int a = x.first; a <= x.last; ++a) sum += weightIn(z, c) * weightIn(x, a) * whiteOf(c * n + a);
  }
  return clamp(sum / (x.width * z.width), 0.0, 1.0);
}

uint quantized(int i) { return uint(round(meanWhite(i) * 255.0)); }

void main() {
  const uint word = gl_GlobalInvocationID.x;
  if (word >= target_count * target_count / 4u) return;
  const int i = int(4u * word);
  packed_words[first_word + word] = quantized(i) | quantized(i + 1) << 8 | quantized(i + 2) << 16 | quantized(i + 3) << 24;
}
