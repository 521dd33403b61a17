// The scene without water, from linear light to the display.
#include <sky>

in vec2 v_uv;
uniform sampler2D u_behind;
layout(location = 0) out vec4 color;

void main() { color = vec4(toDisplay(texture(u_behind, v_uv).rgb), 1.0); }
