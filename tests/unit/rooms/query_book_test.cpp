// Which queries are due, where their points are, and their bounds.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/rooms/query_book.h>

namespace spindrift::rooms {
namespace {

using testing::HasSubstr;
using Which = QueryBook::Which;

constexpr double kQueryTick_s = 1.0 / 60.0;

class QueryBookTest : public testing::Test {
 protected:
  static v1::Query query(int point_count, std::uint32_t id = 0, std::uint32_t interval_ticks = 0) {
    v1::Query out;
    out.set_query_id(id);
    out.set_interval_ticks(interval_ticks);
    for (int k = 0; k < point_count; ++k) {
      out.add_x_m(static_cast<float>(k));
      out.add_z_m(1.0F);
    }
    return out;
  }
  bool enter(core::SessionId session, const v1::Query& asked, std::uint64_t tick = 0) {
    const auto refused = book_.enter({.session_id = session}, asked, tick);
    reason_ = refused ? refused->message() : "";
    EXPECT_TRUE(!refused || refused->reason() == v1::REJECT_REASON_BUSY);
    return !refused;
  }
  /// Ids of the queries that are answered at this tick.
  std::vector<std::uint32_t> answered(std::uint64_t tick, Which which = Which::kDue) {
    std::vector<std::uint32_t> out;
    for (const QueryBook::Taken& taken : book_.take(which, tick)) out.push_back(taken.query.asked.query_id());
    return out;
  }

  QueryBook book_;
  std::string reason_;
};

TEST_F(QueryBookTest, AnswersOnceOrAfterEachInterval) {
  ASSERT_TRUE(enter(1, query(2, 1)));
  ASSERT_TRUE(enter(1, query(1, 2, 3)));
  EXPECT_EQ(answered(10, Which::kNew), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_TRUE(answered(10).empty());
  EXPECT_TRUE(answered(12).empty());
  EXPECT_TRUE(answered(13, Which::kNew).empty());
  EXPECT_EQ(answered(14), (std::vector<std::uint32_t>{2})) << "a tick that was missed is made up for at the next";
  EXPECT_TRUE(answered(16).empty());
  EXPECT_EQ(answered(17), (std::vector<std::uint32_t>{2}));
  ASSERT_TRUE(enter(1, query(0, 2)));
  EXPECT_TRUE(book_.isEmpty());
}

TEST_F(QueryBookTest, MovesPointsFromTheTickOfTheQueryOn) {
  v1::Query asked = query(2, 1, 1);
  asked.add_velocity_x_mps(6.0F);
  asked.add_velocity_z_mps(0.0F);
  asked.add_velocity_z_mps(-60.0F);
  ASSERT_TRUE(enter(1, asked, 100));
  const std::vector<sim::SurfacePoint> points = book_.points(Which::kDue, 110, kQueryTick_s);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_DOUBLE_EQ(points[0].x_m, 1.0);
  EXPECT_DOUBLE_EQ(points[0].z_m, 1.0);
  EXPECT_DOUBLE_EQ(points[1].x_m, 2.0);
  EXPECT_DOUBLE_EQ(points[1].z_m, -9.0);
}

TEST_F(QueryBookTest, AStreamReplacesThatOfItsIdWithoutASecondAnswerInATick) {
  ASSERT_TRUE(enter(1, query(3, 7, 1)));
  ASSERT_TRUE(enter(2, query(4, 7, 1)));
  EXPECT_EQ(answered(5).size(), 2u);
  ASSERT_TRUE(enter(1, query(5, 7, 1), 5));
  EXPECT_TRUE(answered(5, Which::kNew).empty());
  EXPECT_EQ(book_.points(Which::kDue, 6, kQueryTick_s).size(), 5u + 4u);
  ASSERT_TRUE(enter(1, query(1, 7, 60), 8));
  EXPECT_EQ(answered(8, Which::kNew), (std::vector<std::uint32_t>{7})) << "at once, whatever the interval";
}

TEST_F(QueryBookTest, KeepsSingleQueriesOfTheSameIdApart) {
  ASSERT_TRUE(enter(1, query(1, 7, 1)));
  ASSERT_TRUE(enter(1, query(2, 7)));
  ASSERT_TRUE(enter(1, query(3, 7)));
  EXPECT_EQ(book_.points(Which::kNew, 0, kQueryTick_s).size(), 6u);
  EXPECT_EQ(answered(0).size(), 3u);
  EXPECT_EQ(answered(1).size(), 1u);
}

TEST_F(QueryBookTest, AsksAgainWhatWasLost) {
  ASSERT_TRUE(enter(1, query(2, 1)));
  ASSERT_TRUE(enter(1, query(3, 2, 1)));
  std::vector<QueryBook::Taken> lost = book_.take(Which::kNew, 4);
  EXPECT_EQ(lost.size(), 2u);
  EXPECT_EQ(lost[0].point_count + lost[1].point_count, 5u);
  book_.putBack(std::move(lost));
  EXPECT_EQ(answered(4, Which::kNew), (std::vector<std::uint32_t>{1})) << "a stream continues at the next tick";
  EXPECT_EQ(answered(5), (std::vector<std::uint32_t>{2}));
}

TEST_F(QueryBookTest, BoundsWhatASessionAndTheRoomHave) {
  for (std::uint32_t id = 0; id < kSessionMaxQueries; ++id) ASSERT_TRUE(enter(1, query(1, id, 1)));
  EXPECT_FALSE(enter(1, query(1, 99, 1)));
  EXPECT_THAT(reason_, HasSubstr("17 queries that wait or stream, 16 are the most"));
  EXPECT_FALSE(enter(2, query(1025)));
  EXPECT_THAT(reason_, HasSubstr("1025 points that wait or stream, 1024 are the most"));
  ASSERT_TRUE(enter(2, query(1024)));
  EXPECT_FALSE(enter(2, query(1))) << "what waits counts, too";
  EXPECT_EQ(answered(1).size(), kSessionMaxQueries + 1);
  EXPECT_TRUE(enter(2, query(1)));
  for (core::SessionId session = 3; session < 10; ++session) ASSERT_TRUE(enter(session, query(1024, 1, 1)));
  EXPECT_FALSE(enter(20, query(1024))) << "7 x 1024 + 17 are there";
  EXPECT_THAT(reason_, HasSubstr("the room would have 8209 points that wait or stream, 8192 are the most"));
  EXPECT_EQ(book_.removeIf([](const SurfaceQuery& one) { return one.sender.session_id < 10; }).size(), 24u);
  EXPECT_TRUE(enter(20, query(1024)));
}

}  // namespace
}  // namespace spindrift::rooms
