// A drop as a soft ellipse along its flight, or mist: white, lit by sun and sky. Hidden behind solids.
#include <sky>

flat in float v_strength;
flat in vec3 v_flight;
uniform vec2 u_target_px;
uniform sampler2D u_behind_depth;
layout(location = 0) out vec4 color;

void main() {
  vec2 at = vec2(gl_PointCoord.x, 1.0 - gl_PointCoord.y) * 2.0 - 1.0;
  float along = dot(at, v_flight.xy);
  float across = dot(at, vec2(-v_flight.y, v_flight.x)) / v_flight.z;
  float away = along * along + across * across;
  if (away > 1.0) discard;
  if (texture(u_behind_depth, gl_FragCoord.xy / u_target_px).r < gl_FragCoord.z) discard;
  float soft = (1.0 - away) * (1.0 - away);
  vec3 white = vec3(0.95, 0.97, 0.98) * (u_sun_light * 0.8 + u_ambient_up * vec3(1.05, 0.96, 0.86));
  color = vec4(toDisplay(white), v_strength * soft);
}
