// The floor of a tank.
in vec3 position;  // x, z over u_shaded_m
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform float u_floor_m;
uniform float u_shaded_m;
out vec2 v_uv;

void main() {
  v_uv = position.xz + 0.5;
  gl_Position = projectionMatrix * viewMatrix * vec4(position.x * u_shaded_m, u_floor_m, position.z * u_shaded_m, 1.0);
}
