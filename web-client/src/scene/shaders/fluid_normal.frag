// The normal of the smoothed surface, in view space. A plane n . p = c seen along p = (x, y, -1) / w has w = n . (x, y, -1) / c, so the
// slope of w over x and y gives n without a division by the distance.
// Reads u_front: w = 1 / distance [1/m], foam. Writes the normal and the foam; all 0 where there is no fluid, so that a filtered
// sample at an edge is the mean of the fluid's texels.

uniform sampler2D u_front;
uniform vec4 u_ray;  // (x, y) = ndc * u_ray.xy + u_ray.zw
layout(location = 0) out vec4 normal_foam;

// Slope between two neighbours, from the side that is closer; the other may be another surface.
float slope(float before, float middle, float after) {
  float a = middle - before, b = after - middle;
  if (before <= 0.0) return after <= 0.0 ? 0.0 : b;
  if (after <= 0.0) return a;
  return abs(a) < 0.4 * abs(b) ? a : abs(b) < 0.4 * abs(a) ? b : 0.5 * (a + b);
}

float frontAt(ivec2 at) { return texelFetch(u_front, clamp(at, ivec2(0), textureSize(u_front, 0) - 1), 0).r; }

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 middle = texelFetch(u_front, at, 0).rg;
  normal_foam = vec4(0.0);
  if (middle.r <= 0.0) return;
  vec2 size_px = vec2(textureSize(u_front, 0));
  vec2 ray = (gl_FragCoord.xy / size_px * 2.0 - 1.0) * u_ray.xy + u_ray.zw;
  vec2 per_ray = size_px / (2.0 * u_ray.xy);
  vec2 slopes = per_ray * vec2(slope(frontAt(at - ivec2(1, 0)), middle.r, frontAt(at + ivec2(1, 0))),
                               slope(frontAt(at - ivec2(0, 1)), middle.r, frontAt(at + ivec2(0, 1))));
  normal_foam = vec4(normalize(vec3(-slopes, middle.r + dot(ray, slopes))), middle.g);
}
