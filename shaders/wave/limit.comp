// Before the water moves: multiplies the transfer through each face by the share of the giving cell
// (wave/given_share.comp, in the same steps).
// Reads GIVEN_SHARE. Updates TRANSFER [nx x nz, units], and FLOW [m^2/s] by the same share: water that does not move carries
// no momentum.
// Invariant: only the giving cell limits a face; if no cell lacks water, no bit changes.
#include "shared/groups.h"
#include "wave/water_column.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = GIVEN_SHARE) uniform samplerBuffer given_share;
layout(std430, binding = TRANSFER) restrict buffer Transfer { Units transfer[]; };
layout(std430, binding = FLOW) restrict buffer FaceFlow { StoredFlow stored_flow[]; };

float shareOf(int transfer_units, float share_here, float share_there) { return transfer_units > 0 ? share_here : share_there; }

void main() {
  const ivec2 n = waveCounts();
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const int right = wrapped(cell.x + 1, n.x);
  const int row = n.x * cell.y;
  const int next_row = n.x * wrapped(cell.y + 1, n.y);
  const int i = cell.x + row;

  const float here = texelFetch(given_share, i).x;
  const float there_x = texelFetch(given_share, right + row).x;
  const float there_z = texelFetch(given_share, cell.x + next_row).x;
  Units moved = transfer[i];
#if STENCIL == 9
  const float there_d = texelFetch(given_share, right + next_row).x;
  const Flow share = vec4(shareOf(moved.x, here, there_x), shareOf(moved.y, here, there_z), shareOf(moved.z, here, there_d),
                          shareOf(moved.w, there_x, there_z));
#else
  const Flow share = vec2(shareOf(moved.x, here, there_x), shareOf(moved.y, here, there_z));
#endif
  if (all(equal(share, Flow(1.0)))) return;
  for (uint k = 0u; k < OWNED_FACES; ++k) moved[k] = share[k] < 1.0 ? int(float(moved[k]) * share[k]) : moved[k];
  transfer[i] = moved;
#if NONLINEAR
  stored_flow[i] *= share.xyxy;
#else
  stored_flow[i] *= share;
#endif
}
