// A patch of foam from above: strongest in its middle.
flat in float v_strength;
layout(location = 0) out vec4 froth;

void main() {
  vec2 at = gl_PointCoord * 2.0 - 1.0;
  float away = dot(at, at);
  if (away > 1.0) discard;
  froth = vec4(v_strength * (1.0 - away) * (1.0 - away), 0.0, 0.0, 1.0);
}
