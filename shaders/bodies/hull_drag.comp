// The water gets the momentum that its drag took from hulls which another program moves, spread like their volume.
// Reads BOATS, HULL_FORCES, ELEVATION [nx x nz, units], BASIN, BED. Changes FLOW at open faces (wave/wave_faces.glsl).
// Equation: q_t = -F w / (rho sum of w), w = hullShape at the face; NONLINEAR: u_t = q_t over the water at the face.
// Invariant: the momentum of the water changes by -F per second, within rounding, unless a hull reaches over closed faces.
#define MOVED 1
#include "shared/fixed_point.h"
#include "shared/groups.h"
#include "bodies/boat.glsl"
#include "wave/wave_faces.glsl"
#if NONLINEAR
#include "wave/shallow_column.glsl"
#endif

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = BOATS) uniform samplerBuffer boats;
layout(binding = HULL_FORCES) uniform samplerBuffer hull_forces;
#if NONLINEAR
layout(binding = ELEVATION) uniform isamplerBuffer elevation;
#endif
layout(std430, binding = FLOW) restrict buffer FaceFlow { StoredFlow flow[]; };

/// Water that a hull drives along, by its force over the density and the hull's area. [m^2/s^2]
vec2 drivenBy(BoatState b, vec4 force, vec2 place_m) {
  const vec2 d = acrossSides(place_m - b.centre_m.xz);
  const vec2 at_m = vec2(dot(d, forwardOf(b.heading)), dot(d, starboardOf(b.heading)));
  return -force.xz * force.w * hullShape(hullHalf(b), at_m);
}

#if NONLINEAR
float faceWater_m(int here, int there) {
  return 0.5 * (columnOf(here, texelFetch(elevation, here).x).water_m + columnOf(there, texelFetch(elevation, there).x).water_m);
}
#endif

void main() {
  const ivec2 n = waveCounts();
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const vec2 centre_m = waveCellCentre(cell);
  const float half_cell_m = 0.5 * sim.wave_cell_m;
  vec2 driven = vec2(0.0);  // x at the face toward +x, z at the face toward +z
  for (int place = 0; place < int(boat_place_count); ++place) {
    vec4 t[BOAT_TEXELS];
    for (int k = 0; k < BOAT_TEXELS; ++k) t[k] = texelFetch(boats, place * BOAT_TEXELS + k);
    const BoatState b = unpackBoat(t);
    if (b.age_s < 0.0 || !b.is_moved) continue;
    const vec4 force = texelFetch(hull_forces, place * HULL_FORCE_TEXELS + 4);
    driven.x += drivenBy(b, force, centre_m + vec2(half_cell_m, 0.0)).x;
    driven.y += drivenBy(b, force, centre_m + vec2(0.0, half_cell_m)).y;
  }
  if (driven == vec2(0.0)) return;
  driven *= sim.tick_s;
  const int i = cell.x + n.x * cell.y;
#if NONLINEAR
  const int i_x = wrapped(cell.x + 1, n.x) + n.x * cell.y;
  const int i_z = cell.x + n.x * wrapped(cell.y + 1, n.y);
  const vec2 water_m = vec2(faceWater_m(i, i_x), faceWater_m(i, i_z));
  vec2 gained_mps = vec2(water_m.x > 1e-3 ? driven.x / water_m.x : 0.0, water_m.y > 1e-3 ? driven.y / water_m.y : 0.0);
#if !WAVE_PERIODIC_X
  if (cell.x == n.x - 1) gained_mps.x = 0.0;
#endif
#if !WAVE_PERIODIC_Z
  if (cell.y == n.y - 1) gained_mps.y = 0.0;
#endif
  flow[i].xy += gained_mps;
#else
  const Flow open = sign(conductanceOf(cell, n));
  flow[i] += open * FLOW_WEIGHTS * asFlow(vec4(driven, driven.x + driven.y, driven.y - driven.x));
#endif
}
