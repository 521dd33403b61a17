// Fixed data of a boat, sent to clients once; its position is in the frames.
#pragma once

#include <cstdint>

namespace spindrift::sim {

struct BoatRecord {
  std::uint32_t boat_id = 0;
  double length_m = 0.0;
  double beam_m = 0.0;
  double height_m = 0.0;
  double draught_m = 0.0;  ///< at rest: height times density ratio
};

}  // namespace spindrift::sim
