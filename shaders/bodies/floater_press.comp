// Pressure of the floaters on the water: the weight of the water that each displaces. One group per floater.
// Reads FLOATERS. Adds to PRESSURE_HEAD [nx x nz, units] (cleared before).
// The pressure is exp(-(q / 2 sqrt(pi))^2), q being the distance squared in standard deviations. It has the second moments of the
// floater's volume, and at least those of kLeastCells, so that the grid carries it; its integral is pi^2 products of deviations. The floater presses where it will be in the middle of the next tick.
#include "bodies/floater_texels.glsl"
#include "common/place_of.glsl"
#include "shared/fixed_point.h"

layout(local_size_x = FLOATER_GROUP) in;

layout(std430, binding = PRESSURE_HEAD) restrict buffer PressureHead { int pressure_head[]; };

const float kLeastCells = 0.8;      // standard deviation
const float kReach = 3.0;           // standard deviations
const float kHighestHead = 0.5;     // of the depth

void main() {
  Floater b = floaterAt(gl_WorkGroupID.x);
  const float pressing_m3 = b.dent * min(b.density_ratio, 1.0) * volumeOf(b);
  if (b.age_s < 0.0 || !(pressing_m3 > 0.0)) return;  // also one with a non-finite state
  b = drifted(b, 0.5 * (sim.tick_s - sim.wave_dt_s));
  // Second moments over x and z: half extents squared over 3 for a box, and so on.
  const vec3 inertia_m2 = inertiaOf(b);
  const vec3 moments_m2 = max(0.5 * (inertia_m2.x + inertia_m2.y + inertia_m2.z) - inertia_m2, vec3(0.0));
  const float cell_m = sim.wave_cell_m;
  const float least_m2 = kLeastCells * kLeastCells * cell_m * cell_m;
  float xx = least_m2, xz = 0.0, zz = least_m2;
  for (int axis = 0; axis < 3; ++axis) {
    const vec3 way = rotated(b.rotation, vec3(axis == 0, axis == 1, axis == 2));
    xx += moments_m2[axis] * way.x * way.x;
    xz += moments_m2[axis] * way.x * way.z;
    zz += moments_m2[axis] * way.z * way.z;
  }
  const float determinant = xx * zz - xz * xz;
  const float highest_m = kHighestHead * sim.wave_depth_m;
  const float peak_m = min(pressing_m3 / (9.8696044 * sqrt(determinant)), highest_m);
  const ivec2 n = waveCounts();
  const ivec2 across = min(2 * ivec2(ceil(kReach * sqrt(vec2(xx, zz)) / cell_m)) + 1, n);
  const vec2 middle = clamp((middleOf(b).xz + waveHalf_m()) / cell_m, vec2(-1e6), vec2(1e6));
  const ivec2 first = ivec2(floor(middle)) - across / 2;
  for (int k = int(gl_LocalInvocationID.x); k < across.x * across.y; k += FLOATER_GROUP) {
    ivec2 cell = first + placeOf(k, across.x);
    const vec2 d = (vec2(cell) + 0.5 - middle) * cell_m;
    const float distance2 = (zz * d.x * d.x - 2.0 * xz * d.x * d.y + xx * d.y * d.y) / determinant;
#if WAVE_PERIODIC_X
    cell.x = wrapped(cell.x, n.x);
#endif
#if WAVE_PERIODIC_Z
    cell.y = wrapped(cell.y, n.y);
#endif
    if (distance2 > kReach * kReach || any(lessThan(cell, ivec2(0))) || any(greaterThanEqual(cell, n))) continue;
    const float units = peak_m * exp(-distance2 * distance2 / 12.566371) * ELEVATION_UNITS_PER_M;
    // Skip a floater with a non-finite state.
    const int whole = abs(units) < TRANSFER_MAX_UNITS ? int(round(units)) : 0;
    if (whole != 0) atomicAdd(pressure_head[cell.x + n.x * cell.y], whole);
  }
}
