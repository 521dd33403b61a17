// Include in a vertex shader: a drop in the air, as a soft point, or a puff of spray, for drop.frag.
#include <sky>
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec2 u_target_px;

flat out vec3 v_flight;  // unit direction on the screen, and width over length
flat out vec4 v_light;   // as displayed, and how much of what is behind it hides
flat out float v_round;  // 0: a soft point; 1: so large that its shape is seen
flat out vec4 v_puff;   // which of many shapes, how far it has come apart, 0..1, its radius (m); below 0: a drop

#ifndef EXPOSURE_S
#define EXPOSURE_S 0.01  // drops are drawn as long as they fly in this time
#define MOST_SHARE 0.0008  // drops near the eye are not larger than this share of their distance: they would be flakes
#endif
const float kSoft = 1.7;          // a soft point seems narrower than it is
const float kLeastPx = 1.7;
const vec2 kRoundPx = vec2(3.0, 5.5);  // widths of drops between which their shape is seen
// Radii from the eye between which a drop or a puff appears, and so much further, m.
const float kDropRadii = 3.0, kPuffRadii = 9.0, kNearM = 2.0;

void noDrop() {
  gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  gl_PointSize = 1.0;
  v_flight = vec3(1.0, 0.0, 1.0);
  v_light = vec4(0.0);
  v_round = 0.0;
  v_puff = vec4(-1.0);
}

float pxPerM(vec3 seen_m) { return 0.5 * projectionMatrix[1][1] * u_target_px.y / -seen_m.z; }

void drawPoint(vec3 seen_m, float size_px, float strength, float sunlit) {
  // Water lets most light through: it is brightest toward the sun.
  float toward_sun = max(dot(normalize(seen_m), mat3(viewMatrix) * u_sun_direction), 0.0);
  toward_sun *= toward_sun;
  v_light = vec4(toDisplay(vec3(0.95, 0.97, 0.98) * (u_sun_light * (0.25 + sunlit * (0.6 + 0.8 * toward_sun * toward_sun)) + 1.2 * u_ambient_up)), strength);
  gl_Position = projectionMatrix * vec4(seen_m, 1.0);
  gl_PointSize = size_px;
}

// `sunlit`: share of the sunlight that the spray around it lets through.
void drawDrop(vec3 center_m, vec3 velocity_mps, float radius_m, float strength, float sunlit) {
  vec3 seen_m = (viewMatrix * vec4(center_m, 1.0)).xyz;
  strength *= smoothstep(kDropRadii * radius_m, kDropRadii * radius_m + kNearM, -seen_m.z);
  if (strength <= 0.0) return;
  radius_m = min(radius_m, MOST_SHARE * -seen_m.z);
  float px_per_m = pxPerM(seen_m);
  vec2 flight_mps = (mat3(viewMatrix) * velocity_mps).xy;
  float speed_mps = length(flight_mps);
  float width_px = 2.0 * kSoft * radius_m * px_per_m;
  v_round = smoothstep(kRoundPx.x, kRoundPx.y, width_px);
  // What is thinner than a pixel covers a part of it, and what flies covers each place for a part of the time.
  strength *= min(width_px / kLeastPx, 1.0);
  width_px = max(width_px, kLeastPx);
  float length_px = width_px;
  if (speed_mps > 0.01) {
    length_px += speed_mps * EXPOSURE_S * px_per_m;
    strength *= sqrt(width_px / length_px);
    v_flight = vec3(flight_mps / speed_mps, width_px / length_px);
  }
  drawPoint(seen_m, length_px, strength, sunlit);
}

// `puff`: as v_puff, without the radius.
void drawPuff(vec3 center_m, vec3 velocity_mps, float radius_m, vec3 puff, float strength, float sunlit) {
  vec3 seen_m = (viewMatrix * vec4(center_m, 1.0)).xyz;
  float away = smoothstep(kDropRadii * radius_m, kPuffRadii * radius_m + kNearM, -seen_m.z);
  if (away <= 0.0) return;
  // Near the eye it is a few drops.
  puff.z = max(puff.z, 1.0 - away);
  float width_px = 2.0 * radius_m * pxPerM(seen_m);
  v_puff = vec4(puff, radius_m);
  vec2 flight_mps = (mat3(viewMatrix) * velocity_mps).xy;
  if (dot(flight_mps, flight_mps) > 1e-4) v_flight = vec3(normalize(flight_mps), 1.0);
  drawPoint(seen_m, max(width_px, kLeastPx), strength * min(width_px / kLeastPx, 1.0), sunlit);
}
