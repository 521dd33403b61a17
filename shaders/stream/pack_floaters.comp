// Quantizes floaters for the stream, seven words each without gaps, in the order of their slots: FloatersFixed28 in wire.proto.
// One group, an invocation for a row of slots.
// Reads FLOATERS. Writes PACKED_WORDS from first_word on.
#include "bodies/floater.glsl"
#include "bodies/floater_slot.glsl"
#include "stream/quantized.glsl"

const uint kGroup = 128u;
layout(local_size_x = kGroup) in;

layout(binding = FLOATERS) uniform samplerBuffer floaters;
layout(std430, binding = PACKED_WORDS) restrict writeonly buffer PackedWords { uint packed_words[]; };
uniform uint first_word;

shared uint here_count[kGroup];

bool isHere(uint slot) { return isFloaterHere(texelFetch(floaters, int(slot) * FLOATER_TEXELS)); }

void pack(uint slot, uint at) {
  vec4 t[FLOATER_TEXELS];
  for (int k = 0; k < FLOATER_TEXELS; ++k) t[k] = texelFetch(floaters, int(slot) * FLOATER_TEXELS + k);
  Floater b = unpackFloater(t);
  if (!(dot(b.rotation, b.rotation) > 0.5)) b.rotation = vec4(0.0, 0.0, 0.0, 1.0);  // until the watchdog mends it
  const vec3 middle_m = middleOf(b);
  const uint size_cm = uint(clamp(round(100.0 * t[5].z), 0.0, 65535.0));
  packed_words[at] = uint(b.id);
  packed_words[at + 1u] = millimetres(middle_m.x);
  packed_words[at + 2u] = millimetres(middle_m.y);
  packed_words[at + 3u] = millimetres(middle_m.z);
  packed_words[at + 4u] = (quantizedSigned(b.rotation.x, 32767.0) & 0xffffu) | quantizedSigned(b.rotation.y, 32767.0) << 16;
  packed_words[at + 5u] = (quantizedSigned(b.rotation.z, 32767.0) & 0xffffu) | quantizedSigned(b.rotation.w, 32767.0) << 16;
  packed_words[at + 6u] = size_cm | uint(t[4].w) >> 3 << 16 | (b.hold.w > 0.0 ? 1u : 0u) << 24;
}

void main() {
  const uint lane = gl_LocalInvocationID.x;
  const uint slot_count = uint(textureSize(floaters)) / FLOATER_TEXELS;
  const uint row = (slot_count + kGroup - 1u) / kGroup;
  const uint first = min(lane * row, slot_count);
  const uint end = min(first + row, slot_count);
  uint count = 0u;
  for (uint slot = first; slot < end; ++slot) count += isHere(slot) ? 1u : 0u;
  here_count[lane] = count;
  barrier();
  uint at = first_word;
  for (uint k = 0u; k < lane; ++k) at += 7u * here_count[k];
  for (uint slot = first; slot < end; ++slot) {
    if (!isHere(slot)) continue;
    pack(slot, at);
    at += 7u;
  }
}
