// What frames show a client, compared with what a step of a script expects.
#pragma once

#include <cstdint>
#include <string>

#include "script_client.h"

namespace spindrift::script {

struct Seen {
  bool is_wanted = false;
  std::string what;  ///< one line for the report
};

// Each looks at the newest frame of its layer.
[[nodiscard]] Seen seenSurface(const v1::ExpectSurface& step, Received& received);
[[nodiscard]] Seen seenGauge(const v1::ExpectGauge& step, const Received& received);
/// `boat_id`: of the boat that the step names.
[[nodiscard]] Seen seenBoat(const v1::ExpectBoat& step, std::uint32_t boat_id, Received& received);
[[nodiscard]] Seen seenParticles(const v1::ExpectParticles& step, Received& received);

}  // namespace spindrift::script
