// The far plane, with the view direction of each corner.
in vec3 position;
uniform mat4 u_inverse_projection;
uniform mat4 u_camera_world;
out vec3 v_direction;

void main() {
  vec4 corner = u_inverse_projection * vec4(position.xy, 1.0, 1.0);
  v_direction = mat3(u_camera_world) * (corner.xyz / corner.w);
  gl_Position = vec4(position.xy, 1.0, 1.0);
}
