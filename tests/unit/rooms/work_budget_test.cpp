#include <gtest/gtest.h>

#include <spindrift/rooms/command_desk.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;

TEST(WorkBudget, UsesItsShareOfTheTimeAndRepaysOverrunsFirst) {
  WorkBudget budget(0.25, 30ms);
  auto now = WorkBudget::Clock::time_point{} + 1h;
  EXPECT_TRUE(budget.isOpen(now));
  budget.spend(130ms);  // the cost is known only afterwards
  EXPECT_FALSE(budget.isOpen(now += 390ms)) << "97.5 of 100 ms are paid";
  EXPECT_TRUE(budget.isOpen(now += 20ms));
  EXPECT_TRUE(budget.isOpen(now += 1h));
  budget.spend(31ms);
  EXPECT_FALSE(budget.isOpen(now)) << "what is not used does not add up beyond the burst";
}

TEST(WorkBudget, UsesNoMoreThanItsShareInALongRun) {
  WorkBudget budget(0.25, 30ms);
  auto now = WorkBudget::Clock::time_point{} + 1h;
  auto spent = 0ms;
  for (int k = 0; k < 6000; ++k, now += 10ms) {
    if (!budget.isOpen(now)) continue;
    budget.spend(14ms);
    spent += 14ms;
  }
  EXPECT_LE(spent, 15s + 50ms);
  EXPECT_GE(spent, 14s);
}

}  // namespace
}  // namespace spindrift::rooms
