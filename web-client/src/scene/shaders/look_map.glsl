// Include: the colour of a value. Colours are those of the bar on the page, without light or tone mapping.
uniform sampler2D u_map;
uniform vec2 u_range;  // lowest value, 1 / (highest - lowest)

vec3 mapped(float value) {
  float share = clamp((value - u_range.x) * u_range.y, 0.0, 1.0);
  return textureLod(u_map, vec2((share * 255.0 + 0.5) / 256.0, 0.5), 0.0).rgb;
}
