// Surface: a unit grid lifted by the field. Skirt (SKIRT): the four sides, top edge lifted, bottom edge on the floor.

in vec3 position;  // x, z in -1/2..1/2; y: 1 on the surface, 0 on the floor
#ifdef SKIRT
in vec3 normal;
out vec3 v_side_normal;
#endif

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform sampler2D u_field;
uniform float u_side_m;
uniform float u_depth_m;

out vec3 v_world;
out float v_view_z;
out float v_top_m;

void main() {
  v_top_m = texture(u_field, position.xz + 0.5).r;
  v_world = vec3(position.x * u_side_m, mix(-u_depth_m, v_top_m, position.y), position.z * u_side_m);
#ifdef SKIRT
  v_side_normal = normal;
#endif
  vec4 view = viewMatrix * vec4(v_world, 1.0);
  v_view_z = view.z;
  gl_Position = projectionMatrix * view;
}
