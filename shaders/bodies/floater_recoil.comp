// Gives every floater what the particles that hit it in this substep have lost. One invocation per slot.
// Updates FLOATERS. Reads FLOATER_PUSH (bodies/floater_hits.comp), and clears it.
#include "bodies/floater.glsl"

layout(local_size_x = FLOATER_GROUP) in;

layout(std430, binding = FLOATERS) restrict buffer Floaters { vec4 floaters[]; };
layout(std430, binding = FLOATER_PUSH) restrict buffer FloaterPush { int floater_push[]; };

vec3 pushed(uint at) { return vec3(floater_push[at], floater_push[at + 1u], floater_push[at + 2u]) / PUSH_UNITS; }

void main() {
  const uint own = gl_GlobalInvocationID.x;
  const uint push = 8u * own;
  if (push >= uint(floater_push.length()) || floater_push[push + 7u] == 0) return;
  const uint at = own * FLOATER_TEXELS + 2u;
  floaters[at].xyz = limited(floaters[at].xyz + pushed(push), FLOATER_MAX_MPS);
  floaters[at + 1u].xyz = limited(floaters[at + 1u].xyz + pushed(push + 3u), FLOATER_MAX_RADPS);
  for (uint k = 0u; k < 8u; ++k) floater_push[push + k] = 0;
}
