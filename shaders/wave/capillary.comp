// Surface tension of the wave: the level that pulls its water, as the dispersion reads it.
// Reads ELEVATION [nx x nz, units], BASIN if VARIED. Writes TENSE_LEVEL [nx x nz, units]: the elevation and, as a height of water, the
// pressure of the curved surface.
// Equation: head = -l^2 lap(eta), l^2 = sigma / (rho g), linear in the slope (Lamb 1932, section 266), by the 5-point stencil over open
// faces: water meets walls at a right angle. With the dispersion's F: omega^2 = (g k + sigma k^3 / rho) tanh(k d).
// Invariants: 1 - l^2 lap is symmetric and positive, so that the waves keep an energy; a level surface has no head, to the unit.
#include "shared/groups.h"
#include "wave/wave_faces.glsl"
#include "shared/fixed_point.h"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(binding = ELEVATION) uniform isamplerBuffer elevation;
layout(std430, binding = TENSE_LEVEL) restrict writeonly buffer TenseLevel { int tense_level[]; };

void main() {
  const ivec2 n = waveCounts();
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, n))) return;
  const ivec2 before = ivec2(wrapped(cell.x - 1, n.x), wrapped(cell.y - 1, n.y));
  const ivec2 after = ivec2(wrapped(cell.x + 1, n.x), wrapped(cell.y + 1, n.y));
  const vec4 conductance_m = vec4(conductanceOf(cell, n), conductanceOf(ivec2(before.x, cell.y), n).x, conductanceOf(ivec2(cell.x, before.y), n).y);
  const int own = texelFetch(elevation, cell.x + n.x * cell.y).x;
  const ivec4 there = ivec4(texelFetch(elevation, after.x + n.x * cell.y).x, texelFetch(elevation, cell.x + n.x * after.y).x,
                            texelFetch(elevation, before.x + n.x * cell.y).x, texelFetch(elevation, cell.x + n.x * before.y).x);
  const float above = dot(vec4(own) - vec4(there), vec4(greaterThan(conductance_m, vec4(0.0))));
  const float head = clamp(sim.capillary_ratio * above, -float(ELEVATION_MAX_UNITS), float(ELEVATION_MAX_UNITS));
  tense_level[cell.x + n.x * cell.y] = own + int(round(head));
}
