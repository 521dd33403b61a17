// Water that comes through a side with a wave-maker in a wave step, after the step's continuity.
// Reads MakerUniforms, BED. Updates ELEVATION and OUTFLOW [units] in the cells along the side, in matched layers ELEVATION_X.
// Equation: with q_I and eta_I of the wave that is made,
//   q = q_I + c_a (eta_I - eta),   gain = r q,   eta = level after continuity + gain/2,   r = dt/dx,
// so gain = r (q_I + c_a (eta_I - level)) / (1 + r c_a/2). The second term lets out what comes back. Where the side is shallower than maker_depth_m both are those of slower waves.
// Invariants: the sum of ELEVATION and OUTFLOW does not change by a unit; no cell gives more than it holds; a side that
// makes nothing leaves level water alone.
#include "shared/groups.h"
#include "shared/maker_uniforms.h"
#include "wave/water_column.glsl"
#include "wave/transfer.glsl"

layout(local_size_x = WAVE_GROUP_X) in;

layout(std430, binding = ELEVATION) restrict buffer Elevation { int elevation[]; };
layout(std430, binding = OUTFLOW) restrict buffer Outflow { uvec2 outflow[]; };
#if MATCHED
layout(std430, binding = ELEVATION_X) restrict buffer ElevationX { int elevation_x[]; };
#endif

void main() {
  const ivec2 n = waveCounts();
  const int along = int(gl_GlobalInvocationID.x);
  const bool is_x = (maker_side & uint(MINUS_X_BIT | PLUS_X_BIT)) != 0u;
  if (along >= (is_x ? n.y : n.x)) return;
  const bool is_plus = (maker_side & uint(PLUS_X_BIT | PLUS_Z_BIT)) != 0u;
  const int across = is_plus ? (is_x ? n.x : n.y) - 1 : 0;
  const ivec2 cell = is_x ? ivec2(across, along) : ivec2(along, across);
  const int i = cell.x + n.x * cell.y;
  const float depth_m = stillDepth(i);
  const int before = elevation[i];
  int gain = 0;
  if (depth_m > 0.0) {
    const float slower = sqrt(min(depth_m / maker_depth_m, 1.0));
    const float c_a = slower * maker_absorbing_mps;
    const float r = sim.wave_dt_s / sim.wave_cell_m;
    const float q_m2ps = (slower * maker_flow_m2ps + c_a * (maker_elevation_m - metres(before))) / (1.0 + 0.5 * r * c_a);
    gain = transferUnits(q_m2ps, sim.wave_transfer);
    const uint held = heldUnits(before, depth_m);
    if (gain < 0 && uint(-gain) > held) gain = -int(held);
    gain = min(gain, max(ELEVATION_MAX_UNITS / 2 - before, 0));
  }
  elevation[i] = before + gain;
  // As in wave/continuity.comp.
  const int low = int(outflow[i].x) - gain;
  outflow[i] = uvec2(uint(low & 0xffffff), outflow[i].y + uint(low >> 24));
#if MATCHED
  // Only cells of a layer have a part of x; others keep 0.
  if (is_x && texelFetch(bed, i).y + texelFetch(bed, i).w > 0.0) elevation_x[i] += gain;
#endif
}
