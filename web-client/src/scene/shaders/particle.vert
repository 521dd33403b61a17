// One quad a particle, straight from the 12 bytes of the wire: the buffer is read as six u16, the three last of which
// hold velocity x | velocity y, velocity z | tint, foam | 0. The quad covers the sphere's silhouette in perspective.

in vec3 position;
in vec3 a_place;   // x, z, y as fractions of the bounds
in vec3 a_packed;  // u16 / 65535

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec3 u_min_m;
uniform vec3 u_max_m;
uniform float u_max_speed_mps;
uniform float u_advance_s;
uniform float u_radius_m;

out vec3 v_view_m;
flat out vec3 v_center_m;
flat out vec2 v_tint_foam;
flat out float v_world_y_m;

float signedByte(uint bits) { return float(int(bits << 24u) >> 24) / 127.0; }

void main() {
  uvec3 words = uvec3(a_packed * 65535.0 + 0.5);
  vec3 velocity = vec3(signedByte(words.x & 255u), signedByte(words.x >> 8u), signedByte(words.y & 255u)) * u_max_speed_mps;
  vec3 center = mix(u_min_m, u_max_m, a_place.xzy) + velocity * u_advance_s;
  v_tint_foam = vec2(float(words.y >> 8u), float(words.z & 255u)) / 255.0;
  v_world_y_m = center.y;
  v_center_m = (viewMatrix * vec4(center, 1.0)).xyz;

  float distance_m = length(v_center_m);
  vec3 ahead = v_center_m / max(distance_m, 1e-5);
  vec3 right = normalize(cross(ahead, vec3(0.0, 1.0, 0.0)));
  vec3 up = cross(right, ahead);
  float reach_m = u_radius_m * distance_m / sqrt(max(distance_m * distance_m - u_radius_m * u_radius_m, 1e-6));
  v_view_m = v_center_m + (right * position.x + up * position.y) * reach_m;
  gl_Position = distance_m > 1.5 * u_radius_m ? projectionMatrix * vec4(v_view_m, 1.0) : vec4(0.0, 0.0, 2.0, 1.0);
}
