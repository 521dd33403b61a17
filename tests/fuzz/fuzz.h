// What the fuzz targets share: libFuzzer's entry point, and how a target says what does not hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

/// Called by libFuzzer for every input; one a target.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace spindrift::fuzz {

/// Ends the process where a claim does not hold; libFuzzer keeps the input.
inline void must(bool holds, const char* claim) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", claim);
  std::abort();
}

}  // namespace spindrift::fuzz
