#include <gtest/gtest.h>
#include <sys/resource.h>

#include "connection_set.h"

namespace spindrift::net {
namespace {

using namespace std::chrono_literals;

/// Restores the soft limit of open files.
class Descriptors : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before_), 0); }
  void TearDown() override { setrlimit(RLIMIT_NOFILE, &before_); }
  static rlim_t soft() {
    rlimit now{};
    getrlimit(RLIMIT_NOFILE, &now);
    return now.rlim_cur;
  }
  void setSoft(rlim_t count) const {
    rlimit now = before_;
    now.rlim_cur = count;
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &now), 0);
  }
  rlimit before_{};
};

TEST_F(Descriptors, RaiseTheSoftLimitAsFarAsConnectionsNeedIt) {
  if (before_.rlim_max < 400) GTEST_SKIP() << "the hard limit is " << before_.rlim_max;
  setSoft(50);
  EXPECT_EQ(limitConnections(200, 64), 200u);
  EXPECT_GE(soft(), 264u);
  EXPECT_LT(soft(), 400u) << "no more than is needed";
}

TEST_F(Descriptors, BeyondTheHardLimitLeaveFewerConnectionsButOne) {
  const rlim_t hard_count = before_.rlim_max;
  if (hard_count == RLIM_INFINITY) GTEST_SKIP() << "there is no hard limit";
  const std::size_t left_count = limitConnections(2 * hard_count, 64);
  EXPECT_LT(left_count, hard_count - 64);
  EXPECT_GT(left_count, hard_count / 2);
  EXPECT_EQ(soft(), hard_count);
  EXPECT_EQ(limitConnections(10, 2 * hard_count), 1u);
}

TEST(RareLine, IsDueAtTheFirstTimeAndThenOncePerIntervalWithTheCount) {
  RareLine line;
  const RareLine::Clock::time_point begin{};
  EXPECT_EQ(line.count(begin), 1u);
  for (int k = 1; k < 100; ++k) EXPECT_FALSE(line.count(begin + k * 50ms));
  EXPECT_EQ(line.count(begin + RareLine::kInterval), 100u);
  EXPECT_FALSE(line.count(begin + RareLine::kInterval + 1s));
}

}  // namespace
}  // namespace spindrift::net
