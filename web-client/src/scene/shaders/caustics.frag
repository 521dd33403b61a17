// Sunlight per area where the triangle's light arrives, relative to level water: the triangle's area on the surface over its area here.
// Both are flat, so the derivatives give the ratio exactly; folded parts of the surface add up.
in vec2 v_from_m;
uniform vec2 u_layer;       // channel of the layer
uniform float u_texel_m;
layout(location = 0) out vec4 light;

// A triangle that is seen edge-on has no area; the sun's disc and the texel bound its brightness.
const float kMost = 8.0;

void main() {
  vec2 across = dFdx(v_from_m), along = dFdy(v_from_m);
  float ratio = abs(across.x * along.y - across.y * along.x) / (u_texel_m * u_texel_m);
  light = vec4(u_layer * min(ratio, kMost), 0.0, 1.0);
}
