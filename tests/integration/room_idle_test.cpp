// Rooms in which nothing happens: how often their threads run them, when they fall asleep, and what wakes them.
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/codec/stream.h>
#include <spindrift/rooms/room_host.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/wire/client_message.h>

#include "commands.h"
#include "open_room.h"
#include "silent_outlets.h"

namespace spindrift::test {
namespace {

using namespace std::chrono_literals;

constexpr auto kPatience = 60s;
constexpr const char* kStillPool = "wave { resolution_count: 32 side_m: 8 depth_m: 1 } unwatched: UNWATCHED_SLEEP";

struct CountingOutlets final : SilentOutlets {
  std::atomic<int> answer_count{0};

  std::mutex mutex;
  std::set<std::thread::id> threads;  ///< that answered

  void commandApplied(const rooms::Command&, const v1::Ack&) override {
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
    ++answer_count;
  }
  void commandRejected(const rooms::Command&, const wire::CommandRejection&) override { ++answer_count; }
};

class IdleRooms : public testing::Test {
 protected:
  static constexpr int kRoomCount = 3;

  void SetUp() override {
    gpu::DeviceChoice device;
    device.kind = gpu::DeviceChoice::Kind::kSoftware;
    std::vector<rooms::RoomSetup> setups;
    for (int k = 0; k < kRoomCount; ++k) {
      auto scene = scene::parseSceneText(kStillPool, "pool");
      ASSERT_TRUE(scene) << scene.error().message;
      setups.push_back({.name = "room" + std::to_string(k), .scene = *std::move(scene)});
    }
    auto started = rooms::RoomHost::start(device, std::move(setups), {}, kRoomCount, outlets_);
    if (!started && started.error().code == core::ErrorCode::kNoDevice) GTEST_SKIP() << started.error().message;
    ASSERT_TRUE(started) << started.error().message;
    simulation_ = *std::move(started);
    simulation_->run();
  }
  void TearDown() override {
    if (simulation_) simulation_->stop();
  }

  bool eventually(const std::function<bool()>& holds) const {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (!holds()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(1ms);
    }
    return true;
  }
  /// Runs of all rooms.
  std::uint64_t runCount() const {
    std::uint64_t out = 0;
    for (const auto& room : simulation_->rooms()) out += room->roundCount();
    return out;
  }
  bool allAreAsleep() const {
    return std::ranges::all_of(simulation_->rooms(), [](const auto& room) { return room->vitals()->asleep; });
  }
  void send(rooms::Room& room, v1::Command command) {
    command.set_command_id(++last_id_);
    auto checked = wire::checkCommand(std::move(command));
    ASSERT_TRUE(std::holds_alternative<v1::Command>(checked));
    const int before = outlets_.answer_count;
    ASSERT_FALSE(room.admit({.sender = {.session_id = 1, .role = core::Role::kOperator},
                             .message = std::get<v1::Command>(std::move(checked))}));
    ASSERT_TRUE(eventually([&] { return outlets_.answer_count > before; }));
  }

  CountingOutlets outlets_;
  std::unique_ptr<rooms::RoomHost> simulation_;
  std::uint64_t last_id_ = 0;
};

TEST_F(IdleRooms, AreRunOncePerSecondWhileTheySleep) {
  ASSERT_TRUE(eventually([&] { return allAreAsleep(); }));
  const std::uint64_t before = runCount();
  std::this_thread::sleep_for(3s);
  EXPECT_LE(runCount() - before, 4U * kRoomCount);
}

TEST_F(IdleRooms, RunOncePerSecondWhilePaused) {
  for (const auto& room : simulation_->rooms()) ASSERT_NO_FATAL_FAILURE(send(*room, setPaused(true)));
  const std::uint64_t before = runCount();
  std::this_thread::sleep_for(3s);
  EXPECT_LE(runCount() - before, 4U * kRoomCount);
}

TEST_F(IdleRooms, AnswerCommandsWithoutWaitingForTheirNextTurn) {
  ASSERT_TRUE(eventually([&] { return allAreAsleep(); }));
  // With a turn per second, 20 commands one after the other would take some 20 s.
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < 20; ++k) ASSERT_NO_FATAL_FAILURE(send(*simulation_->rooms()[1], splash()));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 8s);
}

TEST_F(IdleRooms, EachRunOnAThreadOfItsOwn) {
  for (int turn = 0; turn < 2; ++turn) {
    for (const auto& room : simulation_->rooms()) ASSERT_NO_FATAL_FAILURE(send(*room, splash()));
  }
  const std::lock_guard lock(outlets_.mutex);
  EXPECT_EQ(outlets_.threads.size(), std::size_t{kRoomCount});
}

TEST_F(IdleRooms, WakeUpWhenASessionComes) {
  ASSERT_TRUE(eventually([&] { return allAreAsleep(); }));
  const auto room = simulation_->rooms()[2];
  const std::uint64_t tick = room->vitals()->tick;
  room->demand()->addSessions(1);
  room->wake();
  EXPECT_TRUE(eventually([&] { return room->vitals()->tick > tick; }));
  EXPECT_FALSE(room->vitals()->asleep);
}

TEST_F(IdleRooms, TellAtOnceWhoCame) {
  ASSERT_TRUE(eventually([&] { return allAreAsleep(); }));
  const auto room = simulation_->rooms()[0];
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 1; k <= 10; ++k) {
    const std::uint64_t before = runCount();
    room->roster().arrive({.session = static_cast<core::SessionId>(k)});
    ASSERT_TRUE(eventually([&] { return runCount() > before; }));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 4s);
}

/// A room that is run ahead of the clock, as fast as the machine can.
class UnwatchedRoom : public testing::Test {
 protected:
  using Clock = std::chrono::steady_clock;

  void TearDown() override {
    if (room_) room_->releaseDevice();
  }
  void open(const std::string& scene_text) {
    gpu::DeviceChoice device;
    device.kind = gpu::DeviceChoice::Kind::kSoftware;
    auto scene = scene::parseSceneText("wave { resolution_count: 8 side_m: 8 depth_m: 1 } " + scene_text, "pool");
    ASSERT_TRUE(scene) << scene.error().message;
    auto water = water::Water::create(device, *std::move(scene));
    if (!water && water.error().code == core::ErrorCode::kNoDevice) GTEST_SKIP() << water.error().message;
    ASSERT_TRUE(water) << water.error().message;
    builder_ = std::make_unique<water::WaterBuilder>(device, rules_.scenes);
    auto room = openRoom("pool", *std::move(water), rules_, *builder_, outlets_, {});
    ASSERT_TRUE(room) << room.error().message;
    room_ = *std::move(room);
    now_ = Clock::now();
    room_->start(now_);
  }
  void runFor(double seconds) {
    const auto end = now_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    while (room_->due() < end) {
      now_ = std::max(now_, room_->due());
      room_->run(now_);
    }
    now_ = end;
  }
  bool isAsleep() const { return room_->vitals()->asleep; }
  /// Of the clock, which may be ahead of now_; and two more of patience.
  void expectTenSeconds() {
    runFor(9);
    EXPECT_FALSE(isAsleep());
    runFor(8);
    EXPECT_TRUE(isAsleep());
  }

  struct FrameCount final : SilentOutlets {
    std::size_t frame_count = 0;
    void frameReady(const rooms::Room&, core::FrameView) override { ++frame_count; }
  };
  rooms::RoomRules rules_;
  FrameCount outlets_;
  std::unique_ptr<water::WaterBuilder> builder_;
  std::shared_ptr<rooms::Room> room_;
  Clock::time_point now_{};
};

TEST_F(UnwatchedRoom, SleepsByDefaultAfterItsFirstTwentySeconds) {
  ASSERT_NO_FATAL_FAILURE(open("tick_rate_hz: 10"));
  runFor(19);
  EXPECT_FALSE(isAsleep());
  runFor(5);
  EXPECT_TRUE(isAsleep());
  const std::uint64_t tick = room_->tick();
  EXPECT_GE(tick, 190U);
  EXPECT_LE(tick, 225U);
  runFor(60);
  EXPECT_EQ(room_->tick(), tick);
}

TEST_F(UnwatchedRoom, RunsForeverIfItsSceneSaysSo) {
  ASSERT_NO_FATAL_FAILURE(open("tick_rate_hz: 10 unwatched: UNWATCHED_GO_ON"));
  runFor(40);
  EXPECT_FALSE(isAsleep());
  EXPECT_NEAR(static_cast<double>(room_->tick()), 400.0, 3.0);
}

TEST_F(UnwatchedRoom, RunsForTenSecondsAfterARequest) {
  ASSERT_NO_FATAL_FAILURE(open("tick_rate_hz: 10 unwatched: UNWATCHED_SLEEP"));
  room_->use();
  expectTenSeconds();
}

TEST_F(UnwatchedRoom, RunsForTenSecondsAfterACommandWithoutASession) {
  ASSERT_NO_FATAL_FAILURE(open("tick_rate_hz: 10 unwatched: UNWATCHED_SLEEP"));
  v1::Command command = splash();
  command.set_command_id(1);
  auto checked = wire::checkCommand(std::move(command));
  ASSERT_FALSE(
      room_->admit({.sender = {.role = core::Role::kOperator}, .message = std::get<v1::Command>(std::move(checked))}));
  expectTenSeconds();
}

TEST_F(UnwatchedRoom, MakesAFrameAtTheFirstTickForWhoWakesIt) {
  ASSERT_NO_FATAL_FAILURE(open("tick_rate_hz: 10 unwatched: UNWATCHED_SLEEP"));
  runFor(4);
  ASSERT_TRUE(isAsleep());
  const std::uint64_t tick = room_->tick();
  room_->demand()->addSessions(1);
  room_->demand()->set(codec::indexOf(codec::streamOf(v1::LAYER_SURFACE, v1::PACKING_PLAIN)), this,
                       core::DemandTable::Need{});
  room_->wake();
  EXPECT_LE(room_->due(), now_);
  room_->run(now_);
  EXPECT_EQ(room_->tick(), tick + 1);
  EXPECT_EQ(outlets_.frame_count + room_->water().framesInFlight(), 1U);
}

}  // namespace
}  // namespace spindrift::test
