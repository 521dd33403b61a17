// What crests across the whole domain do along their direction: the same in all rows of cells.
// Reads EventUniforms. Writes CREST_PROFILE [longer side of the domain x crests]: displacement at the faces [m^2 for a crest of 1 m],
// and the elevation there half a step before [for 1 m].
#include "shared/groups.h"
#include "wave/wave_cell.glsl"
#include "common/event_shapes.glsl"

layout(local_size_x = WAVE_GROUP_X, local_size_y = WAVE_GROUP_Y) in;

layout(std430, binding = CREST_PROFILE) restrict writeonly buffer CrestProfile { vec2 crest_profile[]; };

void main() {
  const int length_count = max(waveCounts().x, waveCounts().y);
  const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (at.x >= length_count || uint(at.y) >= crest_count) return;
  EventUniform e = crests[at.y];
  if (e.lateral_m > 0.0) return;
  const vec2 p = waveCellCentre(at.xx) + vec2(0.5 * sim.wave_cell_m);
  const vec2 place_m = e.direction_x != 0.0 ? vec2(p.x, 0.0) : vec2(0.0, p.y);
  const float displaced_m2 = crestDisplacement(e, place_m, crestEnds(e));
  e.offset_m -= e.half_step_m;
  crest_profile[at.x + length_count * at.y] = vec2(displaced_m2, crestElevation(e, place_m, crestEnds(e)));
}
