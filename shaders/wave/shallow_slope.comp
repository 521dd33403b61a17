// The slopes that the dispersion filters in nonlinear shallow water: of the surface, the pressure heads, and the pressure of
// water that rises or falls faster below than a hydrostatic column would.
// Reads ELEVATION [nx x nz, units], FLOW [velocities, m/s], PRESSURE_HEAD, BED, BASIN, BREAKING, DISPERSED of the step before. Writes SURFACE_RISE
// [nx x nz x 2, units per cell] at the faces toward +x and +z of each cell: the slopes times the share that disperses there, and
// what makes it disperse by the real depth (dispersed_share.glsl).
// Equation: head_q = DYNAMIC_FACTOR h^2 (div u)^2 / g, at most MAX_DYNAMIC_HEAD h, h of at most HEAD_CELLS cells: a term of the equations of
// Serre (1953; Green & Naghdi 1976), as is DYNAMIC_FACTOR.
// Toward wave-makers the dynamic head fades out, within two depths of them.
// An invocation passes over WAVE_STRIP rows of a column: values that two rows share are fetched and computed once.
// Invariant: exactly 0 between cells at the same level without flow, and beside a dry cell.
#include "shared/groups.h"
#include "shared/side_bits.h"
#include "wave/dispersed_share.glsl"
#include "wave/pressure_head.glsl"
#include "wave/shallow_column.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(binding = FLOW) uniform samplerBuffer flow;
layout(std430, binding = SURFACE_RISE) restrict writeonly buffer SurfaceRise { vec2 surface_rise[]; };

/// The share of the water that its dynamic head can be. A solitary wave of 0.3 of the depth has 0.01. With 0.1, steep waves shorter
/// than the depth drove each other after breakers on a slope, at 20 cells per depth.
#define MAX_DYNAMIC_HEAD 0.02
/// The same bound where a depth has more cells than this: as if it had this many. Waves much shorter than the depth have no such
/// head, and one of several cells made them grow: to 0.09 of the depth, in water 1,000 cells deep to seven times the sea's height.
#define HEAD_CELLS 20.0
#define DYNAMIC_FACTOR (2.0 / 3.0)

/// head_q of a cell, for velocities through its faces toward + and - x, + and - z. [units]
float dynamicHead(Column water, vec4 u_mps) {
  const float stretch = water.water_m * (u_mps.x - u_mps.y + u_mps.z - u_mps.w) / sim.wave_cell_m;
  return min(DYNAMIC_FACTOR * stretch * stretch / max(sim.gravity_mps2, 1e-6), MAX_DYNAMIC_HEAD * min(water.water_m, HEAD_CELLS * sim.wave_cell_m)) * ELEVATION_UNITS_PER_M;
}

void main() {
  const ivec2 n = waveCounts();
  const int x = int(gl_GlobalInvocationID.x);
  const int first_z = WAVE_STRIP * int(gl_GlobalInvocationID.y);
  if (x >= n.x || first_z >= n.y) return;
  const int x_before = wrapped(x - 1, n.x);
  const int x_after = wrapped(x + 1, n.x);
  const int row_before = n.x * wrapped(first_z - 1, n.y);
  int row = n.x * first_z;
  // Values of this row and of the one before it. The loop fetches the row after it.
  vec2 own = texelFetch(flow, x + row).xy;
  float at_x_before_z = texelFetch(flow, x_after + row_before).y;
  Column here = columnOf(x + row, texelFetch(elevation, x + row).x);
  int head = headAt(x + row);
  float breaks = breakingAt(x + row);
  float pressed = dynamicHead(here, vec4(own.x, texelFetch(flow, x_before + row).x, own.y, texelFetch(flow, x + row_before).y));
#if MAKERS
  pressed *= awayFromMakers(vec2(x, first_z) + 0.5, n);
#endif
  for (int z = first_z; z < min(first_z + WAVE_STRIP, n.y); ++z) {
    const vec2 cell = vec2(x, z);
    const int row_after = n.x * wrapped(z + 1, n.y);
    const int i = x + row;
    const int i_x = x_after + row;
    const int i_z = x + row_after;
    const vec2 at_x = texelFetch(flow, i_x).xy;
    const vec2 at_z = texelFetch(flow, i_z).xy;
    const Column there_x = columnOf(i_x, texelFetch(elevation, i_x).x);
    const Column there_z = columnOf(i_z, texelFetch(elevation, i_z).x);
    float pressed_x = dynamicHead(there_x, vec4(at_x.x, own.x, at_x.y, at_x_before_z));
    float pressed_z = dynamicHead(there_z, vec4(at_z.x, texelFetch(flow, x_before + row_after).x, at_z.y, own.y));
#if MAKERS
    pressed_x *= awayFromMakers(cell + vec2(1.5, 0.5), n);
    pressed_z *= awayFromMakers(cell + vec2(0.5, 1.5), n);
#endif
    const int head_z = headAt(i_z);
    const vec2 rise = vec2(drivingRise(here, there_x, headAt(i_x) - head) + pressed_x - pressed,
                           drivingRise(here, there_z, head_z - head) + pressed_z - pressed);
    const vec2 depth_m = texelFetch(basin, i).xy;
    const float breaks_z = breakingAt(i_z);
    const vec4 psi = texelFetch(dispersed, i);
    const DispersedShare share_x = dispersedShare(depth_m.x, here, there_x, max(breaks, breakingAt(i_x)), psi.x, awayFromMakers(cell + vec2(1.0, 0.5), n));
    const DispersedShare share_z = dispersedShare(depth_m.y, here, there_z, max(breaks, breaks_z), psi.y, awayFromMakers(cell + vec2(0.5, 1.0), n));
    surface_rise[i] = rise * vec2(share_x.before, share_z.before) +
                      vec2(share_x.fed, share_z.fed) * vec2(extrapolated(psi.x, psi.z), extrapolated(psi.y, psi.w));
    row = row_after;
    own = at_z;
    at_x_before_z = at_x.y;
    here = there_z;
    head = head_z;
    breaks = breaks_z;
    pressed = pressed_z;
  }
}
