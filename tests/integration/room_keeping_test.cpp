// Rooms that are kept on disk: what a crash leaves of them, and what a damaged or full disk does. Longer than 400
// lines, because all tests share one fixture.
#include <spindrift/history/state_store.h>

#include "full_disk.h"
#include "harbor_scene.h"
#include "open_room.h"
#include "room_fixture.h"
#include "silent_outlets.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class KeptRoomTest : public RoomTest {
 protected:
  void SetUp() override {
    folder_.write("harbor.textproto", kHarbor);
    folder_.write("box.textproto", kStillPool);
    rules_.scenes = water::SceneCatalog(folder_.path());
    openStore();
    RoomTest::SetUp();
  }
  std::string sceneText() const override { return kHarbor; }
  std::string sceneName() const override { return "harbor"; }
  history::RoomPlace place() override {
    auto place = rules_.states->place("main");
    EXPECT_TRUE(place) << place.error().message;
    return place ? *std::move(place) : history::RoomPlace{};
  }
  void openStore() {
    auto store = history::StateStore::open({.folder = folder_.path() / "state", .snapshot_interval = interval_});
    ASSERT_TRUE(store) << store.error().message;
    rules_.states = *std::move(store);
  }

  /// What a killed server leaves: nothing more is written.
  void crash() {
    room_->releaseDevice();
    room_.reset();
    outlets_ = {};
    rules_.states.reset();
  }
  /// As a server that starts again.
  void comeBack() {
    comeBackBy([&](std::unique_ptr<water::Water> water, history::RoomPlace kept) {
      return test::openRoom("main", std::move(water), rules_, *builder_, outlets_, std::move(kept));
    });
  }
  /// As a server that opens the room while others run. Returns the number of pieces.
  std::size_t comeBackInPieces() {
    std::size_t piece_count = 0;
    comeBackBy([&](std::unique_ptr<water::Water> water, history::RoomPlace kept) {
      auto room = rooms::Room::begin("main", std::move(water), rules_, *builder_, outlets_, std::move(kept), {});
      if (!room) return room;
      while (true) {
        ++piece_count;
        const auto is_whole = (*room)->restoreUntil(Clock::now());
        if (!is_whole) return decltype(room)(is_whole.error());
        if (*is_whole) return room;
      }
    });
    return piece_count;
  }
  template <typename Create>
  void comeBackBy(Create create) {
    openStore();
    history::RoomPlace kept = place();
    ASSERT_TRUE(kept.kept);
    v1::Scene start = kept.kept->state->start_scene();
    scene::fillDefaults(start);
    auto water = water::Water::create(device_, std::move(start));
    ASSERT_TRUE(water) << water.error().message;
    context_ = &(*water)->context();
    auto room = create(*std::move(water), std::move(kept));
    ASSERT_TRUE(room) << room.error().message;
    room_ = *std::move(room);
    room_->start(Clock::now());
  }
  void crashAndComeBack() {
    crash();
    comeBack();
  }

  /// Crashes this many ticks from now: the room that comes back has the same state at that tick.
  void expectSameAfterACrash(std::uint64_t tick_count) {
    const std::uint64_t compared = room_->tick() + tick_count;
    const std::uint64_t expected = hashAt(compared);
    crashAndComeBack();
    EXPECT_LE(room_->tick(), compared);
    EXPECT_EQ(hashAt(compared), expected);
  }

  bool runTicks(std::uint64_t count) {
    const std::uint64_t end = room_->tick() + count;
    return runUntil([&] { return room_->tick() >= end; });
  }
  /// Runs to a tick and pauses there, so that two rooms can be compared.
  std::uint64_t hashAt(std::uint64_t tick) {
    EXPECT_TRUE(runUntil([&] { return room_->tick() >= tick; }));
    EXPECT_EQ(room_->tick(), tick);
    return room_->stateHash();
  }
  bool isAnswered(std::size_t count) {
    return runUntil([&] { return outlets_.applied.size() + outlets_.rejected.size() >= count; });
  }
  v1::Scene scene() const { return room_->snapshot()->scene; }

  TemporaryFolder folder_;
  std::chrono::milliseconds interval_{3'600'000};
};

TEST_F(KeptRoomTest, ResumesBitForBitFromTheFirstSnapshotAndTheLog) {
  send(1, splash(0.4, 1.5));
  send(2, spawnBoat(-2, 1));
  ASSERT_TRUE(runTicks(20));
  send(3, controlBoat(1, 1.0, -0.5));
  send(4, setParameter("storm.level_ratio", 0.9));
  ASSERT_TRUE(runTicks(20));
  send(5, splash(0.3, 1.0));
  ASSERT_TRUE(isAnswered(5));
  ASSERT_THAT(outlets_.rejected, IsEmpty());
  expectSameAfterACrash(12);
  EXPECT_EQ(scene().storm().level_ratio(), 0.9);
  EXPECT_THAT(room_->water().boats(), SizeIs(2));
}

TEST_F(KeptRoomTest, ResumesBitForBitFromALaterSnapshot) {
  send(1, splash(0.4, 1.5));
  ASSERT_TRUE(runTicks(25));
  ASSERT_TRUE(room_->askForSnapshot());
  ASSERT_TRUE(runUntil([&] { return room_->keptStatus()->snapshot_count == 2; }));
  send(2, splash(0.3, 1.0));
  ASSERT_TRUE(isAnswered(2));
  expectSameAfterACrash(10);
}

TEST_F(KeptRoomTest, ResumesInTheReplacedScene) {
  ASSERT_TRUE(runTicks(5));
  send(1, changeScene("box"));
  ASSERT_TRUE(isAnswered(1));
  ASSERT_THAT(outlets_.applied, ElementsAre(1));
  send(2, splash(0.3, 1.0));
  send(3, setParameter("particles.count", 700));
  ASSERT_TRUE(isAnswered(3));
  ASSERT_THAT(outlets_.rejected, IsEmpty());
  expectSameAfterACrash(8);
  EXPECT_EQ(scene().name(), "box");
  EXPECT_EQ(scene().particles().count(), 700u);
}

TEST_F(KeptRoomTest, ResumesBitForBitInPieces) {
  send(1, splash(0.4, 1.5));
  ASSERT_TRUE(runTicks(20));
  send(2, spawnBoat(-2, 1));
  ASSERT_TRUE(runTicks(5));
  send(3, splash(0.3, 1.0));
  ASSERT_TRUE(isAnswered(3));
  const std::uint64_t compared = room_->tick() + 8;
  const std::uint64_t expected = hashAt(compared);
  crash();
  const std::size_t piece_count = comeBackInPieces();
  EXPECT_GT(room_->tick(), 20u);
  EXPECT_GE(piece_count, room_->tick()) << "a piece is a tick at most; the snapshot is of the beginning";
  EXPECT_EQ(hashAt(compared), expected);
}

TEST_F(KeptRoomTest, ResumesAtItsLevel) {
  send(1, splash(0.4, 1.5));
  ASSERT_TRUE(runTicks(10));
  v1::Command coarser = changeScene("harbor");
  coarser.mutable_change_scene()->set_fidelity(v1::FIDELITY_DRAFT);
  send(2, coarser);
  ASSERT_TRUE(isAnswered(2));
  ASSERT_THAT(outlets_.rejected, IsEmpty());
  expectSameAfterACrash(8);
  EXPECT_EQ(scene().fidelity(), v1::FIDELITY_DRAFT);
}

TEST_F(KeptRoomTest, ResumesWithItsPauseSpeedAndSteps) {
  send(1, setSpeed(0.25));
  send(2, setPaused(true));
  ASSERT_TRUE(isAnswered(2));
  const std::uint64_t end = room_->tick() + 5;
  send(3, step(5));
  ASSERT_TRUE(isAnswered(3));
  crashAndComeBack();
  EXPECT_TRUE(room_->snapshot()->paused);
  EXPECT_EQ(room_->snapshot()->speed, 0.25);
  EXPECT_TRUE(runUntil([&] { return room_->tick() == end; }));
  for (int k = 0; k < 20; ++k) room_->run(Clock::now());
  EXPECT_EQ(room_->tick(), end) << "and no further";
}

TEST_F(KeptRoomTest, ResumesWithTheSeedOfAReset) {
  const std::uint64_t seed = scene().seed();
  send(1, seededReset(seed + 1));
  ASSERT_TRUE(isAnswered(1));
  EXPECT_EQ(scene().seed(), seed + 1);
  ASSERT_TRUE(runTicks(20));
  expectSameAfterACrash(10);  // from the first snapshot and the log
  EXPECT_EQ(scene().seed(), seed + 1);
  const std::uint64_t snapshot_count = room_->keptStatus()->snapshot_count;
  ASSERT_TRUE(room_->askForSnapshot());
  ASSERT_TRUE(runUntil([&] { return room_->keptStatus()->snapshot_count > snapshot_count; }));
  expectSameAfterACrash(10);  // from a snapshot that has the seed
}

TEST_F(KeptRoomTest, NobodyHoldsTheClockAfterARestart) {
  const std::uint32_t person_id =
      room_->roster().arrive({.session = 1, .role = core::Role::kOperator, .name = "Ada"}).person_id;
  send(1, takeClock(), 1, person_id);
  send(2, step(600), 1, person_id);
  send(3, waitingStep(1), 1, person_id);
  ASSERT_TRUE(isAnswered(3));
  EXPECT_THAT(outlets_.rejected, SizeIs(1)) << "601 ticks are one too many";
  EXPECT_THAT(room_->snapshot()->clock_person_ids, ElementsAre(person_id));
  ASSERT_TRUE(runTicks(3));
  crashAndComeBack();
  EXPECT_THAT(room_->snapshot()->clock_person_ids, IsEmpty());
  EXPECT_FALSE(room_->snapshot()->paused);
  EXPECT_TRUE(runTicks(3)) << "it runs by itself";
}

TEST_F(KeptRoomTest, ARoomThatClosesAnswersTheStepsThatWait) {
  const std::uint32_t person_id =
      room_->roster().arrive({.session = 1, .role = core::Role::kOperator, .name = "Ada"}).person_id;
  send(1, takeClock(0.1), 1, person_id);
  send(2, waitingStep(600), 1, person_id);
  ASSERT_TRUE(runTicks(1));
  EXPECT_THAT(outlets_.applied, ElementsAre(1u));
  room_->abandonCommands();
  EXPECT_THAT(outlets_.rejected_ids, ElementsAre(2u));
}

TEST_F(KeptRoomTest, WritesNoSnapshotsWhileItStandsStill) {
  crash();
  interval_ = 5ms;
  comeBack();
  send(1, setPaused(true));
  ASSERT_TRUE(isAnswered(1));
  std::uint64_t count = 0;
  // The last change may still be on its way to the disk.
  ASSERT_TRUE(runUntil([&] { return std::exchange(count, room_->keptStatus()->snapshot_count) >= 2; }));
  const auto until = Clock::now() + 200ms;
  while (Clock::now() < until) room_->run(Clock::now());
  EXPECT_LE(room_->keptStatus()->snapshot_count, count + 2);
  ASSERT_TRUE(room_->askForSnapshot());
  const std::uint64_t before = room_->keptStatus()->snapshot_count;
  EXPECT_TRUE(runUntil([&] { return room_->keptStatus()->snapshot_count > before; })) << "but when somebody asks";
}

TEST_F(KeptRoomTest, ReturningPeopleGetTheirBoatsBack) {
  const rooms::Admission captain = room_->roster().arrive({.session = 7, .role = core::Role::kPlayer, .name = "Ada"});
  const rooms::Admission guest = room_->roster().arrive({.session = 8, .role = core::Role::kViewer, .name = ""});
  send(1, spawnBoat(-2, 1), 7, captain.person_id);
  ASSERT_TRUE(isAnswered(1));
  const std::uint32_t boat_id = room_->roster().people().people(0).boat_ids(0);
  crashAndComeBack();
  EXPECT_EQ(room_->roster().ownerOf(boat_id), captain.person_id);
  const rooms::Admission again =
      room_->roster().arrive({.session = 1, .role = core::Role::kPlayer, .resume_key = captain.resume_key});
  EXPECT_TRUE(again.resumed);
  EXPECT_EQ(again.person_id, captain.person_id);
  const rooms::Admission guest_again =
      room_->roster().arrive({.session = 2, .role = core::Role::kViewer, .resume_key = guest.resume_key});
  EXPECT_TRUE(guest_again.resumed) << "also without a boat";
  const rooms::Admission other = room_->roster().arrive({.session = 3, .role = core::Role::kViewer});
  EXPECT_GT(other.person_id, guest.person_id) << "nobody gets the number of another";
}

TEST_F(KeptRoomTest, ForgetsPeopleWhoDoNotReturnInTime) {
  const rooms::Admission captain = room_->roster().arrive({.session = 7, .role = core::Role::kPlayer});
  send(1, spawnBoat(-2, 1), 7, captain.person_id);
  ASSERT_TRUE(isAnswered(1));
  crash();
  rules_.grace = 0ms;
  comeBack();
  ASSERT_TRUE(runTicks(2));
  EXPECT_THAT(room_->roster().people().people(), IsEmpty());
}

TEST_F(KeptRoomTest, StopWritesTheLastState) {
  send(1, splash(0.4, 1.5));
  ASSERT_TRUE(runTicks(15));
  const std::uint64_t tick = room_->tick();
  const std::uint64_t expected = room_->stateHash();
  ASSERT_TRUE(room_->saveUntil(Clock::now() + kPatience));
  crashAndComeBack();
  EXPECT_EQ(room_->tick(), tick);
  EXPECT_EQ(room_->stateHash(), expected);
}

TEST_F(KeptRoomTest, ResumesAfterADeviceFailure) {
  const rooms::Admission captain = room_->roster().arrive({.session = 7, .role = core::Role::kPlayer});
  send(1, splash(0.4, 1.5));
  send(2, spawnBoat(-2, 1), 7, captain.person_id);
  ASSERT_TRUE(runTicks(20));
  send(3, setParameter("storm.level_ratio", 0.9));
  ASSERT_TRUE(isAnswered(3));
  const std::uint64_t tick = room_->tick();
  const double time_s = room_->water().time_s();
  context_->simulateLoss();
  room_->run(Clock::now());
  ASSERT_TRUE(room_->vitals()->lost);
  ASSERT_TRUE(runUntil([&] { return !room_->vitals()->lost; }));
  EXPECT_GT(room_->tick(), tick) << "ticks never go back";
  EXPECT_NEAR(room_->water().time_s(), time_s, 0.1) << "not at the start";
  EXPECT_EQ(scene().storm().level_ratio(), 0.9);
  EXPECT_THAT(room_->water().boats(), SizeIs(2));
  EXPECT_EQ(room_->roster().ownerOf(room_->water().boats()[1].boat_id), captain.person_id);
  EXPECT_EQ(outlets_.recovered_count, 1);
  EXPECT_EQ(outlets_.scene_count, 1) << "all clients get a new greeting";
  send(4, splash());
  ASSERT_TRUE(isAnswered(4));
  expectSameAfterACrash(6);  // what is on disk continues from there
}

TEST_F(KeptRoomTest, FullDiskRefusesCommandsUntilThereIsSpace) {
  ASSERT_TRUE(runTicks(3));
  {
    const FullDisk full(1);
    send(1, splash());
    send(2, setPaused(true));
    ASSERT_TRUE(isAnswered(2));
    EXPECT_THAT(outlets_.applied, IsEmpty());
    ASSERT_THAT(outlets_.rejected, SizeIs(2));
    EXPECT_THAT(outlets_.rejected[0], HasSubstr("cannot keep this on disk"));
    EXPECT_FALSE(room_->snapshot()->paused);
    room_->roster().arrive({.session = 9, .role = core::Role::kViewer});  // happens, whatever the disk says
    EXPECT_TRUE(runTicks(3)) << "the water runs on";
    EXPECT_EQ(room_->keptStatus()->snapshot_count, 1u);
  }
  ASSERT_TRUE(runUntil([&] { return room_->keptStatus()->snapshot_count >= 2; }))
      << "what is missing comes in a snapshot";
  send(3, splash());
  ASSERT_TRUE(isAnswered(3));
  EXPECT_THAT(outlets_.applied, ElementsAre(3));
  expectSameAfterACrash(8);
}

TEST_F(KeptRoomTest, PausedRoomTakesCommandsAgainAfterAFullDisk) {
  send(1, setPaused(true));
  ASSERT_TRUE(isAnswered(1));
  ASSERT_TRUE(room_->askForSnapshot());
  ASSERT_TRUE(runUntil([&] { return room_->keptStatus()->snapshot_count >= 2; }));
  {
    const FullDisk full(1);
    room_->roster().arrive({.session = 9, .role = core::Role::kViewer});  // its record cannot be written
    ASSERT_TRUE(runUntil([&] { return room_->keptStatus()->failure_count > 0; }));
  }
  ASSERT_TRUE(runUntil([&] { return room_->keptStatus()->snapshot_count >= 3; })) << "it stands still, with a gap";
  send(2, setPaused(false));
  ASSERT_TRUE(isAnswered(2));
  EXPECT_THAT(outlets_.applied, ElementsAre(1, 2));
}

TEST_F(KeptRoomTest, RetriesAFailedSnapshotSoon) {
  ASSERT_TRUE(runTicks(3));
  {
    const FullDisk full(kLogsOnly);
    ASSERT_TRUE(room_->askForSnapshot());
    ASSERT_TRUE(runUntil([&] { return room_->keptStatus()->failure_count >= 3; })) << "it is tried again meanwhile";
  }
  const std::uint64_t generation = room_->keptStatus()->files.generation;
  EXPECT_LE(generation, 2u) << "without further logs";
  ASSERT_TRUE(runUntil([&] { return room_->keptStatus()->snapshot_count >= 2; })) << "the next is due in an hour";
  send(1, splash());
  ASSERT_TRUE(isAnswered(1));
  EXPECT_THAT(outlets_.applied, ElementsAre(1));
  expectSameAfterACrash(8);
}

/// Sleeps when nobody is connected.
class SleepingRoomTest : public KeptRoomTest {
 protected:
  struct Deserted final : SilentOutlets {
    void commandApplied(const rooms::Command&, const v1::Ack&) override { ++applied_count; }
    void commandRejected(const rooms::Command&, const wire::CommandRejection&) override { ++rejected_count; }
    int applied_count = 0, rejected_count = 0;
  };
  Deserted deserted_;
};

TEST_F(SleepingRoomTest, TakesCommandsAgainAfterAFullDisk) {
  crash();
  openStore();
  auto kept = rules_.states->place("asleep");
  ASSERT_TRUE(kept);
  auto scene = scene::parseSceneText(std::string(kStillPool) + " unwatched: UNWATCHED_SLEEP", "asleep");
  ASSERT_TRUE(scene);
  auto water = water::Water::create(device_, *std::move(scene));
  ASSERT_TRUE(water);
  auto room = test::openRoom("asleep", *std::move(water), rules_, *builder_, deserted_, *std::move(kept));
  ASSERT_TRUE(room) << room.error().message;
  room_ = *std::move(room);
  room_->start(Clock::now());
  ASSERT_TRUE(runUntil([&] { return room_->vitals()->asleep; }));
  ASSERT_TRUE(room_->askForSnapshot());
  ASSERT_TRUE(runUntil([&] { return room_->keptStatus()->snapshot_count >= 2; }));
  {
    const FullDisk full(1);
    room_->roster().arrive({.session = 9, .role = core::Role::kViewer});
    ASSERT_TRUE(runUntil([&] { return room_->keptStatus()->failure_count > 0; }));
  }
  ASSERT_TRUE(runUntil([&] { return room_->keptStatus()->snapshot_count >= 3; }));
  send(1, setSpeed(0.5));
  ASSERT_TRUE(runUntil([&] { return deserted_.applied_count + deserted_.rejected_count > 0; }));
  EXPECT_EQ(deserted_.applied_count, 1);
}

}  // namespace
}  // namespace spindrift::test
