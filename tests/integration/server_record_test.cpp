// A room's log: recorded from a live server with clients at work, replayed, and compared.
#include <filesystem>
#include <optional>

#include <spindrift/history/replay.h>

#include "server_fixture.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

namespace fs = std::filesystem;

class Recorded : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", R"(
      seed: 7
      wave { resolution_count: 48 side_m: 12 depth_m: 1 }
      particles { count: 1024 layers_count: 2 headroom_m: 2 }
      coupling {}
      foam {}
      boats { capacity_count: 4 boats { x_m: 2 z_m: 0 } }
    )"}};
  }
  water::SceneCatalog scenes() const override {
    folder_.write("pond.textproto", "wave { resolution_count: 48 side_m: 4 depth_m: 0.5 }");
    return water::SceneCatalog(folder_.path());
  }
  void adjust(service::WaterServerOptions& options) const override {
    options.rules.record_folder = folder_.path() / "logs";
    options.rules.hash_interval_ticks = 5;
  }

  fs::path logFile() const {
    for (const auto& entry : fs::directory_iterator(folder_.path() / "logs")) return entry.path();
    return {};
  }

  static core::Result<history::ReplayOutcome> replayed(const fs::path& file) {
    auto log = history::CommandLogReader::open(file);
    if (!log) return log.error();
    gpu::DeviceChoice device;
    device.kind = gpu::DeviceChoice::Kind::kSoftware;
    return history::replayLog(device, **log);
  }

  /// Records a session with every kind of change of the water; the server has stopped at the end.
  void live() {
    ScriptedClient one = client();
    one.subscribe(v1::LAYER_SURFACE);
    one.subscribe(v1::LAYER_PARTICLES, 60.0, v1::PACKING_PACKED);
    ASSERT_TRUE(one.apply(splash(0.3)));
    ASSERT_TRUE(one.runFor(10));
    ASSERT_TRUE(one.apply(setParameter("wave.depth_m", 1.2)));
    ASSERT_TRUE(one.apply(spawnBoat(-2, 1)));
    ASSERT_TRUE(one.apply(controlBoat(2, 1, 0.3)));
    v1::Command move;
    move.mutable_move_boat()->set_boat_id(1);
    move.mutable_move_boat()->set_velocity_x_mps(0.5);
    ASSERT_TRUE(one.apply(move));
    ASSERT_TRUE(one.runFor(10));
    ASSERT_TRUE(one.apply(reset()));
    ASSERT_TRUE(one.apply(splash(0.2)));
    ASSERT_TRUE(one.runFor(10));
    ASSERT_TRUE(one.apply(changeScene("pond")));
    ASSERT_TRUE(one.apply(splash(0.1, 0.4)));
    ASSERT_TRUE(one.runFor(10));
    server().stop();
  }

  TemporaryFolder folder_;
};

TEST_F(Recorded, ARoomRunsAgainBitForBit) {
  live();
  const auto outcome = replayed(logFile());
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->command_count, 8U);
  EXPECT_GE(outcome->hash_count, 8U);
  EXPECT_FALSE(outcome->difference) << "at tick " << outcome->difference->tick;
  EXPECT_FALSE(outcome->truncation);
  EXPECT_FALSE(outcome->device_difference) << *outcome->device_difference;
}

TEST_F(Recorded, AHeldClockAndASeedAreReplayedBitForBit) {
  {
    ScriptedClient one = client();
    ASSERT_TRUE(one.apply(takeClock()));
    ASSERT_TRUE(one.apply(splash(0.3)));
    ASSERT_TRUE(one.ask(waitingStep(20)).has_ack());
    ASSERT_TRUE(one.apply(spawnBoat(-2, 1)));
    ASSERT_TRUE(one.apply(seededReset(99)));
    EXPECT_EQ(one.ask(spawnBoat(-2, 1)).ack().boat_id(), 2u) << "after the scene's boat";
    ASSERT_TRUE(one.apply(splash(0.2)));
    ASSERT_TRUE(one.ask(waitingStep(20)).has_ack());
    // A boat of somebody who leaves is stopped, which counts as a command if the room still runs then.
    ASSERT_TRUE(one.apply(removeBoat(2)));
    ASSERT_TRUE(one.apply(releaseClock()));
    ASSERT_TRUE(one.runFor(10));
    server().stop();
  }
  const auto outcome = replayed(logFile());
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->command_count, 6U);
  EXPECT_GE(outcome->hash_count, 8U);
  EXPECT_FALSE(outcome->difference) << "at tick " << outcome->difference->tick;
}

/// Particles whose number may change while the room runs.
class RecordedPool : public Recorded {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kStillPool}}; }
};

TEST_F(RecordedPool, ReplaysALayoutChangeBitForBit) {
  ScriptedClient one = client();
  ASSERT_TRUE(one.apply(splash(0.3)));
  ASSERT_TRUE(one.runFor(10));
  ASSERT_TRUE(one.apply(setParameter("particles.count", 9000)));
  ASSERT_TRUE(one.apply(splash(0.2)));
  ASSERT_TRUE(one.runFor(10));
  ASSERT_TRUE(one.apply(setParameter("particles.count", 3000)));
  ASSERT_TRUE(one.runFor(10));
  server().stop();
  const auto outcome = replayed(logFile());
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_EQ(outcome->command_count, 4U);
  EXPECT_GE(outcome->hash_count, 6U);
  EXPECT_FALSE(outcome->difference) << "at tick " << outcome->difference->tick;
}

/// A scene that starts again every second, with a beach at +x.
class RecordedRepeating : public Recorded {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", R"(
      restart_after_s: 1
      wave { resolution_count: 32 side_m: 8 depth_m: 1 boundary_plus_x: WAVE_BOUNDARY_REFLECT boundary_minus_x: WAVE_BOUNDARY_ABSORB }
      beaches { side: SIDE_PLUS_X width_m: 3 }
    )"}};
  }
};

TEST_F(RecordedRepeating, ReplaysItsRestartsBitForBit) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  v1::Command wave;
  wave.mutable_breaking_wave();
  ASSERT_TRUE(one.apply(wave));
  constexpr int kRestarts = 2;
  for (int k = 0; k < kRestarts; ++k) {
    ASSERT_TRUE(one.waitFor([](const v1::ServerMessage& message) {
      return message.has_room_event() && message.room_event().kind() == v1::ROOM_EVENT_KIND_RESET;
    }));
  }
  server().stop();
  const auto outcome = replayed(logFile());
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_GE(outcome->command_count, 1U + kRestarts) << "the wave and the restarts";
  EXPECT_GE(outcome->hash_count, 20U);
  EXPECT_FALSE(outcome->difference) << "at tick " << outcome->difference->tick;

  auto log = history::CommandLogReader::open(logFile());
  ASSERT_TRUE(log);
  std::vector<v1::Side> sides;
  while (const auto record = (*log)->next()) {
    if (record->command().has_breaking_wave()) sides.push_back(record->command().breaking_wave().side());
  }
  EXPECT_THAT(sides, testing::ElementsAre(v1::SIDE_MINUS_X)) << "the log holds the side that the water decided";
}

TEST_F(Recorded, TruncatedLogIsReplayedToItsLastRecord) {
  live();
  fs::resize_file(logFile(), fs::file_size(logFile()) - 3);
  const auto outcome = replayed(logFile());
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_GE(outcome->hash_count, 7U);
  EXPECT_FALSE(outcome->difference);
  ASSERT_TRUE(outcome->truncation);
}

TEST_F(Recorded, TheFirstTickThatDiffersIsNamed) {
  live();
  // The same log without the first splash.
  const auto log = history::CommandLogReader::open(logFile());
  ASSERT_TRUE(log);
  v1::RecordHeader header = (*log)->header();
  auto changed = history::CommandLogWriter::create(folder_.path() / "changed", header);
  ASSERT_TRUE(changed);
  std::optional<std::uint64_t> splash_tick;  // 0 when the client was faster than the first tick
  std::uint64_t next_hash_tick = 0;
  while (const auto record = (*log)->next()) {
    if (!splash_tick && record->has_command() && record->command().has_splash()) {
      splash_tick = record->tick();
      continue;
    }
    if (splash_tick && next_hash_tick == 0 && record->has_state_hash()) next_hash_tick = record->tick();
    (*changed)->write(*record);
  }
  const auto outcome = replayed((*changed)->file());
  ASSERT_TRUE(outcome) << outcome.error().message;
  ASSERT_TRUE(outcome->difference);
  EXPECT_EQ(outcome->difference->tick, next_hash_tick);
  ASSERT_TRUE(splash_tick);
  EXPECT_LE(outcome->difference->last_equal_tick, *splash_tick);
}

TEST_F(Recorded, AnotherDriverThanTheLogsIsReported) {
  live();
  const auto log = history::CommandLogReader::open(logFile());
  ASSERT_TRUE(log);
  EXPECT_FALSE((*log)->header().gl_version().empty());
  v1::RecordHeader header = (*log)->header();
  header.set_gl_version("4.5 (Core Profile) Mesa 99.0");
  auto changed = history::CommandLogWriter::create(folder_.path() / "changed", header);
  ASSERT_TRUE(changed);
  while (const auto record = (*log)->next()) (*changed)->write(*record);
  const auto outcome = replayed((*changed)->file());
  ASSERT_TRUE(outcome) << outcome.error().message;
  EXPECT_FALSE(outcome->difference);
  ASSERT_TRUE(outcome->device_difference);
  EXPECT_NE(outcome->device_difference->find("Mesa 99.0"), std::string::npos);
}

}  // namespace
}  // namespace spindrift::test
