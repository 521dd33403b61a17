// Boats: BOAT_TEXELS texels each in BOATS, one slot per boat. Axes: forward is (cos heading, sin heading) in (x, z),
// starboard (-sin, cos); pitch lifts the bow, roll lowers starboard.
//   0  x, y, z of the hull's centre (half way from keel to deck) [m], heading [rad]
//   1  pitch, roll [rad], age [s] (negative: the slot is free), id
//   2  speed forward, to starboard, up [m/s], yaw rate [rad/s]
//   3  pitch rate, roll rate [rad/s], throttle, rudder [-1..1]
//   4  length, beam, height, draught at rest [m]
//   5  full speed [m/s], aloft [0..1] (0: the water carries the boat, 1: it is in the air), moved (1: another program
//      moves the boat), 0
//   6  mean velocity of the water under the hull as last sampled: x, z, up [m/s]; acceleration ahead by the water's
//      pressure on the hull [m/s^2]
// Positions are those at the end of the tick, speeds and rates those half a tick later (bodies/kick.comp).
#ifndef SPINDRIFT_SHARED_BOATS_H
#define SPINDRIFT_SHARED_BOATS_H

#include "shared/bindings.h"
#include "shared/dual.h"

#define MAX_BOATS 64
// Slots of a scene with a smaller capacity_count: hashes and states on disk contain them.
#define MIN_BOAT_SLOTS 16
#define BOAT_TEXELS 7
// Forces on a hull that another program moves, mean over a tick, per slot in HULL_FORCES: force (x, y, z) over the
// density of water [m^4/s^2], then its moment about the hull's centre (roll, pitch, yaw) [m^5/s^2]; hydrostatic,
// dynamic, drag. The fourth number of the force of drag is 1 over the hull's area [1/m^2]. Others are 0.
#define HULL_FORCE_TEXELS 6
// A new boat reaches its full pressure on the water only after this time, so that it makes no splash.
#define BOAT_SETTLING_S 1.0f
// The pressure of a hull, exp(-a^4 - b^4) in half lengths and half beams, is cut off at this many of them.
#define HULL_REACH 1.6f

#ifdef __cplusplus
namespace spindrift::shared {
struct BoatControl {
  float throttle_ratio;
  float rudder_ratio;
  float unused_x;
  float unused_y;
};
struct BoatControls {
  BoatControl control[MAX_BOATS];
  uint place_count;  // number of slots to check: all boats are below
  uint padding[3];
};
static_assert(sizeof(BoatControls) == 16 * MAX_BOATS + 16);
}  // namespace spindrift::shared
#else
layout(std140, binding = BOAT_CONTROLS) uniform BoatControls {
  vec4 boat_control[MAX_BOATS];
  uint boat_place_count;
};
#endif

#endif
