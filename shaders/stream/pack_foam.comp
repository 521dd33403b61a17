// Quantizes the surface's foam for the stream: one byte per sample, the sum of all sources, four samples per word. With
// fewer samples than cells, a sample is the mean over the rectangle that it covers.
// Reads FOAM_FIELD [foamCounts()]. Writes PACKED_WORDS [a quarter of target_nx * target_nz, rounded up, from first_word on]; bytes left over are 0.
#include "shared/groups.h"
#include "shared/sim_uniforms.h"
#include "foam/foam_cell.glsl"
#include "stream/cover.glsl"

layout(local_size_x = WAVE_GROUP_X) in;

layout(binding = FOAM_FIELD) uniform samplerBuffer foam;
layout(std430, binding = PACKED_WORDS) restrict writeonly buffer PackedWords { uint packed_words[]; };
uniform uint first_word;
uniform uint target_nx;
uniform uint target_nz;

float meanWhite(int i) {
  const ivec2 n = foamCounts(ivec2(int(sim.wave_nx), int(sim.wave_nz)));
  const ivec2 target = ivec2(int(target_nx), int(target_nz));
  if (target == n) return whiteOf(texelFetch(foam, i));
  const Cover x = coverOf(i % target.x, n.x, target.x);
  const Cover z = coverOf(i / target.x, n.y, target.y);
  float sum = 0.0;
  for (int c = z.first; c <= z.last; ++c) {
    for (int a = x.first; a <= x.last; ++a) sum += weightIn(z, c) * weightIn(x, a) * whiteOf(texelFetch(foam, c * n.x + a));
  }
  return clamp(sum / (x.width * z.width), 0.0, 1.0);
}

uint quantized(int i) { return i < int(target_nx * target_nz) ? uint(round(meanWhite(i) * 255.0)) : 0u; }

void main() {
  const uint word = gl_GlobalInvocationID.x;
  if (word >= (target_nx * target_nz + 3u) / 4u) return;
  const int i = int(4u * word);
  packed_words[first_word + word] = quantized(i) | quantized(i + 1) << 8 | quantized(i + 2) << 16 | quantized(i + 3) << 24;
}
