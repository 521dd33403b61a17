// Adds this substep's share of the active effects to the two newest levels, before they evolve.
// Reads EventUniforms. Adds to ELEVATION and ELEVATION_PREVIOUS [n x n, m].
// A splash adds the same to both levels: displacement without speed. A crest adds f(s - ct) now and f(s - c(t - dt)) one
// substep ago: the d'Alembert solution that travels one way (PHYSICS: breaking wave, thesis 3.6.4).
// Invariant: the sum over the domain does not change (splash: to the tail outside the domain; crest: mean subtracted).
// variants: WAVE_PERIODIC=1 | WAVE_PERIODIC=0
#include "shared/event_uniforms.h"
#include "shared/groups.h"
#include "include/event_shapes.glsl"
#include "include/wave_cell.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(std430, binding = ELEVATION) restrict buffer Elevation { float elevation[]; };
layout(std430, binding = ELEVATION_PREVIOUS) restrict buffer ElevationPrevious { float elevation_previous[]; };

/// Shortest way along a periodic axis; the plain difference otherwise.
float acrossSides(float d_m) {
#if WAVE_PERIODIC
  return d_m - sim.wave_side_m * round(d_m / sim.wave_side_m);
#else
  return d_m;
#endif
}

void main() {
  const int n = int(sim.wave_n);
  const ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (cell.x >= n || cell.y >= n) return;
  const vec2 p = waveCellCentre(cell);
  float now_m = 0.0;
  float before_m = 0.0;
  for (uint k = 0u; k < event_count; ++k) {
    const EventUniform e = events[k];
    if (e.kind == EVENT_SPLASH) {
      const float d_m = e.gain_m * splashShape(vec2(acrossSides(p.x - e.x_m), acrossSides(p.y - e.z_m)), e.radius_m);
      now_m += d_m;
      before_m += d_m;
    } else {
      const float s_m = dot(p, vec2(e.x_m, e.z_m)) - e.offset_m;
      now_m += e.gain_m * (crestShape(acrossSides(s_m), e.radius_m) - e.mean_ratio);
      before_m += e.gain_m * (crestShape(acrossSides(s_m + e.step_m), e.radius_m) - e.mean_ratio);
    }
  }
  const int i = cell.x + n * cell.y;
  elevation[i] += now_m;
  elevation_previous[i] += before_m;
}
