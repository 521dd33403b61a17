// The sky in the plain tiers: the light of the vertices, and the disc of the sun or the moon; without stars.
#include <sky>

in vec3 v_direction;
in vec3 v_light;
layout(location = 0) out vec4 color;

void main() {
  float toward_sun = dot(v_direction, u_sun_direction) * inversesqrt(dot(v_direction, v_direction));
  float disc = u_sun_sharp * smoothstep(0.99988, 0.99994, toward_sun);
  color = vec4(mix(v_light, u_sun_light, disc), 1.0);
}
