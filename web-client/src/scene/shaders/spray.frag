// A drop as an ellipse along its flight, or mist, lit by sun and sky. Hidden behind solids. Drops of some pixels are clear, with the sun in
// them; smaller ones and mist are white, and bright against the sun.
#include <sky>

flat in float v_strength;
flat in vec4 v_flight;
flat in float v_toward_sun;
uniform vec2 u_target_px;
uniform sampler2D u_behind_depth;
layout(location = 0) out vec4 color;

// A drop this wide is seen as one, px.
const float kClearPx = 4.0;

void main() {
  vec2 at = vec2(gl_PointCoord.x, 1.0 - gl_PointCoord.y) * 2.0 - 1.0;
  vec2 in_drop = vec2(dot(at, v_flight.xy), dot(at, vec2(-v_flight.y, v_flight.x)) / v_flight.z);
  float away = dot(in_drop, in_drop);
  if (away > 1.0) discard;
  if (texture(u_behind_depth, gl_FragCoord.xy / u_target_px).r < gl_FragCoord.z) discard;
  float through = v_toward_sun * v_toward_sun;
  vec3 white = vec3(0.92, 0.96, 0.98) * (u_sun_light * (0.55 + 0.8 * through * through) + u_ambient_up);
  float cover = (1.0 - away) * (1.0 - away);
  if (v_flight.w > 0.0) {
    float clear = smoothstep(kClearPx, 2.0 * kClearPx, v_flight.w);
    vec2 to_glint = at - vec2(-0.3, 0.36);
    float glint = 1.0 - smoothstep(0.02, 0.1, dot(to_glint, to_glint));
    // The sky is seen in its rim, and upside down in its middle.
    float rim = smoothstep(0.35, 1.0, away);
    white = mix(white, u_ambient_up * (0.35 + 0.9 * rim + 0.5 * smoothstep(0.4, -0.8, at.y)) + 1.6 * u_sun_light * glint, clear);
    cover = mix(1.0 - away * away, (1.0 - smoothstep(0.8, 1.0, away)) * max(0.3 + 0.5 * rim, glint), clear);
  }
  color = vec4(toDisplay(white), v_strength * cover);
}
