#include <numeric>

#include <gtest/gtest.h>

#include <spindrift/rooms/tick_meter.h>

namespace spindrift::rooms {
namespace {

TEST(TickTimes, ADurationIsInTheBucketWhoseBoundItDoesNotExceed) {
  TickTimes times;
  times.note(0.0);
  times.note(TickTimes::kBounds_s[0]);
  times.note(0.5 * (TickTimes::kBounds_s[3] + TickTimes::kBounds_s[4]));
  times.note(2.0 * TickTimes::kBounds_s.back());
  EXPECT_EQ(times.counts()[0], 2u);
  EXPECT_EQ(times.counts()[4], 1u);
  EXPECT_EQ(times.counts().back(), 1u);
  EXPECT_EQ(std::accumulate(times.counts().begin(), times.counts().end(), std::uint64_t{0}), 4u);
  EXPECT_DOUBLE_EQ(times.sum_s(), TickTimes::kBounds_s[0] + 0.5 * (TickTimes::kBounds_s[3] + TickTimes::kBounds_s[4]) +
                                      2.0 * TickTimes::kBounds_s.back());
}

TEST(TickTimes, HasBoundsInOrder) {
  for (std::size_t k = 1; k < TickTimes::kBounds_s.size(); ++k)
    EXPECT_LT(TickTimes::kBounds_s[k - 1], TickTimes::kBounds_s[k]);
}

}  // namespace
}  // namespace spindrift::rooms
