// Boats, rocks, walls and the bed: coloured triangles.
in vec3 position;
in vec3 normal;
in vec4 color;  // rgb, and the material's grain (0 paint, 1 stone, -1 lamp)
uniform mat4 modelMatrix;
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
out vec3 v_world;
out vec3 v_normal;
out vec4 v_color;

void main() {
  v_world = (modelMatrix * vec4(position, 1.0)).xyz;
  v_normal = mat3(modelMatrix) * normal;
  v_color = color;
  gl_Position = projectionMatrix * viewMatrix * vec4(v_world, 1.0);
}
