// Drops of a tank's particles that are outside of the mesh (fluid/plain_surface.ts).
in vec3 position;
in vec2 a_radius_white;  // m; white share
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform float u_height_px;
uniform vec3 u_displayed_sky[3];  // zenith, middle, horizon
uniform vec3 u_displayed_foam;
out vec4 v_light;

void main() {
  vec4 seen_m = viewMatrix * vec4(position, 1.0);
  float width_px = a_radius_white.x * projectionMatrix[1][1] * u_height_px / -seen_m.z;
  gl_Position = projectionMatrix * seen_m;
  gl_PointSize = max(width_px, 1.5);
  // What is thinner than a pixel covers a part of it.
  v_light = vec4(mix(u_displayed_sky[1], u_displayed_foam, 0.5 + 0.5 * a_radius_white.y), 0.85 * min(width_px / 1.5, 1.0));
}
