#include <gtest/gtest.h>

#include <spindrift/rooms/room_host.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
using Wall = std::chrono::system_clock::time_point;
using Steady = std::chrono::steady_clock::time_point;

TEST(ClockWatch, ReportsAStepForwardAndBackOnceEach) {
  ClockWatch watch;
  EXPECT_FALSE(watch.step(Wall(1000s), Steady(10s)));
  EXPECT_FALSE(watch.step(Wall(1001s), Steady(11s)));
  const auto forward = watch.step(Wall(1002s + 5h), Steady(12s));
  ASSERT_TRUE(forward);
  EXPECT_DOUBLE_EQ(forward->count(), 18000.0);
  EXPECT_FALSE(watch.step(Wall(1003s + 5h), Steady(13s)));
  const auto back = watch.step(Wall(1004s), Steady(14s));
  ASSERT_TRUE(back);
  EXPECT_DOUBLE_EQ(back->count(), -18000.0);
}

TEST(ClockWatch, IgnoresPausesOfTheProgramAndCorrections) {
  ClockWatch watch;
  EXPECT_FALSE(watch.step(Wall(1000s), Steady(10s)));
  EXPECT_FALSE(watch.step(Wall(4600s), Steady(3610s))) << "the program stood still for an hour";
  EXPECT_FALSE(watch.step(Wall(4601s + 500ms), Steady(3611s)));
}

}  // namespace
}  // namespace spindrift::rooms
