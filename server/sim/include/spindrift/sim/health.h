// What the diagnostics of one tick found.
#pragma once

#include <cstdint>

namespace spindrift::sim {

struct Health {
  std::uint64_t tick = 0;
  std::uint64_t nonfinite_count = 0;  ///< particles and wave cells with a value that is NaN or infinite
  std::uint64_t escaped_count = 0;    ///< particles outside their domain
  double max_speed_mps = 0.0;
  double max_density_ratio = 0.0;  ///< rho / rho0
  double mean_density_ratio = 0.0;
  double kinetic_energy_j = 0.0;    ///< of the particles
  double potential_energy_j = 0.0;  ///< of the particles, against y = 0
  double max_elevation_m = 0.0;
  double wave_volume_m3 = 0.0;  ///< integral of eta
  double wave_energy_j = 0.0;   ///< rho d/2 integral (eta_t^2 + c^2 |grad eta|^2): conserved by the undamped leapfrog
  double breaking_ratio = 0.0;  ///< share of the surface that breaks
  std::int64_t volume_error_units = 0;  ///< of the volume ledger
  double emitted_m3 = 0.0;              ///< water turned into particles since the start
  double absorbed_m3 = 0.0;             ///< particles turned back into water since the start

  [[nodiscard]] bool isGood() const { return nonfinite_count == 0 && escaped_count == 0; }
};

}  // namespace spindrift::sim
