// Drops of a tank: what flies apart from the liquid. A particle that stands for many drops is drawn as a few of them, one per draw (u_drop), spread
// around it and stretched along their flight. They keep their places while it flies freely (fluid_words.glsl).
// FROTH: none beside hulls, where they would hang in front of the boat.
#include <fluid_words>
#include <fluid_volume>

uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec2 u_target_px;
uniform float u_drop;
#ifdef FROTH
uniform sampler2D u_froth;
#endif

flat out vec3 v_flight;    // unit direction on the screen, and width over length
flat out vec2 v_strength_white;  // white: 0..1
flat out vec4 v_puff;  // as in drop.glsl

// Density of the volume at a particle between which it comes away from the liquid.
const float kAlone = 0.30, kAmongOthers = 0.55, kAmongWhite = 0.9;
// Density (as streamed) of particles that are never apart from it.
const float kDense = 0.7;
// A drop is drawn as long as it flies in this time.
const float kExposureS = 0.012;
const float kLeastPx = 1.6;
// Widths of drops from white ones, whose inside cannot be made out, to clear ones.
const vec2 kClearPx = vec2(1.6, 4.0);
const float kLargeM = 0.07;
// How much of what is behind it a white puff hides, and how far that of a particle that flies alone has come apart.
const float kPuffStrength = 0.55, kTornAlone = 0.7;
// Drops near the eye are not larger than this share of their distance: they would be flakes.
const float kMostShare = 0.003;

void main() {
  Particle particle = unpackParticle();
  gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  gl_PointSize = 1.0;
  v_flight = vec3(1.0, 0.0, 1.0);
  v_strength_white = vec2(0.0);
  v_puff = vec4(-1.0);
  if (particle.density > kDense) return;
#ifdef FROTH
  if (textureLod(u_froth, particle.center_m.xz / (u_volume_max_m.xz - u_volume_min_m.xz) + 0.5, 0.0).g > 0.01) return;
#endif
  float strength = 1.0 - smoothstep(kAlone, mix(kAmongOthers, kAmongWhite, particle.foam), volumeAt(particle.center_m).r);
  if (strength <= 0.0) return;
  vec4 random = randomOf(particle, u_drop);
  // Those of a particle that flies alone lie far apart: close ones would be a flock.
  vec3 center_m = particle.center_m + (3.0 + 5.0 * strength * strength) * u_radius_m * (random.xyz - 0.5);
  // Few are large. The first is the puff of fine drops among them.
  bool is_puff = u_drop == 0.0;
  float radius_m = is_puff ? mix(0.9, 1.6, random.w) * u_radius_m : min(u_radius_m, kLargeM) * mix(0.03, 0.36, pow(random.w, 8.0));
  if (is_puff) center_m = particle.center_m;
  vec3 seen_m = (viewMatrix * vec4(center_m, 1.0)).xyz;
  if (-seen_m.z < 4.0 * u_radius_m) return;
  if (!is_puff) radius_m = min(radius_m, kMostShare * -seen_m.z);
  float px_per_m = 0.5 * projectionMatrix[1][1] * u_target_px.y / -seen_m.z;
  vec2 flight_mps = (mat3(viewMatrix) * particle.velocity_mps).xy;
  float speed_mps = length(flight_mps);
  float width_px = 2.0 * radius_m * px_per_m;
  float length_px = width_px + min(speed_mps * kExposureS, 6.0 * radius_m) * px_per_m;
  // What is thinner than a pixel covers a part of it, and what flies covers each place for a part of the time.
  v_strength_white = is_puff ? vec2(strength * kPuffStrength * particle.foam, 1.0) : vec2(strength * min(width_px * width_px / (kLeastPx * kLeastPx), 1.0), particle.foam * (1.0 - smoothstep(kClearPx.x, kClearPx.y, width_px)));
  width_px = max(width_px, kLeastPx);
  length_px = max(length_px, width_px);
  if (!is_puff) v_strength_white.x *= sqrt(width_px / length_px);
  if (is_puff) v_puff = vec4(random.xy, kTornAlone * strength, radius_m);
  v_flight = vec3(speed_mps > 0.01 ? flight_mps / speed_mps : vec2(1.0, 0.0), width_px / length_px);
  gl_Position = projectionMatrix * vec4(seen_m, 1.0);
  gl_PointSize = length_px;
}
