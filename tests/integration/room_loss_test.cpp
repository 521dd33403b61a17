// A room whose device fails: it reports the failure, answers, and starts its scene again on a new context.
#include "room_fixture.h"

namespace spindrift::test {
namespace {

using RoomLoss = RoomTest;

TEST_F(RoomLoss, RestartsTheSceneOnANewContext) {
  send(1);
  ASSERT_TRUE(runUntil([&] { return room_->tick() >= 5 && outlets_.applied.size() == 1; }));
  const std::uint64_t tick_before = room_->tick();
  context_->simulateLoss();
  room_->run(Clock::now());
  EXPECT_TRUE(room_->vitals()->lost);
  EXPECT_EQ(room_->tick(), tick_before) << "nothing runs on a device that failed";
  send(2);
  ASSERT_TRUE(runUntil([&] { return !room_->vitals()->lost; }));
  EXPECT_EQ(outlets_.scene_count, 1) << "all clients get a new greeting";
  EXPECT_EQ(outlets_.recovered_count, 1);
  EXPECT_GT(room_->tick(), tick_before) << "ticks never go back";
  ASSERT_TRUE(runUntil([&] { return outlets_.rejected.size() + outlets_.applied.size() == 2; })) << "2 is answered";
  send(3);
  EXPECT_TRUE(runUntil([&] { return !outlets_.applied.empty() && outlets_.applied.back() == 3; }));
  const std::uint64_t tick_after = room_->tick();
  EXPECT_TRUE(runUntil([&] { return room_->tick() >= tick_after + 5; }));
}

TEST_F(RoomLoss, AnswersCommandsThatCameBeforeTheLoss) {
  ASSERT_TRUE(runUntil([&] { return room_->tick() >= 2; }));
  send(7);
  context_->simulateLoss();
  room_->run(Clock::now());
  ASSERT_EQ(outlets_.rejected.size(), 1u);
  EXPECT_THAT(outlets_.rejected[0], testing::HasSubstr("the device failed"));
}

TEST_F(RoomLoss, AClosingRoomAnswersWaitingCommands) {
  send(7);
  send(8);
  room_->abandonCommands();
  EXPECT_THAT(outlets_.rejected_ids, testing::ElementsAre(7, 8));
  EXPECT_THAT(outlets_.rejected, testing::Each(testing::HasSubstr("closed")));
}

}  // namespace
}  // namespace spindrift::test
