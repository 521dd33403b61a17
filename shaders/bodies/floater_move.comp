// Moves every floater that can touch something by a part of a tick. One invocation per floater.
// Reads FLOATER_NEAR. Updates FLOATERS. Reads FLOATER_PUSH, and clears it for the next step.
#include "bodies/floater.glsl"

layout(local_size_x = FLOATER_GROUP) in;

layout(std430, binding = FLOATERS) restrict buffer Floaters { vec4 floaters[]; };
layout(std430, binding = FLOATER_PUSH) restrict buffer FloaterPush { int floater_push[]; };
layout(std430, binding = FLOATER_NEAR) restrict readonly buffer FloaterNear { uint near[]; };
uniform float step_s;

const float kRestSpeed_mps = 0.03;  // slower than this, a floater that is touched comes to rest
const float kRestKept = 0.9;

vec3 pushed(uint at) { return vec3(floater_push[at], floater_push[at + 1u], floater_push[at + 2u]) / PUSH_UNITS; }

/// Sides end the way of a centre of mass: their contacts, which are springs, let a small fast floater pass by half a metre.
void holdBetween(inout float at_m, inout float velocity_mps, float half_m) {
  if (abs(at_m) <= half_m) return;
  at_m = sign(at_m) * half_m;
  velocity_mps = sign(at_m) * min(sign(at_m) * velocity_mps, 0.0);
}

void main() {
  const uint own = gl_GlobalInvocationID.x;
  if (own >= uint(near.length()) / FLOATER_NEAR_WORDS || near[own * FLOATER_NEAR_WORDS] == 0u) return;
  const uint at = own * FLOATER_TEXELS;
  vec4 t[FLOATER_TEXELS];
  for (uint k = 0u; k < FLOATER_TEXELS; ++k) t[k] = floaters[at + k];
  Floater b = unpackFloater(t);
  const uint push = 8u * own;
  const bool touches = floater_push[push + 6u] > 0;
  b.velocity_mps = limited(b.velocity_mps + pushed(push) + step_s * b.acceleration_mps2, FLOATER_MAX_MPS);
  b.spin_radps = limited(b.spin_radps + pushed(push + 3u) + step_s * b.spin_up_radps2, FLOATER_MAX_RADPS);
  const float fastest_mps = max(length(b.velocity_mps), reachOf(b) * length(b.spin_radps));
  const float kept = touches && b.hold.w <= 0.0 && fastest_mps < kRestSpeed_mps ? kRestKept : 1.0;
  b.velocity_mps *= kept;
  b.spin_radps *= kept;
  b = drifted(b, step_s);
#if !WAVE_PERIODIC_X
  holdBetween(b.centre_m.x, b.velocity_mps.x, waveHalf_m().x);
#endif
#if !WAVE_PERIODIC_Z
  holdBetween(b.centre_m.z, b.velocity_mps.z, waveHalf_m().y);
#endif
  for (uint k = 0u; k < 8u; ++k) floater_push[push + k] = 0;
  floaters[at] = vec4(b.centre_m, b.age_s + step_s);
  floaters[at + 1u] = b.rotation;
  floaters[at + 2u] = vec4(b.velocity_mps, b.id);
  floaters[at + 3u] = vec4(b.spin_radps, b.dent);
}
