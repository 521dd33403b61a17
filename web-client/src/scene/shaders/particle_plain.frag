// A sphere as a round patch: the normal follows from the position in the point's square, light and colour come from the vertex shader.
// A tenth of the work of particle.frag; with about ten fragments per pixel this matters on software renderers.

flat in vec3 v_sunlit;
flat in vec3 v_ambient_low;
flat in vec3 v_ambient_high;
flat in float v_radius_px;

uniform vec3 u_sun_view;
uniform vec3 u_up_view;
layout(location = 0) out vec4 color;

void main() {
  vec2 across = (gl_PointCoord * 2.0 - 1.0) * vec2(1.0, -1.0) * (1.0 + 1.0 / v_radius_px);
  float miss2 = dot(across, across);
  float covered = (1.0 - miss2) * 0.5 * v_radius_px + 0.5;
  if (covered <= 0.0) discard;
  vec3 normal = vec3(across, sqrt(max(1.0 - miss2, 0.0)));
  float sun = clamp(dot(normal, u_sun_view) * 0.6 + 0.4, 0.0, 1.0);
  color = vec4(v_sunlit * (sun * sun) + mix(v_ambient_low, v_ambient_high, dot(normal, u_up_view) * 0.5 + 0.5), min(covered, 1.0));
}
