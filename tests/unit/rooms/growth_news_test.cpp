#include <gtest/gtest.h>

#include <spindrift/rooms/growth_news.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
const GrowthNews::TimePoint kStart = GrowthNews::TimePoint{} + 1h;

TEST(GrowthNews, ReportsNothingWithoutGrowth) {
  GrowthNews news(1s);
  EXPECT_FALSE(news.tell(0, kStart));
  EXPECT_FALSE(news.tell(0, kStart + 1h));
}

TEST(GrowthNews, ReportsGrowthOnce) {
  GrowthNews news(1s);
  EXPECT_TRUE(news.tell(1, kStart));
  EXPECT_FALSE(news.tell(1, kStart + 5s));
  EXPECT_TRUE(news.tell(2, kStart + 6s));
}

TEST(GrowthNews, ReportsAFloodOncePerIntervalAndItsLastCountAtTheEnd) {
  GrowthNews news(1s);
  int told_count = 0;
  std::uint64_t last = 0;
  for (std::uint64_t i = 1; i <= 300; ++i) {
    if (!news.tell(i, kStart + i * 10ms)) continue;
    ++told_count;
    last = i;
  }
  EXPECT_EQ(told_count, 3);
  EXPECT_LT(last, 300u);
  EXPECT_TRUE(news.tell(300, kStart + 10s)) << "growth within the interval is reported later";
}

TEST(GrowthNews, FollowsACounterThatBeginsAgain) {
  GrowthNews news(1s);
  EXPECT_TRUE(news.tell(5, kStart));
  news.restart(0);
  EXPECT_FALSE(news.tell(0, kStart + 2s));
  EXPECT_TRUE(news.tell(1, kStart + 2s));
}

}  // namespace
}  // namespace spindrift::rooms
