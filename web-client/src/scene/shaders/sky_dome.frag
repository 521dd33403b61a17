#include <sky>

in vec3 v_direction;
layout(location = 0) out vec4 color;

void main() {
  vec3 direction = normalize(v_direction);
  float sun = smoothstep(0.99945, 0.99965, dot(direction, u_sun_direction));
  color = vec4(skyLight(direction) + kSunColor * 12.0 * sun, 1.0);
}
