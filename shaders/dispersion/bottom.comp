// The small grids of the V-cycle, down to the coarsest and back, in one work group: one dispatch for each pass over them would
// cost more than the passes.
// Reads DISPERSION_RIGHT of the largest of them, and of all of them, one behind the other, DISPERSION_STIFFNESS,
// DISPERSION_SPREAD, DISPERSION_SWEEP, DISPERSION_FROM_X, DISPERSION_FROM_Z. Writes DISPERSION_FACES of the largest.
// Equations: those of descend.comp and ascend.comp; in the coarsest grid sweeps alone.
#include "shared/dispersion_uniforms.h"
#include "shared/bindings.h"
#include "shared/groups.h"

layout(local_size_x = DISPERSION_BOTTOM_GROUP) in;

layout(binding = DISPERSION_STIFFNESS) uniform samplerBuffer stiffness;
layout(binding = DISPERSION_SPREAD) uniform samplerBuffer spread;
layout(binding = DISPERSION_SWEEP) uniform samplerBuffer sweep_weight;
layout(binding = DISPERSION_RIGHT) uniform samplerBuffer right_side;
layout(binding = DISPERSION_FROM_X) uniform samplerBuffer from_x;
layout(binding = DISPERSION_FROM_Z) uniform samplerBuffer from_z;
layout(std430, binding = DISPERSION_FACES) restrict writeonly buffer Faces { vec4 faces[]; };

/// As large as a square grid of less than DISPERSION_BOTTOM_SIDE_MAX cells per side, an odd number that cannot be halved, or all
/// grids from one as large as DISPERSION_BOTTOM_SIDE squared down (sim_setup/dispersion.h, bottomOf()).
#define MAX_CELLS ((DISPERSION_BOTTOM_SIDE_MAX - 1) * (DISPERSION_BOTTOM_SIDE_MAX - 1))
#define MAX_SMALLER_CELLS (DISPERSION_BOTTOM_SIDE * DISPERSION_BOTTOM_SIDE / 3 + 1)

/// Of all grids, one behind the other: the faces; the right sides of all but the largest. Of the cells of one grid: e div phi - f D
/// phi along x and along z.
shared vec4 phi[MAX_CELLS];
shared vec4 right_of_smaller[MAX_SMALLER_CELLS];
shared vec4 pressed[MAX_CELLS];

#define FOR_EACH(i, count) for (int i = int(gl_LocalInvocationIndex); i < count; i += DISPERSION_BOTTOM_GROUP)

int after(int x, int n) { return x + 1 == n ? 0 : x + 1; }
int before(int x, int n) { return x == 0 ? n - 1 : x - 1; }

/// The next coarser grid. All but the coarsest have an even number of cells along each axis; one more may be dry.
ivec2 coarserThan(ivec2 n, bool is_coarsest) { return is_coarsest ? n / 2 : (n / 2 + 1) / 2 * 2; }

vec4 rightAt(int first, int i) { return first == 0 ? texelFetch(right_side, i) : right_of_smaller[first - textureSize(right_side) + i]; }

/// pressed = e div phi - f D phi. Other invocations may read it after a barrier.
void press(int first, ivec2 n) {
  barrier();
  FOR_EACH(i, n.x * n.y) {
    const int x = i % n.x;
    const int z = i / n.x;
    const vec4 across = phi[first + i] - vec4(phi[first + before(x, n.x) + n.x * z].xy, phi[first + x + n.x * before(z, n.y)].zw);
    pressed[i] = (texelFetch(stiffness, first + i).zw * (across.xy + across.zw)).xyxy - texelFetch(spread, first + i) * across;
  }
  barrier();
}

/// r - K phi at the faces of a cell, after press().
vec4 leftAt(int first, ivec2 n, int x, int z) {
  const int i = x + n.x * z;
  const vec4 here = pressed[i];
  return rightAt(first, i) - texelFetch(stiffness, first + i).xxyy * phi[first + i] +
         vec4(pressed[after(x, n.x) + n.x * z].xy, pressed[x + n.x * after(z, n.y)].zw) - here;
}

void sweep(int first, ivec2 n) {
  press(first, n);
  FOR_EACH(i, n.x * n.y) phi[first + i] += texelFetch(sweep_weight, first + i) * leftAt(first, n, i % n.x, i / n.x);
}

/// What the inner faces of a block have left for its coarse face `side` (0 E, 1 W, 2 N, 3 S).
vec2 innerShare(int first, ivec2 n, int x, int z, int side) {
  const int i = first + x + n.x * z;
  const vec4 corner = leftAt(first, n, x, z);
  return texelFetch(from_x, i)[side] * corner.xy + texelFetch(from_x, i + n.x)[side] * leftAt(first, n, x, z + 1).xy +
         texelFetch(from_z, i)[side] * corner.zw + texelFetch(from_z, i + 1)[side] * leftAt(first, n, x + 1, z).zw;
}

/// The same for the outer faces of the block toward +x and +z, except those that the coarse face covers: they lead to a strip
/// behind a wall, which belongs to the block.
vec2 stripShare(int first, ivec2 n, int x, int z, int side) {
  const int i = first + x + n.x * z;
  const vec4 both = leftAt(first, n, x + 1, z + 1);
  vec2 sum = vec2(0.0);
  if (side != 0) sum += texelFetch(from_x, i + 1)[side] * leftAt(first, n, x + 1, z).xy + texelFetch(from_x, i + n.x + 1)[side] * both.xy;
  if (side != 2) sum += texelFetch(from_z, i + n.x)[side] * leftAt(first, n, x, z + 1).zw + texelFetch(from_z, i + n.x + 1)[side] * both.zw;
  return sum;
}

void restrictToCoarse(int first, ivec2 n, ivec2 coarse_n) {
  const int coarse_right = first + n.x * n.y - textureSize(right_side);
  press(first, n);
  // Not a constant, or Mesa repeats the body of the loop below four times.
  const int sides = 4 * min(int(grid_count), 1);
  FOR_EACH(k, coarse_n.x * coarse_n.y) {
    const int x = 2 * (k % coarse_n.x);
    const int z = 2 * (k / coarse_n.x);
    if (x >= n.x || z >= n.y) {
      right_of_smaller[coarse_right + k] = vec4(0.0);
      continue;
    }
    const int next_x = after(x + 1, n.x);
    const int next_z = after(z + 1, n.y);
    const int i = first + x + n.x * z;
    const vec4 both = leftAt(first, n, x + 1, z + 1);
    vec2 inner[4], strip[4];
    for (int side = 0; side < sides; ++side) {
      const ivec2 at = side == 1 ? ivec2(next_x, z) : (side == 3 ? ivec2(x, next_z) : ivec2(x, z));
      inner[side] = innerShare(first, n, at.x, at.y, side);
      strip[side] = stripShare(first, n, at.x, at.y, side);
    }
    const vec2 sum_x = texelFetch(from_x, i + 1).x * leftAt(first, n, x + 1, z).xy + texelFetch(from_x, i + n.x + 1).x * both.xy + inner[0] +
                       inner[1] + (strip[0] + strip[1]);
    const vec2 sum_z = texelFetch(from_z, i + n.x).z * leftAt(first, n, x, z + 1).zw + texelFetch(from_z, i + n.x + 1).z * both.zw + inner[2] +
                       inner[3] + (strip[2] + strip[3]);
    right_of_smaller[coarse_right + k] = 0.25 * vec4(sum_x, sum_z);
  }
}

void correct(int first, ivec2 n, ivec2 coarse_n) {
  const int coarse = first + n.x * n.y;
  barrier();
  FOR_EACH(i, n.x * n.y) {
    const int x = (i % n.x) / 2;
    const int z = (i / n.x) / 2;
    const vec4 here = phi[coarse + x + coarse_n.x * z];
    const vec2 west = phi[coarse + before(x, n.x / 2) + coarse_n.x * z].xy;
    const vec2 south = phi[coarse + x + coarse_n.x * before(z, n.y / 2)].zw;
    const vec4 wx = texelFetch(from_x, first + i);
    const vec4 wz = texelFetch(from_z, first + i);
    phi[first + i] += vec4(wx.x * here.xy + wx.y * west + wx.z * here.zw + wx.w * south,
                           wz.x * here.xy + wz.y * west + wz.z * here.zw + wz.w * south);
  }
}

/// phi = w r
void start(int first, ivec2 n) {
  barrier();
  FOR_EACH(i, n.x * n.y) phi[first + i] = texelFetch(sweep_weight, first + i) * rightAt(first, i);
}

// Each step down or up is one turn of the same loop, and its bounds are not constants: otherwise the compiler repeats all of
// the above for each grid.
void main() {
  int first = 0;
  ivec2 n = ivec2(int(grid_nx), int(grid_nz));
  const int grids = int(grid_count);
  ivec2 counts[DISPERSION_BOTTOM_GRIDS_MAX];
  counts[0] = n;
  for (int k = 1; k < grids; ++k) counts[k] = coarserThan(counts[k - 1], k == grids - 1);
  int grid = 0;
  for (int turn = 0; turn < 2 * grids - 1; ++turn) {
    const bool descends = turn < grids;
    const bool is_coarsest = turn == grids - 1;
    if (descends) {
      start(first, n);
    } else {
      const ivec2 coarse_n = n;
      n = counts[--grid];
      first -= n.x * n.y;
      correct(first, n, coarse_n);
    }
    const int sweeps = is_coarsest ? DISPERSION_COARSEST_SWEEPS - 1 : (descends ? 1 : 2);
    for (int k = 0; k < sweeps; ++k) sweep(first, n);
    if (descends && !is_coarsest) {
      const ivec2 coarse_n = counts[++grid];
      restrictToCoarse(first, n, coarse_n);
      first += n.x * n.y;
      n = coarse_n;
    }
  }
  barrier();
  FOR_EACH(i, textureSize(right_side)) faces[i] = phi[i];
}
