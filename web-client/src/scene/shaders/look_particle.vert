// One point per particle, read from the 12 bytes of the wire as in fluid_particle.vert; its square covers the particle's sphere.
// OF_SPEED: v_value is the speed [m/s]; OF_DENSITY: density over rest density; neither: 1 white to 0 coloured, by density and foam.
in vec3 position;  // x, z, y as fractions of the bounds
in vec3 a_packed;  // u16 / 65535

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec3 u_min_m;
uniform vec3 u_max_m;
uniform float u_max_speed_mps;
uniform float u_advance_s;
uniform float u_radius_m;
uniform vec2 u_target_px;

flat out float v_ahead_m;  // distance of the centre along the view's axis
flat out float v_value;

float signedByte(uint bits) { return float(int(bits << 24u) >> 24) / 127.0; }

void main() {
  uvec3 words = uvec3(a_packed * 65535.0 + 0.5);
  vec3 velocity = vec3(signedByte(words.x & 255u), signedByte(words.x >> 8u), signedByte(words.y & 255u)) * u_max_speed_mps;
  float density = 0.5 + 0.6 * float(words.y >> 8u) / 255.0;
#if defined(OF_SPEED)
  v_value = length(velocity);
#elif defined(OF_DENSITY)
  v_value = density;
#else
  v_value = max(smoothstep(0.95, 0.65, density), float(words.z & 255u) / 255.0);
#endif
  vec3 center_m = (viewMatrix * vec4(mix(u_min_m, u_max_m, position.xzy) + velocity * u_advance_s, 1.0)).xyz;
  v_ahead_m = -center_m.z;
  if (v_ahead_m < 1.5 * u_radius_m) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    gl_PointSize = 1.0;
    return;
  }
  gl_Position = projectionMatrix * vec4(center_m, 1.0);
  gl_PointSize = max(u_radius_m * projectionMatrix[1][1] * u_target_px.y / v_ahead_m, 2.0);
}
