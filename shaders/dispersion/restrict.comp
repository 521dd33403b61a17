// Takes what a grid has left unsolved to the next coarser grid. One invocation per coarse cell.
// Reads DISPERSION_FACES, DISPERSION_STIFFNESS and the right side of the finer grid; DISPERSION_FROM_X, DISPERSION_FROM_Z
// where obstacles make the weights uneven. Writes DISPERSION_COARSE_RIGHT.
// Equation: r_coarse = P^T (r - K phi)/4, with P the weights by which coarse faces enter finer ones (correct.comp).
#include "shared/groups.h"
#include "dispersion/grid_faces.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = DISPERSION_FACES) uniform samplerBuffer faces;
#if UNEVEN
layout(binding = DISPERSION_FROM_X) uniform samplerBuffer from_x;
layout(binding = DISPERSION_FROM_Z) uniform samplerBuffer from_z;
#endif
layout(std430, binding = DISPERSION_COARSE_RIGHT) restrict writeonly buffer CoarseRight { vec4 coarse_right[]; };

vec4 faceAt(ivec2 cell, int n) { return texelFetch(faces, cellAt(cell, n)); }

vec2 pressedAt(ivec2 cell, int n) {
  return pressed(faceAt(cell, n), faceAt(cell - ivec2(1, 0), n), faceAt(cell - ivec2(0, 1), n),
                 texelFetch(stiffness, cellAt(cell, n)));
}

vec2 leftX(ivec2 cell, int n) {
  return rightSideAt(cell, n).xy - texelFetch(stiffness, cellAt(cell, n)).x * faceAt(cell, n).xy +
         pressedAt(cell + ivec2(1, 0), n) - pressedAt(cell, n);
}

vec2 leftZ(ivec2 cell, int n) {
  return rightSideAt(cell, n).zw - texelFetch(stiffness, cellAt(cell, n)).y * faceAt(cell, n).zw +
         pressedAt(cell + ivec2(0, 1), n) - pressedAt(cell, n);
}

#if UNEVEN
/// Share of what the four inner faces of a block have left that goes to the coarse face `side` of the block.
vec2 innerShare(ivec2 first, int side, int n) {
  const ivec2 right = first + ivec2(1, 0);
  const ivec2 above = first + ivec2(0, 1);
  return texelFetch(from_x, cellAt(first, n))[side] * leftX(first, n) + texelFetch(from_x, cellAt(above, n))[side] * leftX(above, n) +
         texelFetch(from_z, cellAt(first, n))[side] * leftZ(first, n) + texelFetch(from_z, cellAt(right, n))[side] * leftZ(right, n);
}
#endif

void main() {
  const int n = gridSide();
  const ivec2 coarse = ivec2(gl_GlobalInvocationID.xy);
  if (coarse.x >= n / 2 || coarse.y >= n / 2) return;
  const ivec2 first = 2 * coarse;
  const ivec2 x = first + ivec2(1, 0);
  const ivec2 z = first + ivec2(0, 1);
  const ivec2 both = first + ivec2(1, 1);
  const ivec2 next_x = first + ivec2(2, 0);
  const ivec2 next_z = first + ivec2(0, 2);
#if UNEVEN
  const vec2 sum_x = texelFetch(from_x, cellAt(x, n)).x * leftX(x, n) + texelFetch(from_x, cellAt(both, n)).x * leftX(both, n) +
                     innerShare(first, 0, n) + innerShare(next_x, 1, n);
  const vec2 sum_z = texelFetch(from_z, cellAt(z, n)).z * leftZ(z, n) + texelFetch(from_z, cellAt(both, n)).z * leftZ(both, n) +
                     innerShare(first, 2, n) + innerShare(next_z, 3, n);
#else
  const vec2 sum_x = leftX(x, n) + leftX(both, n) + 0.5 * (leftX(first, n) + leftX(z, n) + leftX(next_x, n) + leftX(next_x + ivec2(0, 1), n));
  const vec2 sum_z = leftZ(z, n) + leftZ(both, n) + 0.5 * (leftZ(first, n) + leftZ(x, n) + leftZ(next_z, n) + leftZ(next_z + ivec2(1, 0), n));
#endif
  coarse_right[coarse.x + n / 2 * coarse.y] = 0.25 * vec4(sum_x, sum_z);
}
