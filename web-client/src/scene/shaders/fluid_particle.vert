// One point per particle, read from the 12 bytes of the wire as six u16; the last three hold velocity x | velocity y,
// velocity z | tint, foam | 0. The point's square covers the particle's ellipse on the screen.
// Points, not instanced quads: software renderers handle each instance like a draw call (measured: 3 times the processor time).
// A particle among others is drawn wider than it is, so that neighbours overlap. A single one is a drop, drawn smaller, because it
// stands for many, and stretched along its flight. Under the wave's surface (u_has_water) a particle is the wave's water and is not
// drawn; where many of them are white, their foam floats on the surface. TILES: the target's pixels are tiles of the screen. SHADOW: seen along
// the sunlight, at the position of the floor that it shades.
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
uniform sampler2D u_field;
uniform vec2 u_extent_m;  // length and width of the water
uniform bool u_has_water;

#include <fluid_sizes>
#ifdef SHADOW
uniform vec3 u_sun_direction;
uniform float u_floor_m;   // height of the floor
uniform float u_shaded_m;  // side of the square of floor that the target shows, around the origin
#endif

flat out float v_ahead_m;    // distance of the centre along the view's axis
flat out float v_radius_m;   // across the flight
flat out vec3 v_flight;      // unit direction on the screen, and length over width
flat out vec2 v_foam_bulk;   // white share; 1 among other particles, 0 alone
flat out float v_strength;   // share of its coverage

float signedByte(uint bits) { return float(int(bits << 24u) >> 24) / 127.0; }

void main() {
  uvec3 words = uvec3(a_packed * 65535.0 + 0.5);
  vec3 velocity = vec3(signedByte(words.x & 255u), signedByte(words.x >> 8u), signedByte(words.y & 255u)) * u_max_speed_mps;
  vec3 center = mix(u_min_m, u_max_m, position.xzy) + velocity * u_advance_s;
  float foam = smoothstep(0.1, 0.8, float(words.z & 255u) / 255.0);
  float bulk = smoothstep(kAloneTint, u_has_water ? kBulkTintOverWave : kBulkTint, float(words.y >> 8u) / 255.0);
  v_strength = 1.0;
  if (u_has_water) {
    float surface_m = texture(u_field, center.xz / u_extent_m + 0.5).r;
    float over = (center.y - surface_m) / u_radius_m;
    v_strength = smoothstep(0.5, 1.1, over);
    if (v_strength < 0.5) {
      foam *= smoothstep(-2.5, -0.5, over);
      v_strength = kAfloat * foam;
      center.y = surface_m - u_radius_m;
      bulk = 1.0;
    }
  }
#ifdef SHADOW
  v_ahead_m = 0.0;
  v_radius_m = u_radius_m * kBulkRadius;
  v_foam_bulk = vec2(foam, 1.0);
  v_flight = vec3(1.0, 0.0, 1.0);
  vec2 shaded = center.xz - u_sun_direction.xz / u_sun_direction.y * (center.y - u_floor_m);
  gl_Position = vec4(2.0 * shaded / u_shaded_m, 0.0, 1.0);
  gl_PointSize = 2.0 * v_radius_m * u_target_px.y / u_shaded_m;
  return;
#endif
  vec3 center_m = (viewMatrix * vec4(center, 1.0)).xyz;
  v_ahead_m = -center_m.z;
  v_radius_m = u_radius_m * mix(kDropRadius, kBulkRadius, bulk);
  v_foam_bulk = vec2(foam, bulk);
  if (v_strength < 0.05 || v_ahead_m < 1.5 * v_radius_m) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    gl_PointSize = 1.0;
    return;
  }
  vec2 flight = (mat3(viewMatrix) * velocity).xy;
  float speed_mps = length(flight);
  float stretch = 1.0 + (1.0 - bulk) * min(speed_mps * kExposureS / (2.0 * v_radius_m), kMostStretch);
  v_flight = vec3(speed_mps > 0.01 ? flight / speed_mps : vec2(1.0, 0.0), stretch);
  gl_Position = projectionMatrix * vec4(center_m, 1.0);
  gl_PointSize = stretch * v_radius_m * projectionMatrix[1][1] * u_target_px.y / v_ahead_m;
#ifdef TILES
  // Every tile that the square touches.
  gl_PointSize += 1.5;
#else
  // A distant drop must not be lost between pixels: it is larger and fainter instead.
  float shown = min(gl_PointSize / kLeastPx, 1.0);
  v_strength *= mix(shown * shown, 1.0, bulk);
  gl_PointSize = max(gl_PointSize, kLeastPx);
#endif
}
