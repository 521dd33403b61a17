// Health and energies of the room, from one small reduction per tick. Results arrive some ticks later; nothing waits
// for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include <spindrift/core/scene.h>
#include <spindrift/sim/health.h>
#include <spindrift/sim_setup/derive.h>

#include "boats.h"
#include "breakers.h"
#include "creation.h"
#include "floaters.h"
#include "neighbor_grid.h"
#include "particle_buffers.h"
#include "particle_pool.h"
#include "wave.h"

namespace spindrift::sim {

/// Density that weights of water are told with.
[[nodiscard]] double waterDensity_kgpm3(const core::Scene& scene);

class Diagnostics {
 public:
  Diagnostics(Creation& create, const core::Scene& scene, const Derived& derived);

  /// Replaces the buffers for another number of particles and keeps the programs. Results in flight are lost. An error
  /// changes nothing.
  void resize(Creation& create, const Derived& derived);

  /// Measures at these positions, beside the gauges of the scene, from the next measure() on; replaces those before.
  /// Together they are at most core::kMaxGauges. An error changes nothing.
  void placeGauges(Creation& create, const core::Scene& scene, const WaveLayout& layout,
                   std::span<const GaugePlace> places);

  /// Measures the state after `tick`; absent parts are null. What the sums mean is noted with them, because parameters
  /// may change before poll() returns the result. There is one slot per tick that may be in flight (TicksInFlight), so
  /// every tick is measured if poll() is called before each call.
  void measure(std::uint64_t tick, const core::Scene& scene, const Derived& derived, const ParticleBuffers* particles,
               const Population* population, const NeighborGrid* grid, Wave* wave, Breakers* breakers,
               const Boats* boats, const Floaters* floaters);
  /// Returns the results that have arrived, oldest first.
  std::vector<Health> poll();

 private:
  /// Values that turn the sums of a tick in flight into SI units.
  struct Scale {
    std::uint64_t tick = 0;
    double gravity_mps2 = 0.0;
    double density_kgpm3 = 0.0;  ///< at rest
    double particle_mass_kg = 0.0;
    double cell_area_m2 = 0.0;
    std::int64_t droplet_units = 0;
    std::int64_t resting_units = 0;  ///< Wave::restingUnits()
    std::size_t scene_gauge_count = 0;
    std::vector<std::uint32_t> placed_ids{};  ///< of the gauges that follow those of the scene
  };

  // Offsets in a slot [bytes]: words of the pool, and behind them readings of the gauges.
  [[nodiscard]] std::size_t poolOffset() const;
  [[nodiscard]] std::size_t gaugeOffset() const;

  gpu::Context& ctx_;
  std::uint32_t particle_shares_ = 0;
  std::uint32_t surface_shares_ = 0;
  std::uint32_t cells_ = 0;
  std::uint32_t particles_ = 0;
  bool is_pooled_ = false;
  std::deque<Scale> in_flight_;       ///< of the slots that poll() has not returned, oldest first
  std::uint32_t crowded_before_ = 0;  ///< NeighborGrid::crowded() of the last result
  gpu::Buffer particle_sums_, surface_sums_;
  // Gauges; empty until there is one: their places, and 4 floats per gauge, as shaders/diagnostics/gauges.comp writes
  // them.
  gpu::Buffer gauge_places_, gauge_readings_;
  std::vector<std::uint32_t> placed_ids_;
  Pass particle_pass_, surface_pass_, gauge_pass_;
  std::unique_ptr<gpu::ReadbackRing> ring_;
};

}  // namespace spindrift::sim
