// A drop: an ellipse along its flight, bright in its middle. A large drop is a lens, which shows the bright sky below and what is dark above.
// Or a puff of spray. Hidden behind solids.
flat in vec3 v_flight;
flat in vec4 v_light;
flat in float v_round;
flat in vec4 v_puff;
uniform vec2 u_target_px;
uniform sampler2D u_behind_depth;
#include <puff>
layout(location = 0) out vec4 color;

void main() {
  vec2 at = vec2(gl_PointCoord.x, 1.0 - gl_PointCoord.y) * 2.0 - 1.0;
  float left = 1.0 - dot(at, at);
  if (v_flight.z < 1.0) {
    vec2 in_drop = vec2(dot(at, v_flight.xy), dot(at, vec2(-v_flight.y, v_flight.x)) / v_flight.z);
    left = 1.0 - dot(in_drop, in_drop);
  }
  if (left <= 0.0 || texture(u_behind_depth, gl_FragCoord.xy / u_target_px).r < gl_FragCoord.z) discard;
  if (v_puff.x >= 0.0) {
    color = vec4(v_light.rgb, v_light.a * puffAt(at, v_flight.xy, v_puff));
    return;
  }
  vec2 to_glint = at - vec2(-0.25, 0.4);
  float solid = mix(0.9, 0.6, left) * smoothstep(0.0, 0.4, left);
  float lens = 0.9 - 0.3 * at.y * dot(at, at) + 0.6 * smoothstep(0.12, 0.0, dot(to_glint, to_glint));
  color = vec4(v_light.rgb * mix(1.0, lens, v_round), v_light.a * mix(left * left, solid, v_round));
}
