// One axis of a filter that smooths one surface and keeps the edges between surfaces, after the narrow-range filter (Truong and Yuksel,
// "A narrow-range filter for screen-space fluid rendering", 2018): a Gaussian over pairs of samples on both sides of the pixel. A pair
// counts if its mean lies within a range of the pixel's own value; both are left out otherwise, so that one of them does not tilt the
// surface. The mean, unlike each sample, lies near on steep planes as well, which water seen at a low angle is.
// Reads u_front: 1 / distance [1/m], foam; 0 where there is no fluid. Writes the same, smoothed.
// The filter works on 1 / distance, so that it leaves planes as they are. SAMPLES: on each side.

uniform sampler2D u_front;
uniform vec2 u_axis;        // (1, 0) or (0, 1)
uniform float u_reach_m;    // half the filter's length in the water
uniform float u_range_m;    // farthest from the pixel that a pair's mean may lie
uniform float u_px_per_m;   // pixels of the target per metre at distance 1 m
layout(location = 0) out vec2 front;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 middle = texelFetch(u_front, at, 0).rg;
  front = middle;
  if (middle.r <= 0.0) return;
  float reach_px = min(u_reach_m * u_px_per_m * middle.r, 64.0);
  float stride_px = max(reach_px / float(SAMPLES), 1.0);
  float range = u_range_m * middle.r * middle.r;
  vec3 sum = vec3(middle, 1.0);
  ivec2 last = textureSize(u_front, 0) - 1;
  for (int i = 1; i <= SAMPLES; ++i) {
    float away_px = float(i) * stride_px;
    if (away_px > reach_px + 0.5) break;
    ivec2 shift = ivec2(u_axis * away_px + 0.5);
    vec2 a = texelFetch(u_front, clamp(at + shift, ivec2(0), last), 0).rg;
    vec2 b = texelFetch(u_front, clamp(at - shift, ivec2(0), last), 0).rg;
    if (min(a.r, b.r) <= 0.0 || abs(0.5 * (a.r + b.r) - middle.r) > range) continue;
    float share = away_px / reach_px;
    float weight = exp(-2.0 * share * share);
    sum += weight * vec3(a + b, 2.0);
  }
  front = sum.xy / sum.z;
}
