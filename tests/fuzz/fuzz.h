// Shared by the fuzz targets: libFuzzer's entry point, and the report of a failed claim.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

/// Called by libFuzzer for every input; one per target.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace spindrift::fuzz {

/// Ends the process if the claim is false; libFuzzer then keeps the input.
inline void must(bool holds, const char* claim) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", claim);
  std::abort();
}

}  // namespace spindrift::fuzz
