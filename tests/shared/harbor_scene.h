// The text of a small scene with every part that has a state.
#pragma once

namespace spindrift {

/// Waves that break, spray, foam, a boat, an object and weather.
inline constexpr const char* kHarbor = R"(
  wave { resolution_count: 48 side_m: 12 depth_m: 1 bulk: BULK_NONLINEAR dispersion: DISPERSION_AIRY
         boundary_minus_x: WAVE_BOUNDARY_ABSORB boundary_plus_x: WAVE_BOUNDARY_REFLECT
         boundary_minus_z: WAVE_BOUNDARY_REFLECT boundary_plus_z: WAVE_BOUNDARY_REFLECT }
  particles { count: 1000 headroom_m: 3 }
  coupling { mode: COUPLING_MODE_TWO_WAY droplet_spacing_m: 0.15 }
  foam { surface: true }
  boats { capacity_count: 4 boats { x_m: 2 throttle_ratio: 0.5 } }
  floaters { floaters { x_m: 3 } }
  storm { level_ratio: 0.6 wind_direction_deg: 10 }
)";

}  // namespace spindrift
