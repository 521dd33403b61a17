// The elevation → a filterable field: elevation (m), slope along x, slope along z, curvature (1/m). Derivatives along one axis are
// smoothed along the other, so that quanta do not show as facets (field_kernels.ts).
// Reads u_elevation: elevations in units of u_unit_m.

uniform isampler2D u_elevation;
uniform float u_unit_m;
uniform float u_cell_m;
uniform vec2 u_cells_per_texel;  // >= 1; above 1 the neighbourhood below has wider steps
uniform vec2 u_periodic;  // along x and z: 1 or 0
// Weights of samples at distance 0, 1 and 2.
uniform vec3 u_smooth;
uniform vec3 u_slope;
uniform vec3 u_curvature;

layout(location = 0) out vec4 field;

float elevation(ivec2 cell, ivec2 n) {
  ivec2 wrapped = (cell + 16 * n) % n;
  ivec2 held = clamp(cell, ivec2(0), n - 1);
  cell = ivec2(u_periodic.x > 0.5 ? wrapped.x : held.x, u_periodic.y > 0.5 ? wrapped.y : held.y);
  return float(texelFetch(u_elevation, cell, 0).r);
}

float even(vec3 taps, float a, float b, float c, float d, float e) { return taps.x * c + taps.y * (b + d) + taps.z * (a + e); }
float odd(vec3 taps, float a, float b, float d, float e) { return taps.y * (d - b) + taps.z * (e - a); }

void main() {
  ivec2 n = textureSize(u_elevation, 0);
  ivec2 at = ivec2(gl_FragCoord.xy * u_cells_per_texel);
  int k = int(max(u_cells_per_texel.x, u_cells_per_texel.y) + 0.5);
  vec3 rows[5];  // along x: smoothed, slope, curvature
  for (int z = -2; z <= 2; ++z) {
    float a = elevation(at + k * ivec2(-2, z), n), b = elevation(at + k * ivec2(-1, z), n), c = elevation(at + k * ivec2(0, z), n);
    float d = elevation(at + k * ivec2(1, z), n), e = elevation(at + k * ivec2(2, z), n);
    rows[z + 2] = vec3(even(u_smooth, a, b, c, d, e), odd(u_slope, a, b, d, e), even(u_curvature, a, b, c, d, e));
  }
  float smoothed = even(u_smooth, rows[0].x, rows[1].x, rows[2].x, rows[3].x, rows[4].x);
  float slope_x = even(u_smooth, rows[0].y, rows[1].y, rows[2].y, rows[3].y, rows[4].y);
  float slope_z = odd(u_slope, rows[0].x, rows[1].x, rows[3].x, rows[4].x);
  float curvature = even(u_smooth, rows[0].z, rows[1].z, rows[2].z, rows[3].z, rows[4].z) +
                    even(u_curvature, rows[0].x, rows[1].x, rows[2].x, rows[3].x, rows[4].x);
  float step_m = float(k) * u_cell_m;
  field = u_unit_m * vec4(smoothed, slope_x / step_m, slope_z / step_m, curvature / (step_m * step_m));
}
