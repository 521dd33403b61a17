// A room whose device fails: it says so, answers, and runs again from its scene's start on a new context.
#include <map>

#include <gmock/gmock.h>

#include <spindrift/stream/frame_decoder.h>
#include <spindrift/stream/scene_loader.h>

#include "room.h"
#include "server_fixture.h"

namespace spindrift::test {
namespace {

using namespace std::chrono_literals;

/// Keeps the newest state by topic; one session is there.
struct RecordingHub final : net::Hub {
  std::map<std::string, core::SharedBytes> states;

  void sendAnswer(net::SessionId, core::SharedBytes) override {}
  void sendState(net::SessionId, const net::StateTopic&, core::SharedBytes) override {}
  void broadcastState(const std::string&, const net::StateTopic& topic, core::SharedBytes message) override {
    states[topic.name] = std::move(message);
  }
  void publish(const std::string&, net::LayerIndex, const net::LayerBytes&) override {}
  net::LayerDemand demand(const std::string&, net::LayerIndex, std::uint32_t) const override {
    net::LayerDemand out{};
    out.back() = {.watcher_count = 1, .wants_whole = true};
    return out;
  }
  void join(net::SessionId, const std::string&) override {}
  std::size_t sessionCount(const std::string&) const override { return 1; }
  std::size_t sessionCount() const override { return 1; }
  void watch(net::SessionId, net::LayerIndex, const net::Watch&) override {}
  void close(net::SessionId, net::CloseCode, std::string) override {}
  void closeAt(net::SessionId, std::chrono::steady_clock::time_point, net::CloseCode, std::string) override {}
};

struct RecordingObserver final : app::RoomObserver {
  int scene_count = 0;
  std::vector<std::uint64_t> applied;
  std::vector<std::string> rejected;
  std::vector<std::uint64_t> rejected_ids;

  void sceneChanged(const app::Room&) override { ++scene_count; }
  void commandApplied(const core::Command& command, std::uint64_t, std::uint32_t) override {
    applied.push_back(command.command_id);
  }
  void commandRejected(const core::Command&, const stream::CommandRejection& rejection) override {
    rejected.push_back(rejection.message);
    rejected_ids.push_back(rejection.command_id);
  }
};

class RoomLoss : public testing::Test {
 protected:
  void SetUp() override {
    device_.kind = gpu::DeviceChoice::Kind::kSoftware;
    auto scene = stream::parseSceneText(kStillPool, "main");
    ASSERT_TRUE(scene);
    auto water = app::Water::create(device_, *std::move(scene));
    if (!water && water.error().code == core::ErrorCode::kNoDevice) GTEST_SKIP() << water.error().message;
    ASSERT_TRUE(water);
    context_ = &(*water)->context();
    builder_ = std::make_unique<app::WaterBuilder>(device_);
    auto room = app::Room::create("main", *std::move(water), rules_, *builder_);
    ASSERT_TRUE(room);
    room_ = *std::move(room);
    room_->start(Clock::now());
  }
  void TearDown() override {
    encoder_.stop();
    if (room_) room_->releaseDevice();
  }

  /// Runs the room until it is so; false after kPatience.
  bool runUntil(const std::function<bool()>& holds) {
    const auto deadline = Clock::now() + kPatience;
    while (!holds()) {
      if (Clock::now() > deadline) return false;
      room_->run(Clock::now(), hub_, encoder_, observer_);
      std::this_thread::sleep_for(1ms);
    }
    return true;
  }
  void send(std::uint64_t command_id) {
    const auto refused =
        room_->admit({.sender = {.session_id = 1}, .command_id = command_id, .action = core::Splash{}});
    ASSERT_FALSE(refused) << refused->message;
  }

  using Clock = std::chrono::steady_clock;
  gpu::DeviceChoice device_;
  app::RoomRules rules_;
  RecordingHub hub_;
  RecordingObserver observer_;
  app::EncoderThread encoder_{hub_};
  std::unique_ptr<app::WaterBuilder> builder_;
  std::shared_ptr<app::Room> room_;
  gpu::Context* context_ = nullptr;  ///< of the room's first water
};

TEST_F(RoomLoss, RunsAgainFromItsSceneOnANewContextAndTellsEverybody) {
  send(1);
  ASSERT_TRUE(runUntil([&] { return room_->tick() >= 5 && observer_.applied.size() == 1; }));
  const std::uint64_t tick_before = room_->tick();
  context_->simulateLoss();
  room_->run(Clock::now(), hub_, encoder_, observer_);
  EXPECT_TRUE(room_->vitals()->lost);
  EXPECT_EQ(room_->tick(), tick_before) << "nothing runs on a device that failed";
  send(2);
  ASSERT_TRUE(runUntil([&] { return !room_->vitals()->lost; }));
  EXPECT_EQ(observer_.scene_count, 1) << "everybody is greeted again";
  EXPECT_TRUE(hub_.states.contains("recovered"));
  EXPECT_GT(room_->tick(), tick_before) << "ticks never go back";
  ASSERT_TRUE(runUntil([&] { return observer_.rejected.size() + observer_.applied.size() == 2; })) << "2 is answered";
  send(3);
  EXPECT_TRUE(runUntil([&] { return !observer_.applied.empty() && observer_.applied.back() == 3; }));
  const std::uint64_t tick_after = room_->tick();
  EXPECT_TRUE(runUntil([&] { return room_->tick() >= tick_after + 5; }));
}

TEST_F(RoomLoss, AnswersCommandsThatCameBeforeTheLoss) {
  ASSERT_TRUE(runUntil([&] { return room_->tick() >= 2; }));
  send(7);
  context_->simulateLoss();
  room_->run(Clock::now(), hub_, encoder_, observer_);
  ASSERT_EQ(observer_.rejected.size(), 1u);
  EXPECT_THAT(observer_.rejected[0], testing::HasSubstr("the device failed"));
}

TEST_F(RoomLoss, ARoomThatClosesAnswersWhatWaits) {
  send(7);
  send(8);
  room_->abandonCommands(observer_);
  EXPECT_THAT(observer_.rejected_ids, testing::ElementsAre(7, 8));
  EXPECT_THAT(observer_.rejected, testing::Each(testing::HasSubstr("closed")));
}

}  // namespace
}  // namespace spindrift::test
