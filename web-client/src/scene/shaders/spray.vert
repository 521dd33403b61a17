// One point per drop in the air, stretched along its flight, or puff of spray (whitewater/diffuse_particles.ts).
in vec4 position;  // position (m), kind + share of its life that has passed
in vec4 a_motion;  // velocity (m/s), radius (m)
#include <drop>

const int kDrop = 0, kPuff = 3;
// How much they hide, and the share of the sun's light that the spray around them lets through.
const float kDropStrength = 0.65, kPuffStrength = 0.8, kSunlit = 0.6;

void main() {
  noDrop();
  int kind = int(position.w);
  float age = fract(position.w);
  // Each puff has the shape of its radius, which stays the same.
  vec2 shape = fract(a_motion.w * vec2(7919.0, 4729.0));
  if (kind == kPuff) drawPuff(position.xyz, a_motion.xyz, a_motion.w * (1.0 + age), vec3(shape, age), kPuffStrength * (1.0 - smoothstep(0.6, 1.0, age)), kSunlit);
  else if (kind == kDrop) drawDrop(position.xyz, a_motion.xyz, a_motion.w, kDropStrength * (1.0 - age * age), kSunlit);
}
