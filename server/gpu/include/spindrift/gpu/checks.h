// Test modes of a context: on in tests, off in the server.
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
  /// Scratch buffers (BufferContent::kScratch) start with all bits set (NaN as a float, -1 as an integer) instead of
  /// zero. See Context::poisonScratch().
  bool poison = false;
  /// Every dispatch is timed on the device, and the context's end logs the programs by their share. Dispatches do not
  /// overlap.
  bool times = false;
  /// Not 0: seed of a permutation of the work groups of every program. The results of a program must not depend on it.
  std::uint32_t shuffle_seed = 0;
  /// The device appears to be this many fences behind; see FenceDelay.
  std::uint32_t lag_fences_count = 0;
  /// Not 0: the device appears to have memory for this many MiB of buffers per context; making more fails as on a full
  /// device.
  std::uint32_t memory_mib = 0;
};

/// Parses "barriers", "poison", "times", "shuffle=SEED" (1 to 1,000,000), "lag=FENCES" (0 to 10,000) and "memory=MIB"
/// (1 to 1,000,000), separated by commas; an empty text turns all modes off. Error kInvalidInput names the word that is
/// not understood.
core::Result<Checks> parseChecks(std::string_view text);

/// Parses the environment variable SPINDRIFT_GPU_CHECKS; all modes are off when it is not set.
core::Result<Checks> checksFromEnvironment();

}  // namespace spindrift::gpu
