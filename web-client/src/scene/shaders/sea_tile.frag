// A sum of plane waves, each with a whole number of lengths per tile → elevation (m), slope along x, slope along z.
// Reads u_waves: lengths per tile along x and z, amplitude (m), phase in turns.
// Water moves toward the crests, u_chop times as far as in waves of Gerstner (1809): crests become sharp and troughs wide.
const int kMaxWaves = 64;

in vec2 v_uv;
uniform vec4 u_waves[kMaxWaves];
uniform int u_count;
uniform float u_tile_m;
uniform float u_chop;

layout(location = 0) out vec4 sea;

float angleAt(vec2 at, vec4 wave) { return 6.2831853 * (fract(dot(wave.xy, at)) - wave.w); }

void main() {
  // Where the water came from.
  vec2 from = v_uv;
  if (u_chop > 0.0) {
    vec2 moved_m = vec2(0.0);
    for (int n = 0; n < u_count; ++n) moved_m += u_waves[n].z * sin(angleAt(v_uv, u_waves[n])) * normalize(u_waves[n].xy);
    from += u_chop / u_tile_m * moved_m;
  }
  vec3 sum = vec3(0.0);
  for (int n = 0; n < u_count; ++n) {
    float angle = angleAt(from, u_waves[n]);
    sum += u_waves[n].z * vec3(cos(angle), -sin(angle) * u_waves[n].xy);
  }
  sea = vec4(sum.x, sum.yz * (6.2831853 / u_tile_m), 1.0);
}
