// Work on all processors: every part once, whatever their number.
#include <atomic>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/core/parallel.h>

namespace spindrift::core {
namespace {

TEST(Parallel, EveryPartIsDoneOnce) {
  for (const std::size_t count : {0u, 1u, 2u, 63u, 1000u}) {
    std::vector<std::atomic<int>> done(count);
    forEachInParallel(count, [&](std::size_t i) { ++done[i]; });
    for (const auto& times : done) EXPECT_EQ(times, 1) << count;
  }
}

TEST(Parallel, RangesCoverEverythingOnce) {
  for (const std::size_t count : {0u, 1u, 7u, 65u, 1001u}) {
    std::vector<std::atomic<int>> done(count);
    forRangesInParallel(count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++done[i];
    });
    for (const auto& times : done) EXPECT_EQ(times, 1) << count;
  }
}

}  // namespace
}  // namespace spindrift::core
