// The slopes that the dispersion filters in nonlinear shallow water: of the surface, the pressure heads, and the pressure of
// water that rises or falls faster below than a hydrostatic column would.
// Reads ELEVATION [nx x nz, units], FLOW [velocities, m/s], PRESSURE_HEAD, BED. Writes SURFACE_RISE [nx x nz x 2, units per
// cell] at the faces toward +x and +z of each cell.
// Equation: head_q = h^2 (div u)^2 / g, at most MAX_DYNAMIC_HEAD h. The equations of Serre (1953; Green & Naghdi 1976) have
// this term with the factor 2/3, and dispersion by the real depth where ours takes the still one; with the factor 1 solitary waves
// of 0.1 and 0.3 of the depth keep their height (docs/shore.md).
// Invariant: exactly 0 between cells at the same level without flow, and beside a dry cell.
#include "shared/groups.h"
#include "wave/pressure_head.glsl"
#include "wave/shallow_column.glsl"
#if MAKERS
#include "wave/maker_flow.glsl"
#endif

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(binding = FLOW) uniform samplerBuffer flow;
layout(std430, binding = SURFACE_RISE) restrict writeonly buffer SurfaceRise { vec2 surface_rise[]; };

#define MAX_DYNAMIC_HEAD 0.1

/// head_q of a cell, for velocities through its faces toward + and - x, + and - z. [units]
float dynamicHead(Column water, vec4 u_mps) {
  const float stretch = water.water_m * (u_mps.x - u_mps.y + u_mps.z - u_mps.w) / sim.wave_cell_m;
  return min(stretch * stretch / max(sim.gravity_mps2, 1e-6), MAX_DYNAMIC_HEAD * water.water_m) * ELEVATION_UNITS_PER_M;
}

void main() {
  const ivec2 n = waveCounts();
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const int row = n.x * cell.y;
  const int row_before = n.x * wrapped(cell.y - 1, n.y);
  const int row_after = n.x * wrapped(cell.y + 1, n.y);
  const int x_before = wrapped(cell.x - 1, n.x);
  const int x_after = wrapped(cell.x + 1, n.x);
  const int i = cell.x + row;
  const int i_x = x_after + row;
  const int i_z = cell.x + row_after;
  const vec2 own = texelFetch(flow, i).xy;
  vec2 at_x = texelFetch(flow, i_x).xy;
  vec2 at_z = texelFetch(flow, i_z).xy;
  float before_x = texelFetch(flow, x_before + row).x;
  float before_z = texelFetch(flow, cell.x + row_before).y;
#if MAKERS
  if (cell.x == 0) before_x = makerFlow(MAKER_MINUS_X, cell.y, n).x;
  if (cell.x == n.x - 2) at_x.x = makerFlow(MAKER_PLUS_X, cell.y, n).x;
  if (cell.y == 0) before_z = makerFlow(MAKER_MINUS_Z, cell.x, n).x;
  if (cell.y == n.y - 2) at_z.y = makerFlow(MAKER_PLUS_Z, cell.x, n).x;
#endif
  const Column here = columnOf(i, texelFetch(elevation, i).x);
  const Column there_x = columnOf(i_x, texelFetch(elevation, i_x).x);
  const Column there_z = columnOf(i_z, texelFetch(elevation, i_z).x);
  const float pressed = dynamicHead(here, vec4(own.x, before_x, own.y, before_z));
  const float pressed_x = dynamicHead(there_x, vec4(at_x.x, own.x, at_x.y, texelFetch(flow, x_after + row_before).y));
  const float pressed_z = dynamicHead(there_z, vec4(at_z.x, texelFetch(flow, x_before + row_after).x, at_z.y, own.y));
  const int head = headAt(i);
  const vec2 rise = vec2(drivingRise(here, there_x, headAt(i_x) - head) + pressed_x - pressed,
                         drivingRise(here, there_z, headAt(i_z) - head) + pressed_z - pressed);
  const bvec2 is_wet = bvec2(min(here.water_m, there_x.water_m) > 0.0, min(here.water_m, there_z.water_m) > 0.0);
  surface_rise[i] = mix(vec2(0.0), rise, is_wet);
}
