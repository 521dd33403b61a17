#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/effects/effects.h>

namespace spindrift::sim {
namespace {

constexpr double kStep_s = 0.01;
constexpr StrokeWater kWater{.dt_s = kStep_s, .cell_m = 0.1};

StrokePart part(std::vector<StrokePoint> points, bool ends = false, std::uint32_t stroke_id = 1,
                std::uint32_t person_id = 7, StrokeTool tool = StrokeTool::kFinger) {
  return {.person_id = person_id,
          .stroke_id = stroke_id,
          .radius_m = 0.5,
          .depth_m = 0.2,
          .points = std::move(points),
          .ends = ends,
          .tool = tool};
}

/// A finger that moves along x with 1 m/s, from time to time.
std::vector<StrokePoint> line(double from_s, double to_s, double every_s = 0.02) {
  std::vector<StrokePoint> out;
  for (double t = from_s; t < to_s - 1e-9; t += every_s) out.push_back({t, t, 0.0, 1.0});
  return out;
}

shared::EventUniforms stepOf(Strokes& strokes) {
  shared::EventUniforms out{};
  strokes.advance(kWater, out);
  return out;
}

TEST(Strokes, LeaveNothingBehindInTheSumOfTheirSplashes) {
  Strokes strokes;
  ASSERT_TRUE(strokes.add(part(line(0.0, 1.0), true)));
  double sum_m = 0.0, pressed_m = 0.0;
  int step_count = 0;
  for (; !strokes.active().empty(); ++step_count) {
    ASSERT_LT(step_count, 1000);
    const auto out = stepOf(strokes);
    for (std::uint32_t k = 0; k < out.splash_count; ++k) {
      sum_m += out.splashes[k].gain_m;
      pressed_m = std::min(pressed_m, sum_m);
    }
  }
  EXPECT_NEAR(sum_m, 0.0, 1e-6);
  EXPECT_NEAR(pressed_m, -0.2, 1e-6) << "the full depth in between";
}

TEST(Strokes, TraceDoesNotDependOnTheRhythmOfTheMessages) {
  const auto trace = [](double every_s, double late_s) {
    Strokes strokes;
    std::vector<double> out;
    double sent_s = 0.0;
    const std::vector<StrokePoint> points = line(0.0, 1.0, 0.01);
    for (double now_s = 0.0; now_s < 1.3; now_s += kStep_s) {
      if (now_s >= sent_s + every_s - late_s && sent_s < 1.0 - 1e-9) {
        std::vector<StrokePoint> some;
        for (const StrokePoint& p : points)
          if (p.time_s >= sent_s - 1e-9 && p.time_s < sent_s + every_s - 1e-9) some.push_back(p);
        sent_s += every_s;
        EXPECT_TRUE(strokes.add(part(std::move(some), sent_s >= 1.0 - 1e-9)));
      }
      stepOf(strokes);
      if (strokes.active().size() == 1 && strokes.active()[0].x_m > 0.3 && strokes.active()[0].x_m < 0.8)
        out.push_back(strokes.active()[0].x_m);
    }
    return out;
  };
  for (const double every_s : {0.02, 0.03, 0.05}) {
    const std::vector<double> xs_m = trace(every_s, 0.0);
    ASSERT_GT(xs_m.size(), 30u) << every_s;
    for (std::size_t k = 1; k < xs_m.size(); ++k)
      EXPECT_NEAR(xs_m[k] - xs_m[k - 1], kStep_s, 0.26 * kStep_s) << "message every " << every_s << " s, step " << k;
  }
}

TEST(Strokes, RestingFingerMovesNoWater) {
  Strokes strokes;
  ASSERT_TRUE(strokes.add(part({{0.0, 1.0, 2.0, 1.0}})));
  std::uint32_t count = 0;
  for (int k = 0; k < 100; ++k) count += stepOf(strokes).splash_count;
  EXPECT_GT(count, 0u) << "it presses at first";
  for (int k = 0; k < 90; ++k) EXPECT_EQ(stepOf(strokes).splash_count, 0u);
  ASSERT_EQ(strokes.active().size(), 1u);
  EXPECT_EQ(strokes.active()[0].x_m, 1.0);
}

TEST(Strokes, FingerOfWhichNothingIsHeardIsLifted) {
  Strokes strokes;
  ASSERT_TRUE(strokes.add(part({{0.0, 1.0, 2.0, 1.0}})));
  const int limit = static_cast<int>((Strokes::kMaxSilence_s + 1.0) / kStep_s);
  for (int k = 0; k < limit; ++k) stepOf(strokes);
  EXPECT_TRUE(strokes.active().empty());
}

TEST(Strokes, LateAndRepeatedPointsAreOmitted) {
  Strokes strokes;
  ASSERT_TRUE(strokes.add(part({{0.0, 0, 0, 1}, {0.1, 1, 0, 1}})));
  ASSERT_TRUE(strokes.add(part({{0.05, 9, 9, 1}, {0.1, 9, 9, 1}, {0.2, 2, 0, 1}})));
  ASSERT_EQ(strokes.active()[0].path.size(), 3u);
  EXPECT_EQ(strokes.active()[0].path.back().x_m, 2.0);
}

TEST(Strokes, PathIsBoundedAndNeverFarBehind) {
  Strokes strokes;
  double now_s = 0.0;
  for (int message = 0; message < 40; ++message) {  // ten times as fast as time
    ASSERT_TRUE(strokes.add(part(line(now_s, now_s + 0.1, 0.002))));
    now_s += 0.1;
    stepOf(strokes);
    ASSERT_LE(strokes.active()[0].path.size(), Strokes::kPathMaxCount);
    ASSERT_LE(strokes.active()[0].path.back().time_s - strokes.active()[0].play_s, Strokes::kMaxDelay_s + 0.1);
  }
  ASSERT_TRUE(strokes.add(part({{80000.0, 3, 0, 1}}, true))) << "a client's clock may jump";
  for (int k = 0; k < 100; ++k) stepOf(strokes);
  EXPECT_TRUE(strokes.active().empty());
}

TEST(Strokes, WholeStrokeInOneMessageIsDrawnAtItsOwnPace) {
  Strokes strokes;
  ASSERT_TRUE(strokes.add(part(line(0.0, 4.0, 0.1), true)));
  for (int k = 0; k < 205; ++k) stepOf(strokes);
  ASSERT_EQ(strokes.active().size(), 1u);
  EXPECT_NEAR(strokes.active()[0].x_m, 2.0, 0.011);
}

TEST(Strokes, FasterThanARadiusPerStepPressesLess) {
  Strokes strokes;
  ASSERT_TRUE(strokes.add(part({{0.0, 0, 0, 1}})));
  for (int k = 0; k < 30; ++k) stepOf(strokes);
  ASSERT_TRUE(strokes.add(part({{0.3, 0, 0, 1}, {0.31, 500, 0, 1}, {1.0, 500, 0, 1}})));
  for (int k = 0; k < 60; ++k) {
    const auto out = stepOf(strokes);
    for (std::uint32_t i = 0; i < out.splash_count; ++i) EXPECT_LE(std::abs(out.splashes[i].gain_m), 0.2f + 1e-6f);
  }
}

TEST(Strokes, FingersAtOnePlacePressAsOne) {
  Strokes strokes;
  for (std::uint32_t finger = 0; finger < 2; ++finger) ASSERT_TRUE(strokes.add(part({{0.0, 0, 0, 1}}, false, finger)));
  ASSERT_TRUE(strokes.add(part({{0.0, 3, 0, 1}}, false, 9)));
  for (int k = 0; k < 50; ++k) stepOf(strokes);
  for (std::size_t finger = 0; finger < 2; ++finger) EXPECT_NEAR(strokes.active()[finger].level_ratio, 0.5, 1e-9);
  EXPECT_NEAR(strokes.active()[2].level_ratio, 1.0, 1e-9) << "far from the others";
}

TEST(Strokes, TwelveFingersPressAsHardAsThree) {
  Strokes strokes;
  for (std::uint32_t person = 1; person <= 12; ++person)
    ASSERT_TRUE(strokes.add(part({{0.0, 3.0 * person, 0, 1}}, false, 1, person)));
  ASSERT_TRUE(strokes.add(part({{0.0, 0, 9, 1}}, false, 1, 13, StrokeTool::kRain)));
  for (int k = 0; k < 50; ++k) stepOf(strokes);
  double squares = 0.0;
  for (std::size_t finger = 0; finger < 12; ++finger) squares += std::pow(strokes.active()[finger].level_ratio, 2);
  EXPECT_NEAR(squares, 3.0, 1e-9);
  EXPECT_NEAR(strokes.active()[12].level_ratio, 1.0, 1e-9) << "rain does not count as a finger";
}

TEST(Strokes, LimitsAreNamed) {
  Strokes strokes;
  for (std::uint32_t k = 0; k < Strokes::kPersonMaxCount; ++k)
    ASSERT_TRUE(strokes.add(part({{0.0, 0, 0, 1}}, false, k)));
  const auto own = strokes.add(part({{0.0, 0, 0, 1}}, false, 99));
  ASSERT_FALSE(own);
  EXPECT_EQ(own.error().code, core::ErrorCode::kUnavailable);
  EXPECT_NE(own.error().message.find("10 strokes of one person"), std::string::npos) << own.error().message;
  EXPECT_TRUE(strokes.add(part({{0.1, 0, 0, 1}}, false, 3))) << "a stroke that has begun continues";
  for (std::uint32_t person = 100; strokes.active().size() < Strokes::kMaxCount; ++person)
    ASSERT_TRUE(strokes.add(part({{0.0, 0, 0, 1}}, false, 1, person)));
  const auto all = strokes.add(part({{0.0, 0, 0, 1}}, false, 1, 99));
  ASSERT_FALSE(all);
  EXPECT_NE(all.error().message.find("128 strokes at the same time"), std::string::npos) << all.error().message;
  shared::EventUniforms out{};
  for (int k = 0; k < 50; ++k) {
    out = {};
    strokes.advance(kWater, out);
    ASSERT_LE(out.splash_count, static_cast<std::uint32_t>(MAX_PRESSES));
  }
}

TEST(Strokes, MoreThanAStepCanMoveTakeTurns) {
  Strokes strokes;
  for (std::uint32_t k = 0; k < 100; ++k) ASSERT_TRUE(strokes.add(part(line(0.0, 1.0, 0.05), true, 1, k)));
  for (int k = 0; k < 70; ++k) {
    const auto out = stepOf(strokes);
    ASSERT_LE(out.splash_count, static_cast<std::uint32_t>(MAX_PRESSES));
  }
  ASSERT_EQ(strokes.active().size(), 100u);
  for (const Stroke& stroke : strokes.active()) EXPECT_GT(stroke.x_m, 0.2) << "person " << stroke.person_id;
  for (int k = 0; k < 300; ++k) stepOf(strokes);
  EXPECT_TRUE(strokes.active().empty());
}

TEST(Strokes, OfASlowRoomDoNotPileUp) {
  Strokes strokes;
  // The room has a third of the time of its clients: a finger draws for 0.6 s, again and again.
  std::size_t most_count = 0;
  for (int k = 0; k < 600; ++k) {
    const double clock_s = 3 * kStep_s * k;
    const auto id = static_cast<std::uint32_t>(clock_s / 0.6);
    const double own_s = clock_s - 0.6 * id;
    ASSERT_TRUE(strokes.add(part({{own_s, own_s, 0, 1}}, own_s > 0.57 - 1e-9, id)));
    stepOf(strokes);
    most_count = std::max(most_count, strokes.active().size());
  }
  EXPECT_LE(most_count, 3u);
}

TEST(Strokes, EndOfAStrokeThatHasEndedIsNoError) {
  Strokes strokes;
  EXPECT_TRUE(strokes.add(part({}, true)));
  EXPECT_TRUE(strokes.active().empty());
}

TEST(Strokes, ResumedStrokesGoOnAsTheyWouldHave) {
  Strokes strokes;
  ASSERT_TRUE(strokes.add(part(line(0.0, 0.5))));
  for (int k = 0; k < 20; ++k) stepOf(strokes);
  Strokes copy;
  ASSERT_TRUE(copy.resume(strokes.active()));
  for (int k = 0; k < 100; ++k) {
    const auto a = stepOf(strokes), b = stepOf(copy);
    ASSERT_EQ(a.splash_count, b.splash_count);
    for (std::uint32_t i = 0; i < a.splash_count; ++i) ASSERT_EQ(a.splashes[i].x_m, b.splashes[i].x_m);
  }
  EXPECT_FALSE(copy.resume({Stroke{}})) << "a stroke without a path";
}

TEST(Strokes, RainFallsWithinItsDiscAtItsRateAndRepeats) {
  const auto fall = [](double pressure_ratio) {
    Strokes strokes;
    EXPECT_TRUE(
        strokes.add(part({{0.0, 2, 3, pressure_ratio}, {9.0, 2, 3, pressure_ratio}}, true, 1, 7, StrokeTool::kRain)));
    std::vector<shared::EventUniform> drops;
    for (int k = 0; k < 800; ++k) {
      const auto out = stepOf(strokes);
      drops.insert(drops.end(), out.splashes, out.splashes + out.splash_count);
    }
    return drops;
  };
  const auto drops = fall(1.0);
  EXPECT_NEAR(static_cast<double>(drops.size()), 90 * 8, 75) << "90 per second";
  EXPECT_NEAR(static_cast<double>(fall(0.5).size()), 45 * 8, 60);
  double mean_x_m = 0.0, outer_count = 0.0;
  for (const shared::EventUniform& drop : drops) {
    const double away_m = std::hypot(drop.x_m - 2, drop.z_m - 3);
    EXPECT_LE(away_m, 0.5 + 1e-6);
    EXPECT_LT(drop.gain_m, 0.0F) << "a drop presses";
    EXPECT_GE(drop.gain_m, -0.125F) << "half of its radius of 2.5 cells";
    mean_x_m += drop.x_m / static_cast<double>(drops.size());
    outer_count += away_m > 0.5 / std::sqrt(2.0) ? 1 : 0;
  }
  EXPECT_NEAR(mean_x_m, 2.0, 0.05);
  EXPECT_NEAR(outer_count / static_cast<double>(drops.size()), 0.5, 0.08) << "half of the area";
  const auto again = fall(1.0);
  ASSERT_EQ(again.size(), drops.size());
  EXPECT_EQ(again.back().x_m, drops.back().x_m);
}

TEST(Strokes, CalmSlowsTheFlowUnderItAndMovesNoWater) {
  Strokes strokes;
  for (std::uint32_t person = 0; person < 80; ++person)
    ASSERT_TRUE(strokes.add(
        part({{0.0, 0, double(person), 1}, {2.0, 1, double(person), 1}}, false, 1, person, StrokeTool::kCalm)));
  shared::EventUniforms out{};
  for (int k = 0; k < 50; ++k) {
    out = stepOf(strokes);
    ASSERT_EQ(out.splash_count, 0U);
    ASSERT_EQ(out.calm_count, static_cast<std::uint32_t>(MAX_CALMS));
  }
  std::vector<int> turns(80);
  for (int k = 0; k < 40; ++k) {
    out = stepOf(strokes);
    for (std::uint32_t c = 0; c < out.calm_count; ++c) ++turns[static_cast<std::size_t>(out.calms[c].z_m + 0.5F)];
  }
  EXPECT_GE(std::ranges::min(turns), 20) << "80 discs take turns";
  EXPECT_GT(out.calms[0].drag_ratio, 0.0F);
  EXPECT_LE(out.calms[0].drag_ratio, 0.1F) << "10 per second, a step of 10 ms";
}

TEST(Strokes, ToolsAtOnePositionDoNotWeakenEachOther) {
  const auto pressed_m = [](bool with_rain) {
    Strokes strokes;
    EXPECT_TRUE(strokes.add(part({{0.0, 0, 0, 1}, {1.0, 0, 0, 1}}, true)));
    if (with_rain) {
      EXPECT_TRUE(strokes.add(part({{0.0, 0, 0, 1}, {1.0, 0, 0, 1}}, true, 2, 7, StrokeTool::kRain)));
    }
    for (int k = 0; k < 50; ++k) (void)stepOf(strokes);
    return strokes.active().front().level_ratio;
  };
  EXPECT_EQ(pressed_m(true), pressed_m(false));
}

TEST(Strokes, RainUnderAFingerThatRestsFallsOnTheWholeDisc) {
  Strokes strokes;
  ASSERT_TRUE(strokes.add(part({{0.0, 2, 3, 1}}, false, 1, 7, StrokeTool::kRain)));
  std::vector<shared::EventUniform> drops;
  for (int k = 0; k < 150; ++k) {
    const auto out = stepOf(strokes);
    drops.insert(drops.end(), out.splashes, out.splashes + out.splash_count);
  }
  ASSERT_GT(drops.size(), 80u);
  std::ranges::sort(drops, {}, &shared::EventUniform::x_m);
  for (std::size_t k = 1; k < drops.size(); ++k) ASSERT_NE(drops[k].x_m, drops[k - 1].x_m) << "two at one position";
}

TEST(Strokes, WholeStrokesCountTowardTheLimitOfAPerson) {
  Strokes strokes;
  for (std::uint32_t k = 0; k < Strokes::kPersonMaxCount; ++k)
    ASSERT_TRUE(strokes.add(part(line(0.0, 8.0), true, k, 7, StrokeTool::kRain)));
  EXPECT_FALSE(strokes.add(part(line(0.0, 1.0), true, 99)));
  EXPECT_TRUE(strokes.add(part(line(0.0, 1.0), true, 99, 8)));
}

}  // namespace
}  // namespace spindrift::sim
