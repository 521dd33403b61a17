// Health of the wave: one partial result an invocation, summed on the host in double precision.
// Reads ELEVATION, ELEVATION_PREVIOUS [n x n, m]. Writes PARTIAL_SUM, 8 floats an invocation: non-finite values, 0, max |eta|, 0, sum of
// eta, sum of (d eta/dt)^2, sum of |grad eta|^2 (forward differences, at both times: grad now . grad before), sum of eta^2.
// sim/diagnostics.cpp assembles the discrete energy from them.
// variants: WAVE_PERIODIC=1 | WAVE_PERIODIC=0
#include "shared/groups.h"
#include "include/wave_cell.glsl"

layout(local_size_x = REDUCE_GROUP) in;

layout(binding = ELEVATION) uniform samplerBuffer elevation;
layout(binding = ELEVATION_PREVIOUS) uniform samplerBuffer elevation_previous;
layout(std430, binding = PARTIAL_SUM) restrict writeonly buffer PartialSum { vec4 partial_sum[]; };

bool finite(float x) { return !isnan(x) && !isinf(x); }

void main() {
  const uint share = gl_GlobalInvocationID.x;
  const uint shares = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  const int n = int(sim.wave_n);
  const float inverse_dt = 1.0 / sim.wave_dt_s;
  const float inverse_dx2 = 1.0 / (sim.wave_cell_m * sim.wave_cell_m);
  vec4 worst = vec4(0.0);
  vec4 sum = vec4(0.0);
  for (uint at = share; at < uint(n * n); at += shares) {
    const int i = int(at);
    const ivec2 cell = ivec2(i % n, i / n);
    const int right = waveNeighbour(cell.x + 1, n) + n * cell.y;
    const int after = cell.x + n * waveNeighbour(cell.y + 1, n);
    const float now = texelFetch(elevation, i).x;
    const float before = texelFetch(elevation_previous, i).x;
    const vec2 slope_now = vec2(texelFetch(elevation, right).x, texelFetch(elevation, after).x) - now;
    const vec2 slope_before = vec2(texelFetch(elevation_previous, right).x, texelFetch(elevation_previous, after).x) - before;
    const float rate_mps = (now - before) * inverse_dt;
    if (finite(now) && finite(rate_mps)) {
      worst.z = max(worst.z, abs(now));
      sum += vec4(now, rate_mps * rate_mps, dot(slope_now, slope_before) * inverse_dx2, now * now);
    } else {
      worst.x += 1.0;
    }
  }
  partial_sum[2u * share] = worst;
  partial_sum[2u * share + 1u] = sum;
}
