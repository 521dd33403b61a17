// One point per particle and slice of the volume: the square of cells around the particle in that slice.
#include <fluid_words>
#include <fluid_volume>

uniform float u_reach_m;    // radius of a particle's kernel
uniform float u_slice;      // of those around a particle
uniform vec2 u_target_px;
uniform sampler2D u_field;
uniform vec2 u_extent_m;    // length and width of the water
uniform bool u_has_water;

flat out vec3 v_center;     // cells
flat out vec3 v_slice;      // its first texel, its height in cells
flat out vec2 v_foam_stirred;

// Speeds between which water becomes stirred, m/s.
const vec2 kStirredMps = vec2(0.3, 2.0);

void main() {
  Particle particle = unpackParticle();
  v_center = (particle.center_m - u_volume_min_m) / u_cell_m;
  v_foam_stirred = vec2(smoothstep(0.45, 1.0, particle.foam), smoothstep(kStirredMps.x, kStirredMps.y, length(particle.velocity_mps)));
  float slice = floor(v_center.y - u_reach_m / u_cell_m + 0.5) + u_slice;
  gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  gl_PointSize = 1.0;
  if (slice < 0.0 || slice >= u_cells_count.y) return;
  // Deep in the wave nothing of it is drawn.
  if (u_has_water && particle.center_m.y < texture(u_field, particle.center_m.xz / u_extent_m + 0.5).r - u_reach_m) return;
  v_slice = vec3(sliceOrigin(slice), slice + 0.5);
  vec2 at = v_slice.xy + clamp(v_center.xz, vec2(0.0), u_cells_count.xz);
  gl_Position = vec4(at / u_target_px * 2.0 - 1.0, 0.0, 1.0);
  gl_PointSize = 2.0 * u_reach_m / u_cell_m + 1.0;
}
