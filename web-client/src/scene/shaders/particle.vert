// One point a particle, straight from the 12 bytes of the wire: the buffer is read as six u16, the three last of which
// hold velocity x | velocity y, velocity z | tint, foam | 0. The point's square covers the sphere's silhouette.
// Points, not instanced quads: software renderers pay for every instance as for a draw call (measured: 3 times the processor time).
in vec3 position;  // x, z, y as fractions of the bounds
in vec3 a_packed;  // u16 / 65535

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec3 u_min_m;
uniform vec3 u_max_m;
uniform float u_max_speed_mps;
uniform float u_advance_s;
uniform float u_radius_m;
uniform vec2 u_resolution;
uniform sampler2D u_field;
uniform float u_side_m;
uniform bool u_has_water;

flat out vec3 v_center_m;
flat out vec2 v_tint_foam;
flat out float v_world_y_m;
flat out float v_above_m;  // centre over the water's surface; far over it in a scene without one

float signedByte(uint bits) { return float(int(bits << 24u) >> 24) / 127.0; }

void main() {
  uvec3 words = uvec3(a_packed * 65535.0 + 0.5);
  vec3 velocity = vec3(signedByte(words.x & 255u), signedByte(words.x >> 8u), signedByte(words.y & 255u)) * u_max_speed_mps;
  vec3 center = mix(u_min_m, u_max_m, position.xzy) + velocity * u_advance_s;
  v_tint_foam = vec2(float(words.y >> 8u), float(words.z & 255u)) / 255.0;
  v_world_y_m = center.y;
  v_above_m = u_has_water ? center.y - texture(u_field, center.xz / u_side_m + 0.5).r : 1e3;
  v_center_m = (viewMatrix * vec4(center, 1.0)).xyz;

  float distance_m = length(v_center_m);
  float ahead_m = -v_center_m.z;
  if (ahead_m < 1.5 * u_radius_m) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    gl_PointSize = 1.0;
    return;
  }
  gl_Position = projectionMatrix * vec4(v_center_m, 1.0);
  // Off the axis a sphere's silhouette is longer than wide: tan(off + half) - tan(off), the far end of it.
  float off = length(v_center_m.xy) / ahead_m;
  float half_width = u_radius_m / sqrt(distance_m * distance_m - u_radius_m * u_radius_m);
  float reach = half_width * (1.0 + off * off) / max(1.0 - off * half_width, 0.1);
  gl_PointSize = reach * projectionMatrix[1][1] * u_resolution.y + 2.0;
}
