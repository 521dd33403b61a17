// A streak of rain: it shows the light of the whole sky. Hidden behind solids.
#include <sky>

in float v_strength;
uniform vec2 u_target_px;
uniform sampler2D u_behind_depth;
layout(location = 0) out vec4 color;

void main() {
  if (texture(u_behind_depth, gl_FragCoord.xy / u_target_px).r < gl_FragCoord.z) discard;
  color = vec4(toDisplay(1.5 * u_ambient_up + 0.15 * u_sun_light), 0.24 * v_strength);
}
