// Small scenes of the tests that kill servers, and the environment variables that make these longer.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

namespace spindrift::test {

/// Spray that comes and goes, rain, foam, boats.
inline constexpr const char* kPool = R"(
  wave { resolution_count: 32 side_m: 8 depth_m: 1 }
  particles { count: 512 headroom_m: 2 }
  coupling { mode: COUPLING_MODE_TWO_WAY droplet_spacing_m: 0.2 }
  foam { surface: true }
  boats { capacity_count: 8 boats { x_m: 1 z_m: 1 length_m: 1.2 beam_m: 0.5 } }
  storm { level_ratio: 0.3 }
  events { at_s: 0.5 every_s: 1.5 effect { splash { x_m: -1 radius_m: 1 depth_m: 0.7 } } }
)";
/// A lattice of particles, whose number can change.
inline constexpr const char* kTank = R"(
  wave { resolution_count: 32 side_m: 8 depth_m: 1 }
  particles { count: 256 layers_count: 2 headroom_m: 2 }
  coupling {}
  foam {}
  boats { capacity_count: 4 }
)";
/// Waves that come in from the sea, short ones slower than long ones.
inline constexpr const char* kSea = R"(
  wave {
    resolution_count: 32 side_m: 8 depth_m: 1 dispersion: DISPERSION_AIRY sponge_width_m: 1
    boundary_minus_x: WAVE_BOUNDARY_ABSORB boundary_plus_x: WAVE_BOUNDARY_ABSORB
  }
  boats { capacity_count: 4 }
  storm { level_ratio: 0.5 wind_direction_deg: 0 }
)";

/// A number in the environment.
inline std::uint64_t variableOr(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text != nullptr && *text != '\0' ? std::stoull(text) : otherwise;
}

}  // namespace spindrift::test
