// Light of lamps, added to the picture as on a film: white stays white (the pass blends with 1 - colour).
in vec2 v_corner;
flat in vec4 v_color;
uniform sampler2D u_behind_depth;
uniform vec2 u_resolution;
uniform float u_darkness;
layout(location = 0) out vec4 color;

void main() {
  float light;
  if (v_color.a > 0.5) {
    if (texture(u_behind_depth, gl_FragCoord.xy / u_resolution).r < gl_FragCoord.z) discard;
    float across = 1.0 - v_corner.x * v_corner.x;
    float along = 0.5 - 0.5 * v_corner.y;
    light = across * across * along * along;
  } else {
    float inside = max(1.0 - dot(v_corner, v_corner), 0.0);
    float squared = inside * inside;
    // A core, and a wide halo.
    light = 0.3 * squared + 0.9 * squared * squared * squared * squared * squared * squared;
  }
  color = vec4(min(v_color.rgb * light * u_darkness, 1.0), 1.0);
}
