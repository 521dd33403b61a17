// Sizes of packed frames: what FramePacker writes, and what derive() counts.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <spindrift/core/level.h>
#include <spindrift/core/scene.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/sim_setup/scene_parts.h>

namespace spindrift::sim {

inline constexpr std::size_t kFrameSlotCount = 4;  ///< one being filled, one in flight, one at the encoder, one spare
/// Number of packed particles, number of live particles.
inline constexpr std::size_t kParticleHeaderWords = 2;
inline constexpr std::size_t kWordsPerParticle = 3;
inline constexpr std::size_t kWordsPerBody = 7;  ///< boat or floater

inline std::size_t surfaceWords(core::CellCounts count) {
  return (count.total() + 1) / 2;
}
inline std::size_t foamWords(core::CellCounts count) {
  return (count.total() + 3) / 4;
}
inline std::size_t particleWords(std::uint32_t count) {
  return kParticleHeaderWords + std::size_t{count} * kWordsPerParticle;
}

/// Returns the bytes of a slot, which has room for all levels at once.
inline std::size_t frameSlotBytes(const core::Scene& scene, const Derived& derived) {
  const core::CellCounts surface = derived.wave ? derived.wave->counts() : core::CellCounts{};
  const std::uint32_t particles = derived.particles ? derived.particles->count : 0;
  const core::ReducedCounts reduced = core::reducedCounts(surface, particles);
  std::size_t words = kWordsPerBody * (std::size_t{scene.boats ? scene.boats->capacity_count : 0u} +
                                       (scene.floaters ? scene.floaters->capacity_count : 0u));
  for (const core::Level level : core::kLevels) {
    if (core::isSent(level, reduced.planes)) {
      const core::CellCounts samples = core::surfaceSamples(surface, level);
      words += surfaceWords(samples) + (hasSurfaceFoam(scene) ? foamWords(core::foamSamples(samples)) : 0);
    }
    if (particles > 0 && core::isSent(level, reduced.particles))
      words += particleWords(std::min(particles, core::budgetOf(level).particle_count));
  }
  return 4 * words;
}

}  // namespace spindrift::sim
