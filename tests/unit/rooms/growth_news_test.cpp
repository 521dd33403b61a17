#include <gtest/gtest.h>

#include <spindrift/rooms/room_reports.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
const GrowthNews::TimePoint kFirstNews = GrowthNews::TimePoint{} + 1h;

TEST(GrowthNews, ReportsNothingWithoutGrowth) {
  GrowthNews news(1s);
  EXPECT_FALSE(news.tell(0, kFirstNews));
  EXPECT_FALSE(news.tell(0, kFirstNews + 1h));
}

TEST(GrowthNews, ReportsGrowthOnce) {
  GrowthNews news(1s);
  EXPECT_TRUE(news.tell(1, kFirstNews));
  EXPECT_FALSE(news.tell(1, kFirstNews + 5s));
  EXPECT_TRUE(news.tell(2, kFirstNews + 6s));
}

TEST(GrowthNews, ReportsAFloodOncePerIntervalAndItsLastCountAtTheEnd) {
  GrowthNews news(1s);
  int told_count = 0;
  std::uint64_t last = 0;
  for (std::uint64_t i = 1; i <= 300; ++i) {
    if (!news.tell(i, kFirstNews + i * 10ms)) continue;
    ++told_count;
    last = i;
  }
  EXPECT_EQ(told_count, 3);
  EXPECT_LT(last, 300u);
  EXPECT_TRUE(news.tell(300, kFirstNews + 10s)) << "growth within the interval is reported later";
}

TEST(GrowthNews, FollowsACounterThatBeginsAgain) {
  GrowthNews news(1s);
  EXPECT_TRUE(news.tell(5, kFirstNews));
  news.restart(0);
  EXPECT_FALSE(news.tell(0, kFirstNews + 2s));
  EXPECT_TRUE(news.tell(1, kFirstNews + 2s));
}

}  // namespace
}  // namespace spindrift::rooms
