// The fidelity of a running room: the same water continues at another level, for a person and where the machine cannot
// keep up.
#include <spindrift/history/replay.h>
#include <spindrift/scene/fidelity.h>

#include "room_fixture.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kPond = R"(
  wave { resolution_count: 96 side_m: 14 depth_m: 2 damping_per_s: 0.1 }
  boats { capacity_count: 4 boats { x_m: 2 } }
)";

class RoomFidelity : public RoomTest {
 protected:
  void SetUp() override {
    folder_.write("pond.textproto", sceneText());
    rules_.scenes = water::SceneCatalog(folder_.path());
    rules_.record_folder = folder_.path() / "logs";
    rules_.hash_interval_ticks = 5;
    RoomTest::SetUp();
  }
  std::string sceneText() const override { return kPond; }
  std::string sceneName() const override { return "pond"; }

  static v1::Command level(v1::Fidelity fidelity, const std::string& name = "pond") {
    v1::Command command = changeScene(name);
    command.mutable_change_scene()->set_fidelity(fidelity);
    return command;
  }
  v1::Scene scene() const { return room_->snapshot()->scene; }
  bool runTicks(std::uint64_t count) {
    const std::uint64_t end = room_->tick() + count;
    return runUntil([&] { return room_->tick() >= end; });
  }
  bool isAnswered(std::size_t count) {
    return runUntil([&] { return outlets_.applied.size() + outlets_.rejected.size() >= count; });
  }

  TemporaryFolder folder_;
};

TEST_F(RoomFidelity, WaterContinuesAtAnotherLevel) {
  send(1, splash(0.5));
  ASSERT_TRUE(runTicks(20));
  const double time_s = room_->water().time_s();
  const std::uint64_t tick = room_->tick();
  send(2, level(v1::FIDELITY_DRAFT));
  ASSERT_TRUE(isAnswered(2));
  EXPECT_THAT(outlets_.applied, ElementsAre(1, 2));
  EXPECT_EQ(scene().fidelity(), v1::FIDELITY_DRAFT);
  EXPECT_EQ(scene().wave().resolution_count(), 48u);
  EXPECT_EQ(scene().name(), "pond");
  EXPECT_EQ(outlets_.scene_count, 1) << "everybody is greeted again";
  EXPECT_THAT(outlets_.fidelity_news, ElementsAre("fidelity is now draft instead of balanced"));
  EXPECT_GE(room_->water().time_s(), time_s);
  EXPECT_GT(room_->tick(), tick);
  ASSERT_TRUE(runTicks(20));
  EXPECT_GT(room_->water().health().max_elevation_m, 0.005) << "the splash's rings are still there";
  EXPECT_EQ(room_->water().health().volume_error_units, 0);
  const v1::FidelityLevels levels = room_->vitals()->fidelity_levels;
  ASSERT_EQ(levels.levels_size(), 4);
  EXPECT_GT(levels.levels(0).cost_ms_per_s(), 0.0);
  EXPECT_NEAR(levels.levels(1).cost_ms_per_s(), 4.0 * levels.levels(0).cost_ms_per_s(), 1e-6);
}

TEST_F(RoomFidelity, KeepsBoatsTheirOwnersAndTheParameters) {
  const std::uint32_t person_id =
      room_->roster().arrive({.session = 1, .role = core::Role::kOperator, .name = "Ada"}).person_id;
  send(1, setParameter("wave.damping_per_s", 0.25));
  send(2, spawnBoat(-3, 2), 1, person_id);
  ASSERT_TRUE(isAnswered(2));
  send(3, level(v1::FIDELITY_DRAFT));
  send(4, setParameter("wave.depth_m", 2.25), 2);  // while the water is built
  ASSERT_TRUE(isAnswered(4));
  EXPECT_THAT(outlets_.rejected, testing::IsEmpty());
  EXPECT_EQ(scene().fidelity(), v1::FIDELITY_DRAFT);
  EXPECT_EQ(scene().wave().damping_per_s(), 0.25);
  EXPECT_EQ(scene().wave().depth_m(), 2.25);
  EXPECT_EQ(room_->water().scene().wave->depth_m, 2.25);
  ASSERT_EQ(room_->water().boats().size(), 2u);
  EXPECT_EQ(room_->water().boats()[1].boat_id, 2u);
  EXPECT_EQ(room_->roster().ownerOf(2), person_id);
  send(5, controlBoat(2, 1, 0), 1, person_id);
  ASSERT_TRUE(isAnswered(5));
  EXPECT_THAT(outlets_.rejected, testing::IsEmpty());
}

TEST_F(RoomFidelity, KeepsTheGaugesThatPeopleHavePlacedUntilAnotherSceneBegins) {
  const std::uint32_t person_id =
      room_->roster().arrive({.session = 1, .role = core::Role::kOperator, .name = "Ada"}).person_id;
  send(1, placeGauge(-3, 2), 1, person_id);
  ASSERT_TRUE(isAnswered(1));
  ASSERT_TRUE(runTicks(20));
  send(2, level(v1::FIDELITY_DRAFT));
  ASSERT_TRUE(isAnswered(2));
  ASSERT_TRUE(runTicks(20));
  EXPECT_THAT(outlets_.rejected, testing::IsEmpty());
  const auto placed = room_->snapshot()->placed_gauges;
  ASSERT_EQ(placed.size(), 1u);
  EXPECT_EQ(placed[0].x_m, -3.0);
  EXPECT_EQ(placed[0].person_id, person_id);
  const auto times_s = placed[0].history->series(0).time_s;
  ASSERT_GT(times_s.size(), 5u) << "the new water measures it";
  EXPECT_GT(times_s.front(), 0.2) << "time continues";
  const auto later = Clock::now() + 1s;  // scenes follow each other at an interval
  ASSERT_TRUE(runUntil([&] { return Clock::now() >= later; }));
  send(3, changeScene("pond"));
  ASSERT_TRUE(isAnswered(3));
  EXPECT_THAT(outlets_.rejected, testing::IsEmpty());
  EXPECT_THAT(room_->snapshot()->placed_gauges, testing::IsEmpty());
  room_->roster().leave(1, Clock::now());
  EXPECT_FALSE(room_->roster().isHere(person_id)) << "without a gauge nobody is kept";
}

TEST_F(RoomFidelity, PresentLevelChangesNothing) {
  send(1, level(v1::FIDELITY_BALANCED));
  ASSERT_TRUE(isAnswered(1));
  EXPECT_THAT(outlets_.applied, ElementsAre(1));
  EXPECT_EQ(outlets_.scene_count, 0);
}

TEST_F(RoomFidelity, SceneWithoutALevelStartsFromTheBeginning) {
  ASSERT_TRUE(runTicks(30));
  send(1, changeScene("pond"));
  ASSERT_TRUE(isAnswered(1));
  EXPECT_LT(room_->water().time_s(), 0.2);
  EXPECT_THAT(outlets_.fidelity_news, testing::IsEmpty());
}

/// One wave step per tick suits BALANCED; at FINE it breaks the rule for the step.
TEST_F(RoomFidelity, ImpossibleLevelIsRejectedWithNumbers) {
  folder_.write("pond.textproto",
                "wave { resolution_count: 96 side_m: 14 depth_m: 2 fixed_substeps_count: 1 }\n"
                "boats { capacity_count: 4 }");
  ASSERT_TRUE(runTicks(10));
  const double time_s = room_->water().time_s();
  send(1, level(v1::FIDELITY_FINE));
  ASSERT_TRUE(isAnswered(1));
  ASSERT_EQ(outlets_.rejected.size(), 1u);
  EXPECT_THAT(outlets_.rejected[0], HasSubstr("fixed_substeps_count"));
  EXPECT_THAT(outlets_.rejected[0], testing::ContainsRegex("[0-9]"));
  EXPECT_EQ(scene().fidelity(), v1::FIDELITY_BALANCED);
  EXPECT_EQ(outlets_.scene_count, 0);
  ASSERT_TRUE(runTicks(5));
  EXPECT_GT(room_->water().time_s(), time_s);
}

TEST_F(RoomFidelity, ChangedSceneFileIsRejected) {
  folder_.write("pond.textproto", "wave { resolution_count: 96 side_m: 10 depth_m: 2 }");
  send(1, level(v1::FIDELITY_DRAFT));
  ASSERT_TRUE(isAnswered(1));
  ASSERT_EQ(outlets_.rejected.size(), 1u);
  EXPECT_THAT(outlets_.rejected[0], HasSubstr("cannot continue"));
  EXPECT_EQ(scene().wave().side_m(), 14.0);
  EXPECT_TRUE(runTicks(5));
  send(2, level(v1::FIDELITY_DRAFT, "lake"));
  ASSERT_TRUE(isAnswered(2));
  EXPECT_THAT(outlets_.rejected[1], HasSubstr("no scene 'lake'"));
}

TEST_F(RoomFidelity, OnlyAnOperatorChangesIt) {
  auto checked = wire::checkCommand(numbered(1, level(v1::FIDELITY_DRAFT)));
  const auto refused = room_->admit(
      {.sender = {.session_id = 1, .role = core::Role::kPlayer}, .message = std::get<v1::Command>(std::move(checked))});
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->reason(), v1::REJECT_REASON_FORBIDDEN);
}

TEST_F(RoomFidelity, ALogReplaysTheChangeBitForBit) {
  send(1, splash(0.5));
  ASSERT_TRUE(runTicks(12));
  send(2, level(v1::FIDELITY_DRAFT));
  ASSERT_TRUE(isAnswered(2));
  ASSERT_TRUE(runTicks(12));
  send(3, controlBoat(1, 1, 0.2));
  ASSERT_TRUE(isAnswered(3));
  ASSERT_TRUE(runTicks(12));
  room_->releaseDevice();
  room_.reset();
  std::filesystem::path file;
  for (const auto& entry : std::filesystem::directory_iterator(rules_.record_folder)) file = entry.path();
  auto log = history::CommandLogReader::open(file);
  ASSERT_TRUE(log);
  const auto outcome = history::replayLog(device_, **log);
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_GE(outcome->hash_count, 6u);
  EXPECT_FALSE(outcome->difference) << "at tick " << outcome->difference->tick;
}

/// Nobody's machine runs this in real time on a software device: 960 ticks per second of 480 x 480 cells.
class RoomAdapts : public RoomFidelity {
 protected:
  void SetUp() override {
    rules_.adapts = true;
    RoomFidelity::SetUp();
  }
  std::string sceneText() const override {
    return "tick_rate_hz: 240 wave { resolution_count: 480 side_m: 48 depth_m: 1 dispersion: DISPERSION_AIRY }";
  }
};

TEST_F(RoomAdapts, LowersItsLevelOnASlowMachine) {
  send(1, setSpeed(4.0));
  ASSERT_TRUE(runUntil([&] { return !outlets_.fidelity_news.empty(); }));
  EXPECT_EQ(scene().fidelity(), v1::FIDELITY_DRAFT);
  EXPECT_EQ(scene().wave().resolution_count(), 240u);
  EXPECT_THAT(outlets_.fidelity_news[0], HasSubstr("could not keep up"));
  EXPECT_THAT(outlets_.fidelity_news[0], HasSubstr("fidelity is now draft instead of balanced"));
  EXPECT_EQ(outlets_.scene_count, 1);
}

}  // namespace
}  // namespace spindrift::test
