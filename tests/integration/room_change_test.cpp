// Another number of particles in a running room: prepared on another thread, taken over between two ticks.
#include "room_fixture.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class RoomChange : public RoomTest {
 protected:
  static constexpr std::uint32_t kStartCount = 512;  ///< kStillPool's

  static v1::Command count(double value) { return setParameter("particles.count", value); }
  std::uint32_t sceneCount() const { return room_->snapshot()->scene.particles().count(); }
  /// Another person's splash in the same round shows that the change has begun: heavy commands come first in their
  /// lane.
  void begin(std::uint64_t command_id, double value) {
    ASSERT_TRUE(runUntil([&] { return room_->tick() >= 2; }));
    send(command_id, count(value));
    send(100, setSpeed(1.0), 2);
    ASSERT_TRUE(runUntil([&] { return !outlets_.applied.empty(); }));
    ASSERT_THAT(outlets_.applied, ElementsAre(100)) << "the change is still being laid out";
  }
};

TEST_F(RoomChange, RunsOnItsOwnThreadWhileTicksWait) {
  begin(1, 60000);
  const std::uint64_t tick = room_->tick();
  send(2, reset());
  while (outlets_.applied.size() == 1) {
    EXPECT_EQ(room_->tick(), tick) << "the state stands still, so that a log replays it";
    ASSERT_TRUE(runUntil([n = 0]() mutable { return n++ > 0; }));
  }
  ASSERT_TRUE(runUntil([&] { return outlets_.applied.size() == 3; }));
  EXPECT_THAT(outlets_.applied, ElementsAre(100, 1, 2)) << "what its sender sent later waits";
  EXPECT_EQ(sceneCount(), 60000u);
  EXPECT_TRUE(runUntil([&] { return room_->tick() >= tick + 3; })) << "time continues";
}

TEST_F(RoomChange, LaysOutOnlyTheLastOfSeveralValues) {
  ASSERT_TRUE(runUntil([&] { return room_->tick() >= 2; }));
  send(1, count(3000));
  send(2, count(5000));
  send(3, count(4000));
  ASSERT_TRUE(runUntil([&] { return outlets_.applied.size() == 3; }));
  EXPECT_THAT(outlets_.applied, ElementsAre(1, 2, 3));
  EXPECT_EQ(sceneCount(), 4000u);
  EXPECT_THAT(outlets_.rejected, testing::IsEmpty());
}

TEST_F(RoomChange, EndsWithTheDeviceThatFails) {
  begin(1, 60000);
  context_->simulateLoss();
  ASSERT_TRUE(runUntil([&] { return !outlets_.rejected_ids.empty() || outlets_.applied.size() > 1; }));
  EXPECT_THAT(outlets_.rejected_ids, ElementsAre(1));
  EXPECT_THAT(outlets_.rejected[0], HasSubstr("the device failed"));
  ASSERT_TRUE(runUntil([&] { return outlets_.scene_count == 1; }));
  EXPECT_EQ(sceneCount(), kStartCount);
  send(2, count(3000));
  EXPECT_TRUE(runUntil([&] { return outlets_.applied.back() == 2; })) << "its sender may continue";
  EXPECT_EQ(sceneCount(), 3000u);
}

TEST_F(RoomChange, EndsWithTheRoom) {
  begin(1, 60000);
  room_->abandonCommands();
  EXPECT_THAT(outlets_.rejected_ids, ElementsAre(1));
  EXPECT_THAT(outlets_.rejected[0], HasSubstr("closed"));
}

/// Refuses every fast sound speed by its step rule, so that derive() runs each time.
class RoomValues : public RoomChange {
 protected:
  std::string sceneText() const override { return std::string("fixed_substeps_count: 1\n") + kStillPool; }
  static constexpr std::uint64_t kValueCount = 40;
  void sendRefusedValues() {
    for (std::uint64_t id = 1; id <= kValueCount; ++id)
      send(id, setParameter("particles.sound_speed_mps", 400.0 + static_cast<double>(id)));
  }
};

TEST_F(RoomValues, RefusedOnesAreTriedAFewPerRound) {
  ASSERT_TRUE(runUntil([&] { return room_->tick() >= 2; }));
  sendRefusedValues();
  send(kValueCount + 1);
  const std::uint64_t tick = room_->tick();
  send(100, setSpeed(1.0), 2);
  ASSERT_TRUE(runUntil([&] { return !outlets_.applied.empty(); }));
  EXPECT_THAT(outlets_.applied, ElementsAre(100)) << "others do not wait for them";
  EXPECT_THAT(outlets_.rejected_ids, testing::IsEmpty()) << "one round does not try all of them";
  ASSERT_TRUE(runUntil([&] { return outlets_.applied.size() == 2; }));
  EXPECT_THAT(outlets_.applied, ElementsAre(100, kValueCount + 1)) << "what the sender sent later comes after them";
  ASSERT_EQ(outlets_.rejected_ids.size(), kValueCount);
  for (std::uint64_t id = 1; id <= kValueCount; ++id) EXPECT_EQ(outlets_.rejected_ids[id - 1], id);
  EXPECT_GT(room_->tick(), tick + 1) << "ticks continue in between";
}

TEST_F(RoomValues, WaitingOnesAreAnsweredWhenTheRoomCloses) {
  ASSERT_TRUE(runUntil([&] { return room_->tick() >= 2; }));
  sendRefusedValues();
  send(100, setSpeed(1.0), 2);
  ASSERT_TRUE(runUntil([&] { return !outlets_.applied.empty(); }));
  room_->abandonCommands();
  EXPECT_EQ(outlets_.rejected_ids.size(), kValueCount);
  EXPECT_THAT(outlets_.rejected, testing::Contains(HasSubstr("closed")));
}

}  // namespace
}  // namespace spindrift::test
