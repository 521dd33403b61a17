// Surface frames → the elevation at the time shown, in whole fractions of a quantum: R32I can be drawn to everywhere and keeps every
// bit, unlike half floats.
// Reads u_before, u_from, u_to, u_after: int16 elevations in quanta. Adds u_dents, the dents of one's own fingers (water/local_ripple.ts).

uniform isampler2D u_before;
uniform isampler2D u_from;
uniform isampler2D u_to;
uniform isampler2D u_after;
uniform int u_stride;    // frame samples per texel
uniform vec4 u_weights;  // of the frames, times quantum over unit of the result

const int kDentsMax = 16;
uniform int u_dent_count;
uniform vec4 u_dents[kDentsMax];  // x, z, radius, elevation in the middle [m]
uniform vec2 u_water_m;  // size of the water along x and z
uniform float u_unit_m;

layout(location = 0) out int elevation;

float dentsM(ivec2 at, ivec2 n) {
  vec2 here_m = ((vec2(at) + 0.5) / vec2(n) - 0.5) * u_water_m;
  float sum_m = 0.0;
  for (int k = 0; k < u_dent_count; ++k) {
    vec2 away = (here_m - u_dents[k].xy) / u_dents[k].z;
    float q2 = dot(away, away);
    if (q2 < 12.0) sum_m += u_dents[k].w * (1.0 - q2) * exp(-q2);
  }
  return sum_m;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) * u_stride + u_stride / 2;
  vec4 samples = vec4(texelFetch(u_before, at, 0).r, texelFetch(u_from, at, 0).r, texelFetch(u_to, at, 0).r, texelFetch(u_after, at, 0).r);
  float dents = u_dent_count > 0 ? dentsM(at, textureSize(u_from, 0)) / u_unit_m : 0.0;
  elevation = int(round(dot(samples, u_weights) + dents));
}
