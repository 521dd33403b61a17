// One point per patch of foam or bubble (whitewater/diffuse_particles.ts). Draws those of one kind:
// BUBBLES: below the surface. FROTH: foam, seen from above, and what is around hulls.
in vec4 position;  // position (m), kind + share of its life that has passed; of a hull its speed (m/s) instead of its height
in vec4 a_motion;  // velocity (m/s), radius (m); of a hull: course x, beam (m), course z, length (m)

#ifdef FROTH
uniform vec2 u_extent_m;  // length and width of the water
uniform float u_target_px;
flat out float v_strength;
flat out vec4 v_hull;  // course, half of length and beam (m); length 0: a patch of foam
flat out float v_radius_m;
const int kKind = 1, kHull = 4;
const float kAroundHullM = 0.5;  // reach of foam and shade
const float kAtRest = 0.5, kFullFroude = 0.5;  // foam around a hull at rest, and the Froude number at which it is white
const float kPatch = 0.36;  // foam in the middle of a patch that begins
#else
uniform mat4 viewMatrix;
uniform mat4 projectionMatrix;
uniform vec2 u_target_px;
const int kKind = 2;
#endif

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
#ifdef FROTH
  v_strength = 0.0;
  v_hull = vec4(0.0);
  v_radius_m = 0.0;
  if (int(position.w) == kHull && a_motion.w > 0.0) {
    v_strength = mix(kAtRest, 1.0, smoothstep(0.1, kFullFroude, abs(position.y) * inversesqrt(9.81 * a_motion.w)));
    v_hull = vec4(a_motion.xz, 0.5 * a_motion.wy);
    v_radius_m = v_hull.z + kAroundHullM;
    gl_Position = vec4(2.0 * position.xz / u_extent_m, 0.0, 1.0);
    gl_PointSize = 2.0 * v_radius_m / max(u_extent_m.x, u_extent_m.y) * u_target_px;
    return;
  }
#endif
  if (int(position.w) != kKind) return;
#ifdef FROTH
  // Foam spreads and fades; patches add up where many begin.
  float spread = 1.0 + 2.0 * age;
  float radius_m = a_motion.w * spread;
  v_strength = kPatch * (1.0 - age) / (spread * spread);
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
