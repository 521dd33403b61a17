// Solids projected along the light onto the still water, as a texture over the square: u along x, v along z.
in vec3 position;
#ifdef INSTANCES
#include <instance>
#endif
uniform mat4 modelMatrix;
uniform mat4 projectionMatrix;  // world, at y = 0 → the square
uniform vec3 u_sun_direction;

const float kLeastSine = 0.12;  // a lower sun would draw shadows across all the water

void main() {
#ifdef INSTANCES
  vec3 world = placed(position);
#else
  vec3 world = (modelMatrix * vec4(position, 1.0)).xyz;
#endif
  vec2 at = world.xz - u_sun_direction.xz / max(u_sun_direction.y, kLeastSine) * max(world.y, 0.0);
  gl_Position = projectionMatrix * vec4(at.x, 0.0, at.y, 1.0);
}
