// Processor features for hot loops. Where a loop gains from AVX2, its function exists twice from one source: an always
// inlined body, with one caller for any processor and one (SPINDRIFT_VECTORS) for processors where usesVectors() is
// true.
#pragma once

#include <atomic>
#include <cstddef>

#define SPINDRIFT_INLINE __attribute__((always_inline)) inline
#if defined(__x86_64__)
#define SPINDRIFT_HAS_VECTORS 1
#define SPINDRIFT_VECTORS __attribute__((target("avx2,bmi,bmi2")))
#define SPINDRIFT_AVX2 __attribute__((target("avx2"), always_inline)) inline
#else
#define SPINDRIFT_HAS_VECTORS 0
#define SPINDRIFT_VECTORS
#endif

namespace spindrift::codec {

/// Prefetches memory for a later iteration: frames are not in the cache, and hardware prefetching stops at the end of a
/// page.
SPINDRIFT_INLINE void fetchAhead(const void* at) {
  constexpr std::ptrdiff_t kAheadBytes = 2048;
  __builtin_prefetch(static_cast<const char*>(at) + kAheadBytes);
}

/// Returns whether this processor has AVX2 and BMI2.
inline bool hasVectors() {
#if SPINDRIFT_HAS_VECTORS
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi") != 0 &&
         __builtin_cpu_supports("bmi2") != 0;
#else
  return false;
#endif
}
inline std::atomic<bool>& vectorsInUse() {
  static std::atomic<bool> in_use{hasVectors()};
  return in_use;
}

/// Returns whether loops use AVX2 and BMI2: if the processor has them and they were not switched off. The bytes are the
/// same either way.
inline bool usesVectors() {
  return vectorsInUse().load(std::memory_order_relaxed);
}
/// false: only plain loops, even if the processor has more. For tests and measurements; applies to the whole process.
inline void useVectors(bool wanted) {
  vectorsInUse().store(wanted && hasVectors(), std::memory_order_relaxed);
}

}  // namespace spindrift::codec
