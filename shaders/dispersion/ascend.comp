// On the way up the V-cycle: the two sweeps of descend.comp again, the correction of the coarser grid, two sweeps.
// Reads DISPERSION_COEFFICIENTS, the right side of this grid (ELEVATION and PRESSURE_HEAD if FINEST, with
// NONLINEAR SURFACE_RISE, otherwise DISPERSION_RIGHT), DISPERSION_COARSE, DISPERSION_WEIGHTS except if STEADY. Writes DISPERSION_FACES; on the finest grid
// DISPERSED instead: F grad(eta), what wave/momentum.comp takes for depth times slope [m * units per cell]; with NONLINEAR with
// that of the step before behind it.
// Equation: phi_3 = phi_2 + P coarse, with the weights P of strip.glsl; then phi += w (r - K phi) twice; F grad(eta) = a
// grad(eta) + sum_j sqrt(c_j) phi_j.
#include "dispersion/strip.glsl"

layout(local_size_x = DISPERSION_GROUP) in;

layout(binding = DISPERSION_COARSE) uniform samplerBuffer coarse;
#if FINEST
#if NONLINEAR
layout(std430, binding = DISPERSED) restrict buffer Dispersed { vec4 dispersed[]; };
#else
layout(std430, binding = DISPERSED) restrict writeonly buffer Dispersed { vec2 dispersed[]; };
#endif
#else
layout(std430, binding = DISPERSION_FACES) restrict writeonly buffer Faces { vec4 faces_after[]; };
#endif

/// Columns of the neighbours on the left.
const int kBefore = 3;

/// Adds P coarse to row z. Blocks begin at the odd columns of the row, because first_x - kBefore is odd.
void correct(int z, int block_column[WIDTH / 2 + 1], inout vec4 faces[WIDTH]) {
  const int row = int(coarse_nx) * (z / 2);
  const int row_before = int(coarse_nx) * wrapped(z / 2 - 1, counts.y / 2);
  vec4 here[WIDTH / 2 + 1];
  vec2 south[WIDTH / 2 + 1];
  for (int k = 0; k <= WIDTH / 2; ++k) {
    here[k] = texelFetch(coarse, block_column[k] + row);
    south[k] = texelFetch(coarse, block_column[k] + row_before).zw;
  }
  for (int c = 1; c < WIDTH - 1; ++c) {
    const int k = (c + 1) / 2;
#if STEADY && !FLAT
    // Rounded like the sums below.
    const vec2 z_share = z % 2 == 1 ? here[k].zw : 0.5 * (here[k].zw + south[k]);
    faces[c] += vec4(c % 2 == 0 ? here[k].xy : 0.5 * (here[k].xy + here[k - 1].xy), z_share);
#else
    const Weights w = weightsAt(c, c % 2 == 0, z);
    faces[c] += vec4(w.x.x * here[k].xy + w.x.y * here[k - 1].xy + w.x.z * here[k].zw + w.x.w * south[k],
                     w.z.x * here[k].xy + w.z.y * here[k - 1].xy + w.z.z * here[k].zw + w.z.w * south[k]);
#endif
  }
}

void main() {
  const ivec2 first = firstCell(ivec2(gl_GlobalInvocationID.xy));
  const int first_x = first.x;
  const int first_z = first.y;
  const ivec2 n = counts;
  if (first_x >= n.x || first_z >= n.y) return;
  // Three sweeps, each of which needs a row before.
  const int begin_z = first_z - 3;
  begin(first_x - kBefore, begin_z, first_z + 1);
  const int end_z = min(first_z + DISPERSION_STRIP, n.y);
#if FINEST
  const ivec2 owned = waveCounts();
#else
  const ivec2 owned = n;
#endif
  int block_column[WIDTH / 2 + 1];
  for (int k = 0; k <= WIDTH / 2; ++k) block_column[k] = around(first_x / 2 - 2 + k, n.x / 2);
  Row rows[4];
  Swept first_sweep;
  Swept second_sweep;
  Swept third_sweep;
  rows[0] = rows[1] = rows[2] = fetchRow(around(begin_z, n.y));
  start(rows[0], first_sweep.faces);
  for (int c = 0; c < WIDTH; ++c) first_sweep.pressed[c] = Pressed(0.0);
  third_sweep = second_sweep = first_sweep;
  for (int z = begin_z + 1; z < end_z + 3; ++z) {
    rows[3] = rows[2];
    rows[2] = rows[1];
    rows[1] = rows[0];
    rows[0] = fetchRow(around(z, n.y));
    vec4 faces[WIDTH];
    vec4 swept[WIDTH];
    start(rows[0], faces);
    sweepRow(0, first_sweep, rows[1], rows[0], faces, swept);
    correct(around(z - 1, n.y), block_column, swept);
    sweepRow(1, second_sweep, rows[2], rows[1], swept, faces);
    sweepRow(2, third_sweep, rows[3], rows[2], faces, swept);
    const int done = z - 3;
    if (done < first_z) continue;
    for (int k = 0; k < DISPERSION_COLUMNS; ++k) {
      const int c = kBefore + k;
      const int i = first_x + k + owned.x * done;
      if (first_x + k >= owned.x || done >= owned.y) continue;
#if FINEST
#if STEADY
      const vec4 root_c = steady_rest[c];
#else
      const vec4 root_c = halves(texelFetch(coefficients, first_x + k + n.x * done).zw);
#endif
      const vec4 shares = root_c * swept[c];
      const bvec2 is_open = greaterThan(weightOf(rows[3], c).xz, vec2(0.0));
      const vec2 slope = rows[3].right[c].xz / root_c.xz;
      const vec2 at_once = min(DISPERSION_DEPTH_SHARE * sim.wave_depth_m / stiffnessOf(rows[3], c).xy, vec2(DISPERSION_CELL_SHARE * sim.wave_cell_m));
      const vec2 filtered = mix(vec2(0.0), at_once * slope + vec2(shares.x + shares.y, shares.z + shares.w), is_open);
#if NONLINEAR
      dispersed[i] = vec4(filtered, dispersed[i].xy);
#else
      dispersed[i] = filtered;
#endif
#else
      faces_after[i] = swept[c];
#endif
    }
  }
}
