// What the gauges read after a tick, one invocation per gauge.
// Reads ELEVATION [cells, units], FLOW, BASIN, BED. Writes PARTIAL_SUM, 4 words per gauge: elevation [m], velocity along
// x and z [m/s], share of wet cells around the gauge.
// Equations: bilinear between the centres of the four cells around the position. Dry cells do not count: their weight goes
// to the wet ones. Among dry cells alone the velocity is 0, and the elevation that of the ground where water can come
// (NONLINEAR), otherwise 0. Velocity of a cell: mean of flow over still depth at its two faces along
// an axis, 0 at a closed one; with NONLINEAR mean of the velocities in FLOW. Flows belong to half a wave step before the
// elevations.
#include "shared/gauge_uniforms.h"
#include "shared/groups.h"
#include "wave/transfer.glsl"
#include "wave/wave_faces.glsl"
#if NONLINEAR
#include "wave/water_column.glsl"
#endif

layout(local_size_x = MAX_GAUGES) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(binding = FLOW) uniform samplerBuffer flow;
#if VARIED && !NONLINEAR
layout(binding = BED) uniform samplerBuffer bed;
#endif
layout(std430, binding = PARTIAL_SUM) restrict writeonly buffer GaugeReading { vec4 gauge_reading[]; };

bool isWet(ivec2 cell, ivec2 n) {
#if NONLINEAR
  const int i = cell.x + n.x * cell.y;
  return heldUnits(texelFetch(elevation, i).x, stillDepth(i)) > 0u;
#elif VARIED
  return texelFetch(bed, cell.x + n.x * cell.y).z > 0.0;
#else
  return true;
#endif
}

/// Elevation [m] and velocity [m/s] of a wet cell.
vec3 readingOf(ivec2 cell, ivec2 n) {
  const int row = n.x * cell.y;
  const ivec2 left = ivec2(wrapped(cell.x - 1, n.x), cell.y);
  const ivec2 before = ivec2(cell.x, wrapped(cell.y - 1, n.y));
#if NONLINEAR
  const vec2 after_mps = texelFetch(flow, cell.x + row).xy;
  const vec2 before_mps = vec2(texelFetch(flow, left.x + row).x, texelFetch(flow, cell.x + n.x * before.y).y);
#else
  const Flow own = asFlow(texelFetch(flow, cell.x + row));
  const Flow from_left = asFlow(texelFetch(flow, left.x + row));
  const Flow from_before = asFlow(texelFetch(flow, cell.x + n.x * before.y));
  const float least_m = 0.05 * sim.wave_depth_m;
  const vec2 after_mps = own.xy / max(conductanceOf(cell, n).xy, least_m);
  const vec2 before_mps = vec2(from_left.x / max(conductanceOf(left, n).x, least_m),
                               from_before.y / max(conductanceOf(before, n).y, least_m));
#endif
  return vec3(metres(texelFetch(elevation, cell.x + row).x), 0.5 * (after_mps + before_mps));
}

void main() {
  const uint k = gl_GlobalInvocationID.x;
  if (k >= gauge_count) return;
  const ivec2 n = waveCounts();
  const vec2 place = gauge_places[k].xy;
  const vec2 first = floor(place);
  const vec2 share = place - first;
  vec3 sum = vec3(0.0);
  float wet = 0.0;
  float ground_m = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    const ivec2 offset = ivec2(corner & 1, corner >> 1);
    const ivec2 at = ivec2(first) + offset;
    const ivec2 cell = ivec2(waveNeighbourX(at.x, n.x), waveNeighbourZ(at.y, n.y));
    const vec2 weights = mix(1.0 - share, share, vec2(offset));
    const float weight = weights.x * weights.y;
    if (weight == 0.0) continue;
#if NONLINEAR
    ground_m -= weight * stillDepth(cell.x + n.x * cell.y);
#endif
    if (!isWet(cell, n)) continue;
    sum += weight * readingOf(cell, n);
    wet += weight;
  }
  gauge_reading[k] = wet > 0.0 ? vec4(sum / wet, wet) : vec4(ground_m, vec3(0.0));
}
