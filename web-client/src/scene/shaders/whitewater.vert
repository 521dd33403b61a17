// One point per drop, patch of foam or bubble (whitewater/diffuse_particles.ts). Draws those of one kind:
// SPRAY: drops, stretched along their flight, and mist. BUBBLES: below the surface. FROTH: foam, seen from above.
in vec4 position;  // position (m), kind + share of its life that has passed
in vec4 a_motion;  // velocity (m/s), radius (m)

#ifdef SPRAY
#include <drop>
const int kKind = 0;
#elif defined(FROTH)
uniform vec2 u_extent_m;  // length and width of the water
uniform float u_target_px;
flat out float v_strength;
const int kKind = 1;
#else
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec2 u_target_px;
const int kKind = 2;
#endif

const float kMistRadiusM = 0.05;  // larger drops are puffs of mist
const float kLeastBubblePx = 1.5;
const float kMostBubbleShare = 0.0015;  // of their distance

float hash(uint n) {
  n = (n ^ 61u) ^ (n >> 16u);
  n *= 9u;
  n ^= n >> 4u;
  n *= 0x27d4eb2du;
  return float((n ^ (n >> 15u)) & 65535u) / 65535.0;
}

void main() {
  float age = fract(position.w);
  gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
  gl_PointSize = 1.0;
#ifdef SPRAY
  noDrop();
#elif defined(FROTH)
  v_strength = 0.0;
#endif
  if (int(position.w) != kKind) return;
#ifdef SPRAY
  bool is_mist = a_motion.w > kMistRadiusM;
  // Mist that hangs in the air is too thin to be seen.
  float strength = is_mist ? 0.04 * (1.0 - age) * (1.0 - age) * smoothstep(0.0, 0.08, age) * smoothstep(0.6, 2.5, length(a_motion.xyz)) : 0.65 * (1.0 - age * age);
  drawDrop(position.xyz, a_motion.xyz, is_mist ? a_motion.w * (1.0 + 1.5 * age) : a_motion.w, is_mist, strength, 0.6);
#elif defined(FROTH)
  // Foam spreads and fades.
  float radius_m = a_motion.w * (1.0 + 1.5 * age);
  v_strength = 0.75 * (1.0 - age);
  gl_Position = vec4(2.0 * position.xz / u_extent_m, 0.0, 1.0);
  gl_PointSize = max(2.0 * radius_m / max(u_extent_m.x, u_extent_m.y) * u_target_px, 2.0);
#else
  vec3 center_m = (viewMatrix * vec4(position.xyz, 1.0)).xyz;
  if (-center_m.z < 2.0 * a_motion.w) return;
  float width_px = min(a_motion.w / -center_m.z, kMostBubbleShare) * projectionMatrix[1][1] * u_target_px.y;
  // Of bubbles narrower than a pixel fewer are drawn.
  float covered = min(width_px / kLeastBubblePx, 1.0);
  if (hash(uint(gl_VertexID)) > covered * covered) return;
  gl_Position = projectionMatrix * vec4(center_m, 1.0);
  gl_PointSize = max(width_px, kLeastBubblePx);
#endif
}
