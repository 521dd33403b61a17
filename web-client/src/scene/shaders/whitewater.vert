// One point per drop, patch of foam or bubble (whitewater/diffuse_particles.ts). Draws those of one kind:
// SPRAY: drops, stretched along their flight, and mist. BUBBLES: below the surface. FROTH: foam, seen from above.
in vec4 position;  // position (m), kind + share of its life that has passed
in vec4 a_motion;  // velocity (m/s), radius (m)

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;

flat out float v_strength;
#ifdef FROTH
uniform vec2 u_extent_m;  // length and width of the water
uniform float u_target_px;
const int kKind = 1;
#else
uniform vec2 u_target_px;
flat out vec4 v_flight;  // unit direction on the screen, width over length, and width (px; 0: mist)
#ifdef SPRAY
uniform vec3 u_sun_direction;
flat out float v_toward_sun;  // of the eye's ray
const int kKind = 0;
#else
const int kKind = 2;
#endif
#endif

const float kMistRadiusM = 0.05;  // larger drops are puffs of mist
const float kExposureS = 0.012;   // drops are drawn as long as they fly in this time
const float kLeastPx = 1.5;
const float kMostShare = 0.0025;   // drops near the eye are not larger than this share of their distance: they would be flakes

float hash(uint n) {
  n = (n ^ 61u) ^ (n >> 16u);
  n *= 9u;
  n ^= n >> 4u;
  n *= 0x27d4eb2du;
  return float((n ^ (n >> 15u)) & 65535u) / 65535.0;
}

void main() {
  int kind = int(position.w);
  float age = fract(position.w);
  gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  gl_PointSize = 1.0;
  v_strength = 0.0;
#ifdef FROTH
  if (kind != kKind) return;
  // Foam spreads and fades.
  float radius_m = a_motion.w * (1.0 + 1.5 * age);
  v_strength = 0.75 * (1.0 - age);
  gl_Position = vec4(2.0 * position.xz / u_extent_m, 0.0, 1.0);
  gl_PointSize = max(2.0 * radius_m / max(u_extent_m.x, u_extent_m.y) * u_target_px, 2.0);
#else
  v_flight = vec4(1.0, 0.0, 1.0, 1.0);
  if (kind != kKind) return;
  vec3 center_m = (viewMatrix * vec4(position.xyz, 1.0)).xyz;
  float radius_m = a_motion.w;
  bool is_mist = radius_m > kMistRadiusM;
  radius_m = is_mist ? radius_m * (1.0 + 1.5 * age) : min(radius_m, kMostShare * -center_m.z);
  if (-center_m.z < 2.0 * radius_m) return;
  float px_per_m = 0.5 * projectionMatrix[1][1] * u_target_px.y / -center_m.z;
  float width_px = 2.0 * radius_m * px_per_m;
  float length_px = width_px;
#ifdef SPRAY
  vec2 flight = (mat3(viewMatrix) * a_motion.xyz).xy;
  float speed_mps = length(flight);
  if (!is_mist && speed_mps > 0.01) {
    length_px += speed_mps * kExposureS * px_per_m;
    v_flight.xy = flight / speed_mps;
  }
  // Mist that hangs in the air is too thin to be seen.
  v_strength = is_mist ? 0.06 * (1.0 - age) * (1.0 - age) * smoothstep(0.0, 0.08, age) * smoothstep(0.6, 2.5, length(a_motion.xyz)) : 0.65 * (1.0 - age * age);
#else
  v_strength = 1.0;
#endif
  // What is thinner than a pixel covers a part of it: drops become fainter, bubbles fewer.
  float covered = min(width_px / kLeastPx, 1.0);
#ifdef SPRAY
  v_strength *= covered;
#else
  if (hash(uint(gl_VertexID)) > covered * covered) return;
#endif
  width_px = max(width_px, kLeastPx);
  length_px = max(length_px, width_px);
  v_flight.z = width_px / length_px;
  v_flight.w = width_px;
#ifdef SPRAY
  // What flies covers each place for a part of the time.
  v_strength *= sqrt(v_flight.z);
  if (is_mist) v_flight.w = 0.0;
  v_toward_sun = max(dot(normalize(center_m), mat3(viewMatrix) * u_sun_direction), 0.0);
#endif
  gl_Position = projectionMatrix * vec4(center_m, 1.0);
  gl_PointSize = length_px;
#endif
}
