// Prepares the surface for the particles: one texel with all that a lookup needs, and the wave's horizontal flow.
// Reads ELEVATION, ELEVATION_PREVIOUS [n x n, m]. Writes SURFACE (eta, d eta/dt, d eta/dx, d eta/dz); updates SURFACE_FLOW [m/s].
// Equations: differences in metres (thesis, algorithm 9); long waves accelerate the flow by -g grad(eta) (thesis 3.19).
// variants: WAVE_PERIODIC=1 | WAVE_PERIODIC=0
#include "shared/groups.h"
#include "include/wave_cell.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = ELEVATION) uniform samplerBuffer elevation;
layout(binding = ELEVATION_PREVIOUS) uniform samplerBuffer elevation_previous;
layout(std430, binding = SURFACE) restrict writeonly buffer Surface { vec4 surface[]; };
layout(std430, binding = SURFACE_FLOW) restrict buffer SurfaceFlow { vec2 flow_mps[]; };

float at(int x, int row) { return texelFetch(elevation, x + row).x; }

void main() {
  const int n = int(sim.wave_n);
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (cell.x >= n || cell.y >= n) return;
  const int row = n * cell.y;
  const int i = cell.x + row;
  const float inverse_2dx = 0.5 / sim.wave_cell_m;
  const vec2 slope = vec2(at(waveNeighbour(cell.x + 1, n), row) - at(waveNeighbour(cell.x - 1, n), row),
                          at(cell.x, n * waveNeighbour(cell.y + 1, n)) - at(cell.x, n * waveNeighbour(cell.y - 1, n))) * inverse_2dx;
  const float eta = at(cell.x, row);
  surface[i] = vec4(eta, (eta - texelFetch(elevation_previous, i).x) / sim.wave_dt_s, slope);
  flow_mps[i] = sim.flow_keep * flow_mps[i] - sim.dt_s * sim.gravity_mps2 * slope;
}
