// The liquid's picture, which is smaller than the canvas, with its depth.
in vec2 v_uv;
uniform sampler2D u_liquid;
uniform sampler2D u_depth;
layout(location = 0) out vec4 color;

void main() {
  color = texture(u_liquid, v_uv);
  if (color.a < 0.01) discard;
  gl_FragDepth = texture(u_depth, v_uv).r;
}
