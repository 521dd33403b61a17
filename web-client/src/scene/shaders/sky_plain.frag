// The sky in the plain tiers: the light of the vertices, and the disc of the sun or the moon; without stars.
#include <sky>

in vec3 v_direction;
in vec3 v_light;
layout(location = 0) out vec4 color;

// Brightness of the disc over the light that it gives: almost white.
const float kSunDisc = 8.0;

void main() {
  float toward_sun = dot(v_direction, u_sun_direction) * inversesqrt(dot(v_direction, v_direction));
  float disc = u_sun_sharp * smoothstep(0.99988, 0.99994, toward_sun);
  vec3 sun = kSunDisc * u_sun_light;
  color = vec4(disc > 0.0 ? mix(v_light, u_is_displayed ? toDisplay(sun) : sun, disc) : v_light, 1.0);
}
