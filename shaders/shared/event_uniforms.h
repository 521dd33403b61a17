// Effects that act on the wave during one wave step. Each one displaces water by gain * V(x, z)
// (common/event_shapes.glsl); over its duration the gains of an effect sum to its full amplitude.
#ifndef SPINDRIFT_SHARED_EVENT_UNIFORMS_H
#define SPINDRIFT_SHARED_EVENT_UNIFORMS_H

#include "shared/bindings.h"
#include "shared/dual.h"

// Maximum number of splashes (rain drops included) and of crests at the same time.
#define MAX_SPLASHES 96
#define MAX_CRESTS 16
// A stroke moves its dent with two splashes: one fills it, one presses it at the next position. So many strokes move in
// one step, and others in the next: a block of uniforms holds 16 KiB.
#define MAX_MOVING_STROKES 64
#define MAX_PRESSES (MAX_SPLASHES + 2 * MAX_MOVING_STROKES)
#define SPLASH_WORDS 7  // bits for MAX_PRESSES splashes
// Calmed discs of a step: those of MAX_CALMS strokes; others take turns. As many as fit into the 16 KiB.
#define MAX_CALMS 62
// A splash is cut off at this many radii: exp(-3.5^2) is 5e-6.
#define SPLASH_REACH 3.5f

#ifdef __cplusplus
namespace spindrift::shared {
#endif
struct EventUniform {
  float gain_m;        // this step's share of the amplitude; negative pushes down
  float x_m;           // splash: centre. crest: origin of direction and offset
  float z_m;
  float radius_m;      // splash
  float direction_x;   // crest: direction of travel, a unit vector
  float direction_z;
  float offset_m;      // crest: present position along its direction
  float front_m;       // crest: width of its front and back
  float back_m;
  float lateral_m;     // crest: half its length along the crest; 0 = across the whole domain
  float half_step_m;   // crest: distance travelled in half a step
  float speed_mps;     // crest: of the wave. splash: of the crown that it produces now; 0 for rain drops and strokes
  float depth_m;       // splash: full depth
  float half_side_m;   // crest across the whole domain: half of the domain's side along its direction. 0: of a paddle
  float highest_m;     // stroke: it moves less water where the surface is farther than this from its rest; 0: no bound
  float unused;
};

struct CalmUniform {
  float x_m;           // middle of a calmed disc
  float z_m;
  float radius_m;
  float drag_ratio;    // share of the flow that the step takes in the middle
};
/// A tile of SPLASH_TILE x SPLASH_TILE cells (shared/groups.h), and the splashes that reach it.
struct SplashTile {
  uint place;                   // from the lowest bit: 12 bits, tiles before it along x; 12 along z; 8, the words below that are not 0
  uint splashes[SPLASH_WORDS];  // a bit each
};
#ifdef __cplusplus
struct EventUniforms {
  EventUniform splashes[MAX_PRESSES];
  EventUniform crests[MAX_CRESTS];
  CalmUniform calms[MAX_CALMS];
  uint splash_count;
  uint crest_count;
  uint press_begin;  // as in the block below
  uint calm_count;
};
static_assert(sizeof(EventUniform) == 64 && sizeof(CalmUniform) == 16);
static_assert(sizeof(SplashTile) == 4 * (1 + SPLASH_WORDS) && MAX_PRESSES <= 32 * SPLASH_WORDS);
static_assert(sizeof(EventUniforms) == 64 * (MAX_PRESSES + MAX_CRESTS) + 16 * MAX_CALMS + 16);
static_assert(sizeof(EventUniforms) <= 16384);
}  // namespace spindrift::shared
#else
layout(std140, binding = EVENT_UNIFORMS) uniform EventUniforms {
  EventUniform splashes[MAX_PRESSES];
  EventUniform crests[MAX_CRESTS];
  CalmUniform calms[MAX_CALMS];
  uint splash_count;
  uint crest_count;
  uint press_begin;  // the splashes from here on are those of strokes
  uint calm_count;
};
#endif

#endif
