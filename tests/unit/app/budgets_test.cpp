// What ticks and heavy commands may cost.
#include <gtest/gtest.h>

#include "tick_cost.h"
#include "work_budget.h"

namespace spindrift::app {
namespace {

using namespace std::chrono_literals;

TEST(WorkBudget, TakesItsShareOfTheTimeAndPaysDebtsFirst) {
  WorkBudget budget(0.25, 30ms);
  auto now = WorkBudget::Clock::time_point{} + 1h;
  EXPECT_TRUE(budget.isOpen(now));
  budget.spend(130ms);  // known afterwards only
  EXPECT_FALSE(budget.isOpen(now += 390ms)) << "97.5 of 100 ms are paid";
  EXPECT_TRUE(budget.isOpen(now += 20ms));
  EXPECT_TRUE(budget.isOpen(now += 1h));
  budget.spend(31ms);
  EXPECT_FALSE(budget.isOpen(now)) << "what is not used does not add up beyond the burst";
}

TEST(WorkBudget, TakesNoMoreThanItsShareInALongRun) {
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

TEST(TickCost, GrowsWithTheDearerPart) {
  TickCost cost;
  EXPECT_EQ(cost.predict_ms({}, {}), 0.0) << "before any tick";
  cost.note(10.0);
  const TickWork now{.particle_step_count = 1000, .wave_step_count = 500};
  EXPECT_DOUBLE_EQ(cost.predict_ms(now, {.particle_step_count = 3000, .wave_step_count = 500}), 30.0);
  EXPECT_DOUBLE_EQ(cost.predict_ms(now, {.particle_step_count = 1000, .wave_step_count = 2000}), 40.0);
  EXPECT_DOUBLE_EQ(cost.predict_ms(now, {.particle_step_count = 1, .wave_step_count = 1}), 10.0);
}

}  // namespace
}  // namespace spindrift::app
