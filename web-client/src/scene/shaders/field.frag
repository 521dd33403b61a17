// Two surface frames → one filterable field: elevation (m), slope along x, slope along z, curvature (1/m).
// Reads u_from, u_to: int16 elevations in quanta. Slopes over a 3x3 neighbourhood, so that quanta do not show as facets.

uniform isampler2D u_from;
uniform isampler2D u_to;
uniform vec2 u_quantum_m;
uniform float u_mix;
uniform float u_cell_m;
uniform float u_cells_per_texel;  // >= 1; above 1 the neighbourhood below has wider steps
uniform vec2 u_periodic;  // along x and z: 1 or 0

layout(location = 0) out vec4 field;

float elevation(ivec2 cell, int n) {
  ivec2 wrapped = cell + n * (ivec2(lessThan(cell, ivec2(0))) - ivec2(greaterThanEqual(cell, ivec2(n))));
  ivec2 held = clamp(cell, ivec2(0), ivec2(n - 1));
  cell = ivec2(u_periodic.x > 0.5 ? wrapped.x : held.x, u_periodic.y > 0.5 ? wrapped.y : held.y);
  float from = float(texelFetch(u_from, cell, 0).r) * u_quantum_m.x;
  float to = float(texelFetch(u_to, cell, 0).r) * u_quantum_m.y;
  return mix(from, to, u_mix);
}

void main() {
  int n = textureSize(u_from, 0).x;
  ivec2 at = ivec2(gl_FragCoord.xy * u_cells_per_texel);
  int k = int(u_cells_per_texel + 0.5);
  float step_m = float(k) * u_cell_m;
  float a = elevation(at + k * ivec2(-1, -1), n), b = elevation(at + k * ivec2(0, -1), n), c = elevation(at + k * ivec2(1, -1), n);
  float d = elevation(at + k * ivec2(-1, 0), n), e = elevation(at, n), f = elevation(at + k * ivec2(1, 0), n);
  float g = elevation(at + k * ivec2(-1, 1), n), h = elevation(at + k * ivec2(0, 1), n), i = elevation(at + k * ivec2(1, 1), n);
  float slope_x = (c + 2.0 * f + i - a - 2.0 * d - g) / (8.0 * step_m);
  float slope_z = (g + 2.0 * h + i - a - 2.0 * b - c) / (8.0 * step_m);
  float curvature = (0.5 * (a + c + g + i) + b + d + f + h - 6.0 * e) / (2.0 * step_m * step_m);
  float smoothed = (4.0 * e + 2.0 * (b + d + f + h) + a + c + g + i) / 16.0;
  field = vec4(smoothed, slope_x, slope_z, curvature);
}
