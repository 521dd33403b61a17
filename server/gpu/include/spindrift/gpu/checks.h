// Test modes of a context: what tests turn on and the server leaves off.
#pragma once

#include <cstdint>
#include <string_view>

#include <spindrift/core/result.h>

namespace spindrift::gpu {

/// All off by default; chosen when the context is made.
struct Checks {
  /// Every access to a buffer is compared with the barriers issued so far; a missing barrier, an unbound block and a
  /// buffer that is smaller than its uniform block are faults. See Context::takeFaults().
  bool barriers = false;
  /// Scratch buffers (BufferContent::kScratch) begin with all bits set, which is NaN as a float and -1 as an integer,
  /// instead of zero. See Context::poisonScratch().
  bool poison = false;
  /// Not 0: work groups of every program are numbered in another order, which this number chooses. What a program
  /// computes must not depend on it.
  std::uint32_t shuffle_seed = 0;
  /// The device seems to lag so many fences behind what was inserted; see FenceDelay.
  std::uint32_t lag_fences_count = 0;
};

/// Parses "barriers", "poison", "shuffle=SEED" (1 to 1,000,000) and "lag=FENCES" (0 to 10,000), separated by
/// commas; an empty text turns nothing on. Error kInvalidInput names the word that is not understood.
core::Result<Checks> parseChecks(std::string_view text);

/// What the environment variable SPINDRIFT_GPU_CHECKS asks for; nothing when it is not set.
core::Result<Checks> checksFromEnvironment();

}  // namespace spindrift::gpu
