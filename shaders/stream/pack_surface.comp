// Quantizes the elevation for the stream: two int16 per word, value = round(eta / quantum), saturating. With fewer
// samples than cells, a sample is the mean over the rectangle that it covers.
// Reads ELEVATION [nx x nz, units]. Writes PACKED_WORDS [half of target_nx * target_nz, rounded up, from first_word on]; half a
// word that is left over is 0.
#include "shared/fixed_point.h"
#include "shared/groups.h"
#include "shared/sim_uniforms.h"
#include "stream/cover.glsl"

layout(local_size_x = WAVE_GROUP_X) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(std430, binding = PACKED_WORDS) restrict writeonly buffer PackedWords { uint packed_words[]; };
uniform uint first_word;
uniform uint target_nx;
uniform uint target_nz;

float meanUnits(int i) {
  if (target_nx == sim.wave_nx && target_nz == sim.wave_nz) return float(texelFetch(elevation, i).x);
  const int n = int(sim.wave_nx);
  const Cover x = coverOf(i % int(target_nx), n, int(target_nx));
  const Cover z = coverOf(i / int(target_nx), int(sim.wave_nz), int(target_nz));
  float sum = 0.0;
  for (int c = z.first; c <= z.last; ++c) {
    float row = 0.0;
    for (int a = x.first; a <= x.last; ++a) row += weightIn(x, a) * float(texelFetch(elevation, c * n + a).x);
    sum += weightIn(z, c) * row;
  }
  return sum / (x.width * z.width);
}

uint quantized(int i) {
  if (i >= int(target_nx * target_nz)) return 0u;
  const float q = meanUnits(i) * (ELEVATION_UNIT_M / sim.surface_quantum_m);
  return uint(int(round(clamp(q, -32767.0, 32767.0)))) & 0xffffu;
}

void main() {
  const uint word = gl_GlobalInvocationID.x;
  if (word >= (target_nx * target_nz + 1u) / 2u) return;
  const int i = int(2u * word);
  packed_words[first_word + word] = quantized(i) | quantized(i + 1) << 16;
}
