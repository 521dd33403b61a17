// Results of the diagnostics of one tick.
#pragma once

#include <cstdint>
#include <vector>

#include <spindrift/sim/gauge_history.h>

namespace spindrift::sim {

struct Health {
  std::uint64_t tick = 0;
  /// Particles, boats and wave cells with a value that is NaN, infinite or beyond its range (fixed_point.h).
  std::uint64_t nonfinite_count = 0;
  std::uint64_t escaped_count = 0;   ///< particles outside their domain
  std::uint32_t particle_count = 0;  ///< alive
  /// Particles, summed over the substeps since the previous health, with more neighbour candidates than the search
  /// limit (SimUniforms::candidates_max_count), so that some were not visited. 0 in physically plausible water.
  std::uint32_t crowded_count = 0;
  double max_speed_mps = 0.0;
  double max_density_ratio = 0.0;  ///< rho / rho0
  double mean_density_ratio = 0.0;
  double kinetic_energy_j = 0.0;    ///< of the particles
  double potential_energy_j = 0.0;  ///< of the particles, against y = 0
  double max_elevation_m = 0.0;
  double wave_volume_m3 = 0.0;  ///< integral of eta
  double wave_energy_j = 0.0;   ///< rho/2 integral (g eta^2 + q^2/d): conserved by the undamped linear leapfrog
  double breaking_ratio = 0.0;  ///< share of the cells that are breaking

  // The volume ledger, in units of shaders/shared/fixed_point.h times a cell's area.
  std::int64_t surface_units = 0;       ///< sum of the elevations, without dry ground above the still water
  std::int64_t outflow_units = 0;       ///< volume lost through absorbing sides since the start
  std::int64_t volume_error_units = 0;  ///< surface + outflow + particles of a two-way scene - initial volume: always 0

  // Two-way scenes, since the start.
  std::uint32_t emitted_count = 0;       ///< particles made by breaking water
  std::uint32_t absorbed_count = 0;      ///< particles returned to the surface
  std::uint32_t pool_refused_count = 0;  ///< substeps in which the pool was full
  double emitted_m3 = 0.0;               ///< the emitted particles as volume
  double absorbed_m3 = 0.0;

  std::vector<GaugeReading> gauges;            ///< one per gauge of the scene
  std::vector<PlacedReading> placed_gauges{};  ///< of WaterSim::placeGauges(), as they were at this tick

  [[nodiscard]] bool isGood() const { return nonfinite_count == 0 && escaped_count == 0; }
};

}  // namespace spindrift::sim
