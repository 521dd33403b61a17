// The quick form of `spindrift-study --suite stability`, one test per sweep.
#include <cctype>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <spindrift/study/stability.h>

#include "test_device.h"

namespace spindrift::study {
namespace {

class Stability : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Stability, IsSafeEverywhereAndFoundWherePredicted) {
  auto ctx = gpu::testContext();
  if (!ctx) GTEST_SKIP() << "no device: " << ctx.error().message;
  const Sweep sweep = stabilitySweeps(true)[GetParam()];
  std::vector<StabilityPoint> points;
  for (const double value : sweep.values) {
    auto point = runPoint(**ctx, sweep, value);
    ASSERT_TRUE(point) << point.error().message;
    EXPECT_EQ(point->refused, "") << value << " " << sweep.unit;
    EXPECT_TRUE(point->are_frames_finite) << value << " " << sweep.unit;
    EXPECT_TRUE(point->is_well_after) << value << " " << sweep.unit;
    points.push_back(*std::move(point));
  }
  if (!sweep.predicted_bound) {
    for (const StabilityPoint& point : points) EXPECT_TRUE(point.is_stable) << point.value << " " << sweep.unit;
    return;
  }
  EXPECT_FALSE(points.back().is_stable) << "the sweep does not reach the edge";
  const auto found = foundBound(points);
  ASSERT_TRUE(found) << "not even the smallest value is stable";
  EXPECT_LE(std::abs(std::log(*found / *sweep.predicted_bound)), std::log(1.5))
      << "predicted " << *sweep.predicted_bound << ", found " << *found;
}

INSTANTIATE_TEST_SUITE_P(Sweeps, Stability, ::testing::Range(std::size_t{0}, stabilitySweeps(true).size()),
                         [](const auto& parameter) {
                           std::string name = stabilitySweeps(true)[parameter.param].name;
                           std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0; });
                           return name;
                         });

}  // namespace
}  // namespace spindrift::study
