// Marks the tiles of the screen that a particle's kernel touches: one point per particle, as large as its square. Over a wave only
// particles that raise its surface count.
#include <fluid_words>

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec2 u_target_px;
uniform float u_reach_m;
uniform sampler2D u_field;
uniform vec2 u_extent_m;  // length and width of the water
uniform bool u_has_water;

void main() {
  vec3 center_m = unpackParticle().center_m;
  gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  gl_PointSize = 1.0;
  if (u_has_water && center_m.y < texture(u_field, center_m.xz / u_extent_m + 0.5).r - 0.4 * u_radius_m) return;
  vec3 seen_m = (viewMatrix * vec4(center_m, 1.0)).xyz;
  if (-seen_m.z < 0.1 * u_reach_m) return;
  gl_Position = projectionMatrix * vec4(seen_m, 1.0);
  gl_PointSize = u_reach_m * projectionMatrix[1][1] * u_target_px.y / max(-seen_m.z, u_reach_m) + 1.5;
}
