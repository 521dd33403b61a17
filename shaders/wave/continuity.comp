// Second half of a wave step: water moves through the faces, in whole units.
// Reads FLOW [m^2/s], SPONGE. Updates ELEVATION [n x n, units] and, in basins with an absorbing side, OUTFLOW (units that left
// for the open water through this cell since the start: low 24 bits, the rest).
// Equation: eta_t = -div q - sigma eta; sigma only in a sponge, where it equals the flow's, so that plane waves enter it
// without reflection.
// Invariant: the sum of ELEVATION and OUTFLOW over the domain does not change by a single unit.
// variants: STENCIL=5 WAVE_PERIODIC_X=1 WAVE_PERIODIC_Z=1 VARIED=0 OPEN=0 | STENCIL=9 WAVE_PERIODIC_X=0 WAVE_PERIODIC_Z=0 VARIED=1 OPEN=1
#include "shared/groups.h"
#include "include/transfer.glsl"
#include "include/wave_faces.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = FLOW) uniform samplerBuffer flow;
layout(std430, binding = ELEVATION) restrict buffer Elevation { int elevation[]; };
#if OPEN
layout(binding = SPONGE) uniform samplerBuffer sponge;
layout(std430, binding = OUTFLOW) restrict buffer Outflow { uvec2 outflow[]; };
#endif

void main() {
  const int n = int(sim.wave_n);
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (cell.x >= n || cell.y >= n) return;
  const int left = wrapped(cell.x - 1, n);
  const int row = n * cell.y;
  const int last_row = n * wrapped(cell.y - 1, n);
  const int i = cell.x + row;
  const float units = sim.wave_transfer;

  const Flow own = asFlow(texelFetch(flow, i));
  const Flow from_left = asFlow(texelFetch(flow, left + row));
  const Flow from_before = asFlow(texelFetch(flow, cell.x + last_row));
  int gain = transferUnits(from_left.x, units) - transferUnits(own.x, units) +
             transferUnits(from_before.y, units) - transferUnits(own.y, units);
#if STENCIL == 9
  const Flow from_corner = texelFetch(flow, left + last_row);
  gain += transferUnits(from_corner.z, units) - transferUnits(own.z, units) +
          transferUnits(from_before.w, units) - transferUnits(from_left.w, units);
#endif
#if OPEN
  const float sigma_per_s = texelFetch(sponge, i).y;
  const int lost = int(round(float(elevation[i]) * (1.0 - exp(-sigma_per_s * sim.wave_dt_s))));
  // 24 bits, and what goes beyond them: 32 would turn over after 128 m of water through one cell, hours of a storm.
  const int low = int(outflow[i].x) + lost;
  outflow[i] = uvec2(uint(low & 0xffffff), outflow[i].y + uint(low >> 24));
  gain -= lost;
#endif
  elevation[i] += gain;
}
