// The far plane as a grid, with the baked sky at its corners: it changes slowly, and a cube map is slow to read.
#include <sky>
in vec3 position;
uniform mat4 u_inverse_projection;
uniform mat4 u_camera_world;
out vec3 v_direction;
out vec3 v_light;  // linear, or for the display

void main() {
  vec4 corner = u_inverse_projection * vec4(position.xy, 1.0, 1.0);
  v_direction = mat3(u_camera_world) * (corner.xyz / corner.w);
  vec3 light = textureLod(u_sky, v_direction, 0.0).rgb;
  v_light = u_is_displayed ? toDisplay(light) : light;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}
