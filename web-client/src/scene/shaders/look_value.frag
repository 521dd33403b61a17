// Surface frames → one value per sample: their elevations times weights. With the weights of the time shown it is the elevation [m],
// with their derivatives the vertical velocity [m/s].
// Reads u_before, u_from, u_to, u_after: int16 elevations in quanta.

uniform isampler2D u_before;
uniform isampler2D u_from;
uniform isampler2D u_to;
uniform isampler2D u_after;
uniform vec4 u_weights;  // of the frames, times their quanta
layout(location = 0) out float value;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 samples = vec4(texelFetch(u_before, at, 0).r, texelFetch(u_from, at, 0).r, texelFetch(u_to, at, 0).r, texelFetch(u_after, at, 0).r);
  value = dot(samples, u_weights);
}
