// When a room's fidelity falls and rises. Time is a number here.
#include <gtest/gtest.h>

#include <spindrift/rooms/fidelity_governor.h>

namespace spindrift::rooms {
namespace {

using Step = FidelityGovernor::Step;
using G = FidelityGovernor;

class Governor : public testing::Test {
 protected:
  /// Notes the pace ten times per second; returns the first step, or kNone after `for_s`.
  Step run(double for_s, double pace, double load_above = 0.1) {
    for (const double end_s = now_s_ + for_s; now_s_ < end_s - 1e-9;) {
      now_s_ += 0.1;
      const Step step = governor_.note({.now_s = now_s_,
                                        .pace = pace,
                                        .can_fall = level_ > 0,
                                        .can_rise = level_ < top_,
                                        .is_building = is_building_},
                                       [&] {
                                         ++asked_count_;
                                         return load_above;
                                       });
      if (step == Step::kNone) continue;
      return step;
    }
    return Step::kNone;
  }
  void change(Step step) {
    level_ += step == Step::kUp ? 1 : -1;
    governor_.changed(now_s_, step);
  }

  G governor_;
  double now_s_ = 100.0;
  int level_ = 2, top_ = 2;
  bool is_building_ = false;
  int asked_count_ = 0;
};

TEST_F(Governor, FallsByOneLevelWhenTimeHasRunSlowFor5Seconds) {
  EXPECT_EQ(run(4.5, 0.6), Step::kNone);
  EXPECT_EQ(run(1.0, 0.6), Step::kDown);
}

TEST_F(Governor, DoesNotFallForAMomentNorBelowTheLastLevel) {
  for (int k = 0; k < 20; ++k) {
    EXPECT_EQ(run(4.0, 0.5), Step::kNone);
    EXPECT_EQ(run(0.2, 1.0), Step::kNone);
  }
  level_ = 0;
  EXPECT_EQ(run(60.0, 0.5), Step::kNone);
}

TEST_F(Governor, GivesNewWaterTimeBeforeItJudgesIt) {
  ASSERT_EQ(run(10.0, 0.5), Step::kDown);
  change(Step::kDown);
  EXPECT_EQ(run(G::kSettle_s + G::kSlowPatience_s - 0.5, 0.5), Step::kNone);
  EXPECT_EQ(run(1.0, 0.5), Step::kDown);
}

TEST_F(Governor, RisesAfterHalfAMinuteAtFullPaceIfThePredictionLeavesRoom) {
  level_ = 1;
  EXPECT_EQ(run(G::kCalmPatience_s - 0.5, 1.0), Step::kNone);
  EXPECT_EQ(asked_count_, 0) << "the prediction costs something";
  EXPECT_EQ(run(1.0, 1.0), Step::kUp);
  EXPECT_EQ(asked_count_, 1);
}

TEST_F(Governor, DoesNotRiseWherePredictionOrCeilingForbidIt) {
  level_ = 1;
  EXPECT_EQ(run(300.0, 1.0, 0.75), Step::kNone);
  EXPECT_LE(asked_count_, 10) << "it is asked once per wait";
  top_ = 1;
  EXPECT_EQ(run(300.0, 1.0, 0.1), Step::kNone);
}

TEST_F(Governor, WaitsTwiceAsLongAfterARiseThatDidNotHold) {
  level_ = 1;
  double wait_s = G::kCalmPatience_s;
  for (int k = 0; k < 8; ++k) {
    EXPECT_EQ(run(wait_s - 1.0, 1.0), Step::kNone) << k;
    ASSERT_EQ(run(2.0, 1.0), Step::kUp) << k;
    change(Step::kUp);
    ASSERT_EQ(run(20.0, 0.7), Step::kDown) << k;
    change(Step::kDown);
    EXPECT_EQ(run(G::kSettle_s, 1.0), Step::kNone);
    wait_s = std::min(2 * wait_s, G::kCalmPatienceMax_s);
    EXPECT_EQ(governor_.calmPatience_s(), wait_s);
  }
}

TEST_F(Governor, ForgetsTheDoublingWhenARiseHasHeld) {
  level_ = 0;
  ASSERT_EQ(run(60.0, 1.0), Step::kUp);
  change(Step::kUp);
  ASSERT_EQ(run(20.0, 0.7), Step::kDown);
  change(Step::kDown);
  ASSERT_EQ(run(120.0, 1.0), Step::kUp);
  change(Step::kUp);
  top_ = 1;
  EXPECT_EQ(run(G::kHolds_s + 1.0, 1.0), Step::kNone);
  EXPECT_EQ(governor_.calmPatience_s(), G::kCalmPatience_s);
}

TEST_F(Governor, RestsWhilePausedAndWhileWaterIsBuilt) {
  EXPECT_EQ(run(60.0, 0.0), Step::kNone);
  is_building_ = true;
  EXPECT_EQ(run(60.0, 0.4), Step::kNone);
  is_building_ = false;
  EXPECT_EQ(run(G::kSettle_s + G::kSlowPatience_s - 0.5, 0.4), Step::kNone);
  EXPECT_EQ(run(1.0, 0.4), Step::kDown);
}

TEST_F(Governor, AStepThatFailedIsNotTriedAtOnce) {
  ASSERT_EQ(run(10.0, 0.5), Step::kDown);
  governor_.failed(now_s_);
  EXPECT_EQ(run(2 * G::kCalmPatience_s, 0.5), Step::kNone);
  EXPECT_EQ(run(20.0, 0.5), Step::kDown);
}

/// A machine that carries level 1 only: over an hour the level must change ever more rarely.
TEST_F(Governor, DoesNotSwingBetweenTwoLevelsOnAMachineAtItsLimit) {
  int change_count = 0, late_count = 0;
  for (const double end_s = now_s_ + 3600.0; now_s_ < end_s;) {
    const Step step = run(0.1, level_ > 1 ? 0.8 : 1.0, 0.5);
    if (step == Step::kNone) continue;
    change(step);
    ++change_count;
    late_count += now_s_ > end_s - 1200.0 ? 1 : 0;
  }
  // One fall, then seven rises that do not hold: after 30, 60, 120, 240, 480, 960 and 960 s.
  EXPECT_LE(change_count, 15);
  EXPECT_LE(late_count, 4);
}

}  // namespace
}  // namespace spindrift::rooms
