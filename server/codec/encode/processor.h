// What loops may count on. Where a loop gains from it, its function is there twice, written once: the body always
// inlined, one caller for any processor and one (SPINDRIFT_VECTORS) for those that usesVectors() is true on.
#pragma once

#include <cstddef>

#define SPINDRIFT_INLINE __attribute__((always_inline)) inline
#if defined(__x86_64__)
#define SPINDRIFT_HAS_VECTORS 1
#define SPINDRIFT_VECTORS __attribute__((target("avx2,bmi,bmi2")))
#else
#define SPINDRIFT_HAS_VECTORS 0
#define SPINDRIFT_VECTORS
#endif

namespace spindrift::codec {

/// Asks for memory that a loop comes to soon: frames lie far away, and processors look ahead only to the end of a page.
SPINDRIFT_INLINE void fetchAhead(const void* at) {
  constexpr std::ptrdiff_t kAheadBytes = 2048;
  __builtin_prefetch(static_cast<const char*>(at) + kAheadBytes);
}

/// Whether loops take AVX2 and BMI2: where the processor has them, unless they were switched off. Both ways give the
/// same bytes.
bool usesVectors();
/// false: plain loops only, also where the processor has more. For tests and measurements; of the whole process.
void useVectors(bool wanted);

}  // namespace spindrift::codec
