// A round drop, brighter toward its upper side.
in vec4 v_light;
layout(location = 0) out vec4 color;

void main() {
  vec2 at = gl_PointCoord * 2.0 - 1.0;
  color = vec4(v_light.rgb * (0.9 - 0.25 * at.y), v_light.a * clamp(1.4 - 1.4 * dot(at, at), 0.0, 1.0));
}
