// A gauge that a person has put into the water of a room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include <spindrift/sim/gauge_history.h>

namespace spindrift::rooms {

/// Limit per person. The limit per room, with the gauges of its scene, is core::kMaxGauges.
inline constexpr std::size_t kPersonMaxGauges = 4;

struct PlacedGauge {
  std::uint32_t gauge_id = 0;  ///< not used again in the room
  std::uint32_t person_id = 0;
  std::string name{};  ///< made by the server; that of no gauge of the scene
  double x_m = 0.0;
  double z_m = 0.0;
  std::shared_ptr<const sim::GaugeHistory> history{};  ///< of this gauge alone, since it was placed
};

}  // namespace spindrift::rooms
