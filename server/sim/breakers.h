// Where the wave breaks (Kennedy et al. 2000), computed once per tick: the wave loses flow there and produces spray and
// foam.
#pragma once

#include <spindrift/sim_setup/derive.h>

#include "creation.h"
#include "particle_pool.h"
#include "wave.h"

namespace spindrift::sim {

class Breakers {
 public:
  Breakers(Creation& create, const WaveLayout& layout);

  void clear();
  void declareState(StateBuffers& out) { out.push_back({.buffer = &now_, .checkpoint = true, .carried = true}); }
  /// Call it after Wave::sampleSurface(). `pool` receives the list of emitting cells; null except in two-way scenes.
  void update(const Wave& wave, const ParticlePool* pool, std::uint32_t tick);

  /// nx x nz: seconds since the breaking event began, intensity 0..1, velocity of a splash's crown (x, z) [m/s].
  [[nodiscard]] gpu::TexelBuffer& state() { return now_; }

 private:
  core::CellCounts count_;
  gpu::TexelBuffer now_, before_;
  Pass pass_;
};

}  // namespace spindrift::sim
