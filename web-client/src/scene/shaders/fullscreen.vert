// One triangle over the whole target, at the far plane.
in vec3 position;
out vec2 v_uv;

void main() {
  v_uv = position.xy * 0.5 + 0.5;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}
