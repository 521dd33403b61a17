// Surface frames → the elevation at the time shown, in whole fractions of a quantum: R32I can be drawn to everywhere and keeps every
// bit, unlike half floats.
// Reads u_before, u_from, u_to, u_after: int16 elevations in quanta.

uniform isampler2D u_before;
uniform isampler2D u_from;
uniform isampler2D u_to;
uniform isampler2D u_after;
uniform vec4 u_weights;  // of the frames, times quantum over unit of the result

layout(location = 0) out int elevation;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 samples = vec4(texelFetch(u_before, at, 0).r, texelFetch(u_from, at, 0).r, texelFetch(u_to, at, 0).r, texelFetch(u_after, at, 0).r);
  elevation = int(round(dot(samples, u_weights)));
}
