// Include in a vertex shader: a drop in the air or a puff of mist, as a soft point for drop.frag.
#include <sky>
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec2 u_target_px;

flat out vec3 v_flight;  // unit direction on the screen, and width over length
flat out vec4 v_light;   // as displayed, and how much of what is behind it hides
flat out float v_round;  // 0: a soft point; 1: so large that its shape is seen

#ifndef EXPOSURE_S
#define EXPOSURE_S 0.01  // drops are drawn as long as they fly in this time
#define MOST_SHARE 0.0008  // drops near the eye are not larger than this share of their distance: they would be flakes
#endif
const float kSoft = 1.7;          // a soft point seems narrower than it is
const float kLeastPx = 1.7;
const vec2 kRoundPx = vec2(3.0, 5.5);  // widths of drops between which their shape is seen

void noDrop() {
  gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  gl_PointSize = 1.0;
  v_flight = vec3(1.0, 0.0, 1.0);
  v_light = vec4(0.0);
  v_round = 0.0;
}

// `sunlit`: share of the sunlight that the spray around it lets through.
void drawDrop(vec3 center_m, vec3 velocity_mps, float radius_m, bool is_mist, float strength, float sunlit) {
  vec3 seen_m = (viewMatrix * vec4(center_m, 1.0)).xyz;
  strength *= smoothstep(3.0 * radius_m, 3.0 * radius_m + 2.0, -seen_m.z);
  if (strength <= 0.0) return;
  if (!is_mist) radius_m = min(radius_m, MOST_SHARE * -seen_m.z);
  float px_per_m = 0.5 * projectionMatrix[1][1] * u_target_px.y / -seen_m.z;
  vec2 flight_mps = (mat3(viewMatrix) * velocity_mps).xy;
  float speed_mps = length(flight_mps);
  float width_px = 2.0 * kSoft * radius_m * px_per_m;
  v_round = is_mist ? 0.0 : smoothstep(kRoundPx.x, kRoundPx.y, width_px);
  // What is thinner than a pixel covers a part of it, and what flies covers each place for a part of the time.
  strength *= min(width_px / kLeastPx, 1.0);
  width_px = max(width_px, kLeastPx);
  float length_px = width_px;
  if (!is_mist && speed_mps > 0.01) {
    length_px += speed_mps * EXPOSURE_S * px_per_m;
    strength *= sqrt(width_px / length_px);
    v_flight = vec3(flight_mps / speed_mps, width_px / length_px);
  }
  // Water lets most light through: it is brightest toward the sun.
  float toward_sun = max(dot(normalize(seen_m), mat3(viewMatrix) * u_sun_direction), 0.0);
  toward_sun *= toward_sun;
  v_light = vec4(toDisplay(vec3(0.95, 0.97, 0.98) * (u_sun_light * (0.25 + sunlit * (0.6 + 0.8 * toward_sun * toward_sun)) + 1.2 * u_ambient_up)), strength);
  gl_Position = projectionMatrix * vec4(seen_m, 1.0);
  gl_PointSize = length_px;
}
