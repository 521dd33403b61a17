// Collision of particles with rocks and breakwaters, along the gradient of their signed distance.
#ifndef SPINDRIFT_TERRAIN
#define SPINDRIFT_TERRAIN

#include "common/terrain_texels.glsl"
#include "wave/wave_cell.glsl"

/// Returns the signed distance, its gradient and the still depth (inside an obstacle: minus its height above the water)
/// at a position. The distance is extrapolated from the cell's centre along the gradient.
vec4 terrainAt(vec2 xz) {
  const ivec2 n = waveCounts();
  const vec2 u = (xz + waveHalf_m()) / sim.wave_cell_m;
  const vec2 c = floor(u);
  vec4 t = texelFetch(terrain, waveNeighbourX(int(c.x), n.x) + n.x * waveNeighbourZ(int(c.y), n.y));
  t.x += dot(t.yz, (u - c - 0.5) * sim.wave_cell_m);
  return t;
}

/// Moves a particle inside an obstacle, below its top, to the side of the obstacle and removes its speed into the
/// obstacle.
void pushOutOfRocks(inout vec3 x, inout vec3 v) {
  const vec4 t = terrainAt(x.xz);
  const bool inside = t.x < 0.0 && t.w < 0.0 && x.y < -t.w;
  const float depth_m = inside ? sim.floor_gap_m - t.x : 0.0;
  x.xz += depth_m * t.yz;
  v.xz -= inside ? t.yz * min(dot(v.xz, t.yz), 0.0) : vec2(0.0);
}

#endif
