// On the way down the V-cycle: two sweeps from zero; what is left goes to the next coarser grid.
// Reads DISPERSION_COEFFICIENTS, the right side of this grid (ELEVATION and PRESSURE_HEAD if FINEST, with
// NONLINEAR SURFACE_RISE, otherwise DISPERSION_RIGHT), DISPERSION_WEIGHTS except if STEADY. Writes DISPERSION_COARSE_RIGHT.
// Equation: phi_1 = w r, phi_2 = phi_1 + w (r - K phi_1), r_coarse = P^T (r - K phi_2)/4, with the weights P of strip.glsl.
#include "dispersion/strip.glsl"

layout(local_size_x = DISPERSION_GROUP) in;

layout(std430, binding = DISPERSION_COARSE_RIGHT) restrict writeonly buffer CoarseRight { vec4 coarse_right[]; };

/// Columns of the neighbours on the left.
const int kBefore = 2;
const int kBlocks = DISPERSION_COLUMNS / 2;

void main() {
  const ivec2 first = firstCell(ivec2(gl_GlobalInvocationID.xy));
  const int first_x = first.x;
  const int first_z = first.y;
  const ivec2 n = counts;
  if (first_x >= n.x || first_z >= n.y) return;
  // Two sweeps, and the row before the first.
  const int begin_z = first_z - 2;
  begin(first_x - kBefore, begin_z, first_z + 1);
  const int end_z = min(first_z + DISPERSION_STRIP, n.y);
  Row rows[3];
  Swept first_sweep;
  Swept second_sweep;
  rows[0] = rows[1] = fetchRow(around(begin_z, n.y));
  start(rows[0], first_sweep.faces);
  for (int c = 0; c < WIDTH; ++c) first_sweep.pressed[c] = Pressed(0.0);
  second_sweep = first_sweep;
  // Sums over the faces of a row of blocks, one more than the own ones: for their coarse faces (E, N) and (W, S). The coarse
  // faces N of the row of blocks before wait for S of this one.
  vec4 own_side[kBlocks + 1];
  vec4 other_side[kBlocks + 1];
  vec4 waiting[kBlocks];
  for (int z = begin_z + 1; z <= end_z + 3; ++z) {
    rows[2] = rows[1];
    rows[1] = rows[0];
    rows[0] = fetchRow(around(z, n.y));
    vec4 faces[WIDTH];
    vec4 swept[WIDTH];
    vec4 left[WIDTH];
    start(rows[0], faces);
    sweepRow(0, first_sweep, rows[1], rows[0], faces, swept);
    takeRow(1, second_sweep, rows[2], rows[1], swept, left);
    const int done = z - 2;  // the row of `left`
    if (done < first_z) continue;
    for (int k = 0; k <= kBlocks; ++k) {
      if (done % 2 == 0) own_side[k] = other_side[k] = vec4(0.0);
      for (int odd = 0; odd < 2; ++odd) {
        const int c = kBefore + 2 * k + odd;
        const Weights w = weightsAt(c, odd == 1, around(done, n.y));
        own_side[k] += vec4(w.x.x * left[c].xy + w.z.x * left[c].zw, w.x.z * left[c].xy + w.z.z * left[c].zw);
        other_side[k] += vec4(w.x.y * left[c].xy + w.z.y * left[c].zw, w.x.w * left[c].xy + w.z.w * left[c].zw);
      }
    }
    if (done % 2 == 0) continue;
    for (int k = 0; k < kBlocks; ++k) {
      const int block = first_x / 2 + k;
      if (done > first_z + 1 && block < n.x / 2)
        coarse_right[block + int(coarse_nx) * (done / 2 - 1)] = 0.25 * (waiting[k] + vec4(0.0, 0.0, other_side[k].zw));
      waiting[k] = own_side[k] + vec4(other_side[k + 1].xy, 0.0, 0.0);
    }
  }
}
