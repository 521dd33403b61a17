// Before the water moves: computes the share of its outflow that each cell can give. Runs only in steps in which some
// transfer is large compared with the water of the giving cell (LIMIT_ARGS).
// Reads ELEVATION, TRANSFER [nx x nz, units], BED. Writes GIVEN_SHARE [nx x nz, 0..1].
// Equation: share = held / outflow if the outflow through all faces of a cell exceeds the water that it holds,
// otherwise 1: the limit of a donor cell as in flux-corrected transport (Zalesak 1979). Inflow during the same step
// does not count.
// Invariant: shares times transfers, each cut toward zero, sum to no more than the cell holds. The margin of 2^-20 is
// sixteen times the largest rounding error of the four operations.
#include "shared/groups.h"
#include "wave/water_column.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(binding = TRANSFER) uniform isamplerBuffer transfer;
layout(std430, binding = GIVEN_SHARE) restrict writeonly buffer GivenShare { float given_share[]; };

#define MARGIN 9.5367431640625e-7

/// Outflow through a face, for a transfer that is positive outward. As a float, because the lowest integer has no
/// negative.
float leaving(int outward_units) { return max(float(outward_units), 0.0); }
float leavingBackward(int inward_units) { return max(-float(inward_units), 0.0); }

void main() {
  const ivec2 n = waveCounts();
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const int left = wrapped(cell.x - 1, n.x);
  const int row = n.x * cell.y;
  const int last_row = n.x * wrapped(cell.y - 1, n.y);
  const int i = cell.x + row;

  const ivec4 own = texelFetch(transfer, i);
  const ivec4 from_left = texelFetch(transfer, left + row);
  const ivec4 from_before = texelFetch(transfer, cell.x + last_row);
  float outflow = leaving(own.x) + leaving(own.y) + leavingBackward(from_left.x) + leavingBackward(from_before.y);
#if STENCIL == 9
  const ivec4 from_corner = texelFetch(transfer, left + last_row);
  outflow += leaving(own.z) + leavingBackward(from_corner.z) + leaving(from_left.w) + leavingBackward(from_before.w);
#endif
  const float held = float(heldUnits(texelFetch(elevation, i).x, stillDepth(i)));
  given_share[i] = outflow > (1.0 - MARGIN) * held ? held / max(outflow, 1.0) * (1.0 - MARGIN) : 1.0;
}
