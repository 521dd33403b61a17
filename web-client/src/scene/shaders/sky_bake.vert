in vec3 position;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
out vec3 v_direction;

void main() {
  v_direction = position;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
