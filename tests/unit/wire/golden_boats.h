// The boats of the golden messages.
#pragma once

#include <cstdint>
#include <vector>

#include <spindrift/v1/wire.pb.h>

namespace spindrift::wire {

/// One boat at rest at the origin; one far out, at both ends of its angles, going astern with the rudder hard over.
inline std::vector<std::uint32_t> goldenBodyWords() {
  const auto half = [](int low, int high) {
    return static_cast<std::uint32_t>(static_cast<std::uint16_t>(low)) |
           static_cast<std::uint32_t>(static_cast<std::uint16_t>(high)) << 16;
  };
  const auto mm = [](std::int32_t value) { return static_cast<std::uint32_t>(value); };
  std::vector<std::uint32_t> words = {1, 0, 0, 0, 0, 0, 0};
  words.insert(words.end(),
               {7, mm(12'345), mm(-250), mm(-100'000), half(32767, -16384), half(-32767, -1234), 0x0000'7F81u});
  return words;
}

inline v1::BoatList goldenBoats() {
  v1::BoatList list;
  v1::BoatInfo& boat = *list.add_boats();
  boat.set_boat_id(7);
  boat.set_length_m(2.5);
  boat.set_beam_m(1);
  boat.set_height_m(0.75);
  boat.set_draught_m(0.375);
  return list;
}

inline constexpr const char* kGoldenBoatsJson =
    "[{\"boat_id\": 7, \"length_m\": 2.5, \"beam_m\": 1, \"height_m\": 0.75, \"draught_m\": 0.375}]";

}  // namespace spindrift::wire
