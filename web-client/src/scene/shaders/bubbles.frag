// A bubble below the surface: pale, brighter above.
#include <sky>

layout(location = 0) out vec4 color;

void main() {
  vec2 at = gl_PointCoord * 2.0 - 1.0;
  if (dot(at, at) > 1.0) discard;
  color = vec4((u_sun_light * 0.5 + u_ambient_up * vec3(0.92, 0.9, 0.83)) * (0.9 - 0.25 * at.y), 1.0);
}
