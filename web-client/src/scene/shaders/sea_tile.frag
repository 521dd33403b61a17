// A sum of plane waves, each with a whole number of lengths per tile → elevation (m), slope along x, slope along z.
// Reads u_waves: lengths per tile along x and z, amplitude (m), phase in turns.
const int kMaxWaves = 64;

in vec2 v_uv;
uniform vec4 u_waves[kMaxWaves];
uniform int u_count;
uniform float u_tile_m;

layout(location = 0) out vec4 sea;

void main() {
  vec3 sum = vec3(0.0);
  for (int n = 0; n < u_count; ++n) {
    vec4 wave = u_waves[n];
    float angle = 6.2831853 * (fract(dot(wave.xy, v_uv)) - wave.w);
    sum += wave.z * vec3(cos(angle), -sin(angle) * wave.xy);
  }
  sea = vec4(sum.x, sum.yz * (6.2831853 / u_tile_m), 1.0);
}
