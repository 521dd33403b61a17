// What the content of a device buffer is for beyond the tick that writes it. Each part of WaterSim declares its buffers
// in declareState(); saving, hashing, checkpoints and copies are loops over these declarations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <spindrift/gpu/buffer.h>

namespace spindrift::sim {

/// Every buffer that shaders write is declared, except scratch buffers (gpu::BufferContent::kScratch).
struct StateBuffer {
  gpu::Buffer* buffer = nullptr;
  /// The content continues from one tick to the next: it is saved, restored and hashed. False: each tick leaves the
  /// same words, overwrites them before it reads them, or only counts for diagnostics.
  bool lasts = true;
  /// The watchdog takes it from the last good checkpoint; what lasts without one continues, or WaterSim::recover()
  /// mends it.
  bool checkpoint = false;
  /// StateCopy has it, and resample_state.h continues it at another resolution; other buffers begin anew there.
  bool carried = false;
  /// 4 words per particle: those of live particles count, and in a pool others may lie behind them.
  bool per_particle = false;
  std::size_t first_word_count = 0;  ///< only so many words count, the first ones; 0: all

  /// Number of words that count. `live_count`: of particles.
  [[nodiscard]] std::size_t wordCount(std::size_t live_count) const {
    if (per_particle) return 4 * live_count;
    return first_word_count > 0 ? first_word_count : buffer->sizeBytes() / sizeof(std::uint32_t);
  }
};

using StateBuffers = std::vector<StateBuffer>;

}  // namespace spindrift::sim
