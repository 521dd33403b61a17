// Quantizes boats for the stream, seven words each without gaps: BodiesFixed28 in wire.proto. One invocation, because
// boats are few.
// Reads BOATS, BoatControls. Writes PACKED_WORDS from first_word on.
#include "bodies/boat.glsl"
#include "stream/quantized.glsl"

layout(local_size_x = 1) in;

layout(binding = BOATS) uniform samplerBuffer boats;
layout(std430, binding = PACKED_WORDS) restrict writeonly buffer PackedWords { uint packed_words[]; };
uniform uint first_word;

void main() {
  uint at = first_word;
  for (int place = 0; place < int(boat_place_count); ++place) {
    vec4 t[BOAT_TEXELS];
    for (int k = 0; k < BOAT_TEXELS; ++k) t[k] = texelFetch(boats, place * BOAT_TEXELS + k);
    const BoatState b = unpackBoat(t);
    if (b.age_s < 0.0) continue;
    const float pi = 3.14159265;
    packed_words[at] = uint(b.id);
    packed_words[at + 1u] = millimetres(b.centre_m.x);
    packed_words[at + 2u] = millimetres(b.centre_m.y);
    packed_words[at + 3u] = millimetres(b.centre_m.z);
    packed_words[at + 4u] = (quantizedSigned(b.heading / pi, 32767.0) & 0xffffu) | quantizedSigned(b.tilt.x / pi, 32767.0) << 16;
    packed_words[at + 5u] = (quantizedSigned(b.tilt.y / pi, 32767.0) & 0xffffu) | quantizedSigned(b.speed_mps.x / 327.67, 32767.0) << 16;
    packed_words[at + 6u] = (quantizedSigned(b.control.x, 127.0) & 0xffu) | (quantizedSigned(b.control.y, 127.0) & 0xffu) << 8;
    at += 7u;
  }
}
