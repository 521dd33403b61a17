#include "level_ladder.h"

#include <vector>

#include <gtest/gtest.h>

namespace spindrift::net {
namespace {

using core::Level;
using std::chrono::seconds;

/// A link that carries the levels up to `carries`, one second per call.
class Link {
 public:
  explicit Link(std::uint32_t reduced_count) : reduced_count_(reduced_count) {
    (void)ladder.review(now_, reduced_count_);
  }

  /// The seconds at which the level changed, with the new level.
  struct Change {
    int second;
    Level level;
    bool operator==(const Change&) const = default;
  };
  std::vector<Change> run(int duration_s, Level carries, int lost_percent = 60) {
    std::vector<Change> out;
    for (int k = 0; k < duration_s; ++k) {
      const bool is_too_much = ladder.level() > carries;
      for (int frame = 0; frame < 100; ++frame) ladder.noteFrame(is_too_much && frame < lost_percent);
      now_ += seconds(1);
      ++second_;
      if (const auto level = ladder.review(now_, reduced_count_)) out.push_back({second_, *level});
    }
    return out;
  }

  LevelLadder ladder;

 private:
  Clock::time_point now_{};
  int second_ = 0;
  std::uint32_t reduced_count_;
};

TEST(LevelLadder, StepsDownOncePerSecondToWhatTheLinkCarries) {
  Link link(3);
  EXPECT_EQ(link.run(4, Level::kCoarse),
            (std::vector<Link::Change>{{1, Level::kFine}, {2, Level::kMedium}, {3, Level::kCoarse}}));
}

TEST(LevelLadder, SkipsLevelsThatEqualFull) {
  Link link(1);
  EXPECT_EQ(link.run(3, Level::kCoarse), (std::vector<Link::Change>{{1, Level::kCoarse}}));
  EXPECT_EQ(link.run(6, Level::kFull), (std::vector<Link::Change>{{5, Level::kFull}}));
}

TEST(LevelLadder, StaysAtFullWhenAllLevelsEqualFull) {
  Link link(0);
  EXPECT_TRUE(link.run(30, Level::kCoarse).empty());
  EXPECT_EQ(link.ladder.level(), Level::kFull);
}

TEST(LevelLadder, AnOccasionalLossDoesNotLowerTheLevel) {
  Link link(3);
  EXPECT_TRUE(link.run(30, Level::kCoarse, 15).empty());
}

TEST(LevelLadder, RetriesAFailedStepUpLessAndLessOften) {
  Link link(3);
  std::vector<int> tries;
  for (const Link::Change& change : link.run(400, Level::kMedium)) {
    if (change.level == Level::kFine && change.second > 1) tries.push_back(change.second);
  }
  ASSERT_GE(tries.size(), 6u);
  std::vector<int> gaps;
  for (std::size_t k = 1; k < tries.size(); ++k) gaps.push_back(tries[k] - tries[k - 1]);
  EXPECT_LT(gaps[0], 12);
  for (std::size_t k = 1; k < 4; ++k) EXPECT_GT(gaps[k], gaps[k - 1] * 3 / 2) << k;
  EXPECT_LT(gaps.back(), 70) << "but it continues trying";
  EXPECT_EQ(link.ladder.level(), Level::kMedium);
}

TEST(LevelLadder, ReturnsToFullWhenTheLinkRecovers) {
  Link link(3);
  link.run(60, Level::kCoarse);
  const auto changes = link.run(300, Level::kFull);
  EXPECT_EQ(link.ladder.level(), Level::kFull);
  EXPECT_EQ(changes.size(), 3u);
}

}  // namespace
}  // namespace spindrift::net
