#include <sky>

in vec3 v_direction;
uniform bool u_has_disc;
uniform float u_lowest;  // the sky is hidden below directions of this height
layout(location = 0) out vec4 color;

void main() {
  vec3 direction = normalize(v_direction);
  color = vec4(0.0, 0.0, 0.0, 1.0);
  if (direction.y < u_lowest) return;
  float sun = u_has_disc ? 12.0 * u_sun_sharp : 0.0;
  sun *= smoothstep(0.99988, 0.99994, dot(direction, u_sun_direction));
  color = vec4(skyLight(direction) + u_sun_light * sun, 1.0);
}
