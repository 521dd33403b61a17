// Notes each floater in the tiles of the water that it can reach in this tick. One invocation per slot.
// Reads FLOATERS. Updates FLOATER_TILES (cleared before): tile_words_count words of 32 slots per tile.
#include "bodies/floater_reach.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = FLOATER_TILES) restrict buffer FloaterTiles { uint tiles[]; };
uniform uint slot_count;

void main() {
  const uint slot = gl_GlobalInvocationID.x;
  if (slot >= slot_count) return;
  const vec4 place = floaterPlace(int(slot));
  if (!(place.w > 0.0)) return;
  const ivec4 span = tileSpan(place);
  for (int z = span.z; z <= span.w; ++z)
    for (int x = span.x; x <= span.y; ++x) atomicOr(tiles[tileAt(x, z) * tile_words_count + (slot >> 5)], 1u << (slot & 31u));
}
