// Prepares the surface for particles and boats: one texel with all values of a lookup, and the wave's horizontal
// velocity.
// Reads ELEVATION [nx x nz, units], FLOW, BASIN. Writes SURFACE (eta, d eta/dt, d eta/dx, d eta/dz) and SURFACE_FLOW [m/s].
// Equations: differences in metres (thesis, algorithm 9); d eta/dt = -div q; velocity = q / d, from the faces around a cell.
// NONLINEAR: the velocities are those of FLOW. The surface of dry cells is the ground.
#include "shared/groups.h"
#include "wave/transfer.glsl"
#include "wave/wave_faces.glsl"
#if NONLINEAR
#include "wave/shallow_column.glsl"
#endif

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(binding = FLOW) uniform samplerBuffer flow;
layout(std430, binding = SURFACE) restrict writeonly buffer Surface { vec4 surface[]; };
layout(std430, binding = SURFACE_FLOW) restrict writeonly buffer SurfaceFlow { vec2 flow_mps[]; };

#if NONLINEAR
bool isDry(int i, int eta) { return columnOf(i, eta).water_m <= 0.0; }
#endif

int at(int x, int row) { return texelFetch(elevation, x + row).x; }

void main() {
  const ivec2 n = waveCounts();
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const int row = n.x * cell.y;
  const int i = cell.x + row;
  const ivec2 left = ivec2(wrapped(cell.x - 1, n.x), cell.y);
  const ivec2 before = ivec2(cell.x, wrapped(cell.y - 1, n.y));

  const float inverse_dx = 1.0 / sim.wave_cell_m;
  const int here = at(cell.x, row);
  int right_eta = at(waveNeighbourX(cell.x + 1, n.x), row);
  int left_eta = at(waveNeighbourX(cell.x - 1, n.x), row);
  int after_eta = at(cell.x, n.x * waveNeighbourZ(cell.y + 1, n.y));
  int before_eta = at(cell.x, n.x * waveNeighbourZ(cell.y - 1, n.y));

#if NONLINEAR
  const vec4 own_stored = texelFetch(flow, i);
  const vec4 left_stored = texelFetch(flow, left.x + row);
  const vec4 before_stored = texelFetch(flow, cell.x + n.x * before.y);
  const float rate_mps = left_stored.z - own_stored.z + before_stored.w - own_stored.w;
  const vec2 velocity_mps = 0.5 * (own_stored.xy + vec2(left_stored.x, before_stored.y));
  // Dry ground above the level of the water is a wall: the elevation continues level behind it.
  const bool is_wet = columnOf(i, here).water_m > 0.0;
  right_eta = is_wet && right_eta > here && isDry(waveNeighbourX(cell.x + 1, n.x) + row, right_eta) ? here : right_eta;
  left_eta = is_wet && left_eta > here && isDry(waveNeighbourX(cell.x - 1, n.x) + row, left_eta) ? here : left_eta;
  after_eta = is_wet && after_eta > here && isDry(cell.x + n.x * waveNeighbourZ(cell.y + 1, n.y), after_eta) ? here : after_eta;
  before_eta = is_wet && before_eta > here && isDry(cell.x + n.x * waveNeighbourZ(cell.y - 1, n.y), before_eta) ? here : before_eta;
#else
  const Flow own_flow = asFlow(texelFetch(flow, i));
  const Flow left_flow = asFlow(texelFetch(flow, left.x + row));
  const Flow before_flow = asFlow(texelFetch(flow, cell.x + n.x * before.y));
#if VARIED
  // A closed face is a wall: the elevation continues level behind it.
  const Flow open = conductanceOf(cell, n);
  const Flow open_left = conductanceOf(left, n);
  const Flow open_before = conductanceOf(before, n);
  right_eta = open.x > 0.0 ? right_eta : here;
  left_eta = open_left.x > 0.0 ? left_eta : here;
  after_eta = open.y > 0.0 ? after_eta : here;
  before_eta = open_before.y > 0.0 ? before_eta : here;
  const vec2 conductance_m = vec2(open.x + open_left.x, open.y + open_before.y);
#else
  const vec2 conductance_m = vec2(2.0 * sim.wave_depth_m) * FLOW_WEIGHTS.x;
#endif
  float rate_mps = left_flow.x - own_flow.x + before_flow.y - own_flow.y;
#if STENCIL == 9
  rate_mps += texelFetch(flow, left.x + n.x * before.y).z - own_flow.z + before_flow.w - left_flow.w;
#endif
  const vec2 velocity_mps = vec2(own_flow.x + left_flow.x, own_flow.y + before_flow.y) / max(conductance_m, 0.05 * sim.wave_depth_m);
#endif
  const vec2 slope = ELEVATION_UNIT_M * vec2(right_eta - left_eta, after_eta - before_eta) * (0.5 * inverse_dx);
  surface[i] = vec4(metres(here), rate_mps * inverse_dx, slope);
  flow_mps[i] = velocity_mps;
}
