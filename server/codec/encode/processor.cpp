#include "processor.h"

#include <atomic>

namespace spindrift::codec {
namespace {

bool hasVectors() {
#if SPINDRIFT_HAS_VECTORS
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("bmi") != 0 &&
         __builtin_cpu_supports("bmi2") != 0;
#else
  return false;
#endif
}

std::atomic<bool>& vectors() {
  static std::atomic<bool> in_use{hasVectors()};
  return in_use;
}

}  // namespace

bool usesVectors() {
  return vectors().load(std::memory_order_relaxed);
}

void useVectors(bool wanted) {
  vectors().store(wanted && hasVectors(), std::memory_order_relaxed);
}

}  // namespace spindrift::codec
