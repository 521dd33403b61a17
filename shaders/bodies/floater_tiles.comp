// Notes each floater in the tiles of the water that it can reach in this tick. One invocation per slot.
// Reads FLOATERS. Writes FLOATER_PLACES: centre of mass and radius of what it can touch before the end of the tick, 0 for a free
// slot. Updates FLOATER_TILES (cleared before): a bit per slot in each tile.
#include "bodies/floater_texels.glsl"
#include "bodies/floater_tiles.glsl"

layout(local_size_x = 64) in;

layout(std430, binding = FLOATER_PLACES) restrict writeonly buffer FloaterPlaces { vec4 places[]; };
layout(std430, binding = FLOATER_TILES) restrict buffer FloaterTiles { uint tiles[]; };

void main() {
  const uint slot = gl_GlobalInvocationID.x;
  if (slot >= uint(places.length())) return;
  const Floater b = floaterAt(slot);
  const float path_m = sim.tick_s * (length(b.velocity_mps) + sim.tick_s * length(b.acceleration_mps2));
  const float reach_m = b.age_s < 0.0 ? 0.0 : reachOf(b) + path_m + 0.02 * b.half_m.x;
  const vec4 place = vec4(b.centre_m, reach_m);
  places[slot] = place;
  if (!(reach_m > 0.0)) return;
  const ivec4 span = tileSpan(place);
  const uint words = (uint(places.length()) + 31u) / 32u;
  for (int z = span.z; z <= span.w; ++z)
    for (int x = span.x; x <= span.y; ++x) atomicOr(tiles[tileAt(x, z, words) + (slot >> 5)], 1u << (slot & 31u));
}
