// What the water of a tank takes from the light on the floor under it.
in vec3 position;
in float a_passed;  // share of the light that comes through
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
out float v_passed;

void main() {
  v_passed = a_passed;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
