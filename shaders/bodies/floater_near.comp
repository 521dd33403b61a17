// Lists for each floater those that it can touch in this tick, by their slots. One group per floater, an invocation per word of
// a tile.
// Reads FLOATERS, FLOATER_TILES (bodies/floater_tiles.comp). Writes FLOATER_NEAR: per slot the number, then the slots.
// Two floaters list each other, unless one has more than FLOATER_NEAR_MAX neighbours: it keeps those of the lowest slots.
#include "bodies/floater_reach.glsl"

layout(local_size_x = 32) in;

layout(std430, binding = FLOATER_TILES) restrict readonly buffer FloaterTiles { uint tiles[]; };
layout(std430, binding = FLOATER_NEAR) restrict writeonly buffer FloaterNear { uint near[]; };

shared uint near_count[32];

void main() {
  const uint own = gl_WorkGroupID.x;
  const uint word = gl_LocalInvocationID.x;
  const vec4 place = floaterPlace(int(own));
  uint listed = 0u;
  if (place.w > 0.0 && word < tile_words_count) {
    const ivec4 span = tileSpan(place);
    for (int z = span.z; z <= span.w; ++z)
      for (int x = span.x; x <= span.y; ++x) listed |= tiles[tileAt(x, z) * tile_words_count + word];
    for (uint rest = listed; rest != 0u; rest &= rest - 1u) {
      const int bit = findLSB(rest);
      const uint other = 32u * word + uint(bit);
      const vec4 at = floaterPlace(int(other));
      vec3 d = at.xyz - place.xyz;
      d.xz = acrossSides(d.xz);
      const float reach_m = at.w + place.w;
      if (other == own || dot(d, d) > reach_m * reach_m) listed &= ~(1u << bit);
    }
  }
  near_count[word] = uint(bitCount(listed));
  barrier();
  uint at = 0u;
  for (uint k = 0u; k < word; ++k) at += near_count[k];
  const uint first = own * uint(FLOATER_NEAR_MAX + 1);
  if (word == 31u) near[first] = min(at + near_count[31], uint(FLOATER_NEAR_MAX));
  for (uint rest = listed; rest != 0u && at < uint(FLOATER_NEAR_MAX); rest &= rest - 1u) {
    near[first + 1u + at] = 32u * word + uint(findLSB(rest));
    ++at;
  }
}
