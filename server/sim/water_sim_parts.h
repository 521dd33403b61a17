// The parts of a WaterSim. Only for its own source files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <spindrift/effects/effects.h>
#include <spindrift/sim/water_sim.h>
#include <spindrift/sim_setup/basin_store.h>

#include "boats.h"
#include "breakers.h"
#include "checkpoints.h"
#include "creation.h"
#include "diagnostics.h"
#include "floaters.h"
#include "frame_packer.h"
#include "neighbor_grid.h"
#include "particle_buffers.h"
#include "particle_pool.h"
#include "patch_follower.h"
#include "solvers.h"
#include "stir.h"
#include "surface_foam.h"
#include "surface_points.h"
#include "ticks_in_flight.h"
#include "wave.h"
#include "wind_sea.h"

namespace spindrift::sim {

/// The uniforms that states contain, whatever the scene: those of surface tension are behind them and follow from it.
inline constexpr std::size_t kUniformWordsBeforeTension =
    offsetof(shared::SimUniforms, capillary_ratio) / sizeof(std::uint32_t);

/// The parts that the scene names; all others are null.
struct WaterSim::Parts {
  explicit Parts(gpu::Context& ctx);

  gpu::Buffer uniforms;
  std::optional<ParticleBuffers> particles;
  std::unique_ptr<NeighborGrid> grid;
  std::unique_ptr<Sph> sph;  ///< one of the two solvers
  std::unique_ptr<PositionBased> position_based;
  std::unique_ptr<Wave> wave;
  Effects effects;
  std::unique_ptr<WindSea> wind_sea;  ///< in scenes with a storm whose waves come in at the sides
  std::unique_ptr<Breakers> breakers;
  std::unique_ptr<ParticlePool> pool;
  std::unique_ptr<Boats> boats;
  std::unique_ptr<Floaters> floaters;
  std::unique_ptr<SurfaceFoam> foam;
  std::unique_ptr<PatchFollower> follower;
  std::unique_ptr<Stir> stir;  ///< in scenes without a wave
  std::unique_ptr<FramePacker> frames;
  std::unique_ptr<Diagnostics> diagnostics;
  std::unique_ptr<SurfacePoints> points;  ///< from the first question on
  std::unique_ptr<Checkpoints> checkpoints;
  TicksInFlight ticks_in_flight;
  std::vector<float> settled_positions;        ///< starting positions; empty: the lattice
  std::vector<float> starting_positions;       ///< the lattice; computed when first needed
  std::optional<ParticleLayout> start_layout;  ///< of starting_positions
  double start_jitter_ratio = 0.0;             ///< likewise
  std::uint64_t start_seed = 0;                ///< likewise
  std::optional<BasinInputs> basin_inputs;     ///< inputs of the wave's present tables

  /// Starting positions, 4 floats per particle.
  const std::vector<float>& startOf(const core::Scene& scene, const ParticleLayout& layout);

  /// Sizes of the dispatches over particles.
  [[nodiscard]] Population population(const Derived& derived) const { return {derived.particles->count, pool.get()}; }
  [[nodiscard]] ParticleBuffers* particlesOrNull() { return particles ? &*particles : nullptr; }
  /// Returns the buffers that the parts declare.
  StateBuffers stateBuffers();
  /// Number of live particles. Waits in two-way scenes.
  [[nodiscard]] std::size_t liveCount(const Derived& derived) const;
  /// Sets the pressure of hulls and floaters for the next tick, and no other: what the tick before has set belongs to
  /// another gravity or grid.
  void pressBodies();
  void makeCheckpoints(Creation& create);
  /// Replaces everything whose size depends on the number of particles; programs stay. After an error the particles are
  /// the old ones, and other parts may have either size: call resizeBack().
  core::Result<void> resize(gpu::Context& ctx, const core::Scene& scene, const Derived& derived);
  /// Call it after resize() failed; `derived` is that of the old size.
  core::Result<void> resizeBack(gpu::Context& ctx, const core::Scene& scene, const Derived& derived);
  void resizeOthers(Creation& create, const core::Scene& scene, const Derived& derived);
};

}  // namespace spindrift::sim
