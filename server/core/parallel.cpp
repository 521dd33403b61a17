#include <algorithm>
#include <atomic>
#include <system_error>
#include <thread>
#include <vector>

#include <spindrift/core/parallel.h>

namespace spindrift::core {
namespace {

/// Threads beyond this bring little to tables of a few million cells.
constexpr std::size_t kMaxThreads = 16;
/// Ranges per thread, so that one that is slow or late leaves its share to others.
constexpr std::size_t kRangesPerThread = 4;

std::size_t threadCount() {
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, kMaxThreads);
}

}  // namespace

void forEachInParallel(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  const auto loop = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> others(std::min(threadCount(), std::max<std::size_t>(count, 1)) - 1);
  try {
    for (std::jthread& thread : others) thread = std::jthread(loop);
  } catch (const std::system_error&) {
    // No more threads are allowed: those that run share the work.
  }
  loop();
}

void forRangesInParallel(std::size_t count, const std::function<void(std::size_t, std::size_t)>& work) {
  const std::size_t ranges = std::min(count, threadCount() * kRangesPerThread);
  forEachInParallel(ranges, [&](std::size_t i) { work(i * count / ranges, (i + 1) * count / ranges); });
}

}  // namespace spindrift::core
