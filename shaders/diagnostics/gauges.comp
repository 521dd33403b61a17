// What the gauges read after a tick, one invocation per gauge.
// Reads ELEVATION [cells, units], FLOW, BASIN, BED. Writes PARTIAL_SUM, 4 words per gauge: elevation [m], velocity along
// x and z [m/s], share of wet cells around the gauge.
// Equations: bilinear between the centres of the four cells around the position. Dry cells do not count: their weight goes
// to the wet ones. Among dry cells alone the velocity is 0, and the elevation that of the ground where water can come
// (NONLINEAR), otherwise 0. Flows belong to half a wave step before the elevations.
#include "shared/gauge_uniforms.h"
#include "shared/groups.h"
#include "diagnostics/wet_cells.glsl"

layout(local_size_x = MAX_GAUGES) in;

layout(std430, binding = PARTIAL_SUM) restrict writeonly buffer GaugeReading { vec4 gauge_reading[]; };

void main() {
  const uint k = gl_GlobalInvocationID.x;
  if (k >= gauge_count) return;
  const ivec2 n = waveCounts();
  vec3 sum = vec3(0.0);
  float wet = 0.0;
  float ground_m = 0.0;
  for (int each = 0; each < 4; ++each) {
    const Corner corner = cornerOf(gauge_places[k].xy, each, n);
    if (corner.weight == 0.0) continue;
    const int i = corner.cell.x + n.x * corner.cell.y;
    const int units = texelFetch(elevation, i).x;
#if NONLINEAR
    ground_m -= corner.weight * stillDepth(i);
#endif
    if (!isWet(i, units)) continue;
    const Faces left = facesOf(ivec2(wrapped(corner.cell.x - 1, n.x), corner.cell.y), n);
    const Faces before = facesOf(ivec2(corner.cell.x, wrapped(corner.cell.y - 1, n.y)), n);
    sum += corner.weight * vec3(metres(units), velocityOf(facesOf(corner.cell, n), left, before));
    wet += corner.weight;
  }
  gauge_reading[k] = wet > 0.0 ? vec4(sum / wet, wet) : vec4(ground_m, vec3(0.0));
}
