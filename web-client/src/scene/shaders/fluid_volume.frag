// A particle's share of the density in a cell, over that of the lattice at rest. Blending adds them up.
// WALLS: beside a wall the kernel is cut, and its rest counts for more.
#include <fluid_volume>

uniform float u_reach_m;
uniform float u_at_rest;    // sum of the kernel over the lattice at rest
flat in vec3 v_center;
flat in vec3 v_slice;
flat in vec2 v_foam_stirred;
layout(location = 0) out vec4 density;

// Share of a kernel that lies on this side of a wall at a distance in its radii: the integral of (1 - t^2)^4 within 2 %.
float uncut(float away) { float left = clamp(1.0 - away, 0.0, 1.0); return 1.0 - 0.5 * left * left * left; }

void main() {
  vec2 cell = gl_FragCoord.xy - v_slice.xy;
  if (any(lessThan(cell, vec2(0.0))) || any(greaterThan(cell, u_cells_count.xz))) discard;
  vec3 at = vec3(cell.x, v_slice.z, cell.y);
  vec3 away = (at - v_center) * (u_cell_m / u_reach_m);
  float left = 1.0 - dot(away, away);
  if (left <= 0.0) discard;
  float weight = left * left * left / u_at_rest;
#ifdef WALLS
  vec3 at_m = at * u_cell_m, size_m = u_volume_max_m - u_volume_min_m;
  weight /= uncut(at_m.x / u_reach_m) * uncut((size_m.x - at_m.x) / u_reach_m) * uncut(at_m.y / u_reach_m) * uncut(at_m.z / u_reach_m) * uncut((size_m.z - at_m.z) / u_reach_m);
#endif
  density = vec4(weight, weight * v_foam_stirred, 0.0);
}
