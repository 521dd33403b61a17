// A bubble below the surface: pale, brighter above.
#include <sky>

flat in float v_strength;
flat in vec3 v_flight;
layout(location = 0) out vec4 color;

void main() {
  vec2 at = gl_PointCoord * 2.0 - 1.0;
  if (dot(at, at) > 1.0) discard;
  color = vec4((kSunColor * 0.5 + vec3(0.35, 0.42, 0.48)) * (0.9 - 0.25 * at.y) * v_strength, 1.0);
}
