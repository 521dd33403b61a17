// A room alone, run tick by tick by the test: no network, no simulation thread.
#pragma once

#include <map>

#include <gmock/gmock.h>

#include <spindrift/rooms/room.h>
#include <spindrift/scene/scene_loader.h>

#include "server_fixture.h"

namespace spindrift::test {

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

struct RecordingObserver final : rooms::RoomObserver {
  int scene_count = 0;
  std::vector<std::uint64_t> applied;
  std::vector<std::string> rejected;
  std::vector<std::uint64_t> rejected_ids;

  void sceneChanged(const rooms::Room&) override { ++scene_count; }
  void commandApplied(const core::Command& command, std::uint64_t, std::uint32_t) override {
    applied.push_back(command.command_id);
  }
  void commandRejected(const core::Command&, const wire::CommandRejection& rejection) override {
    rejected.push_back(rejection.message);
    rejected_ids.push_back(rejection.command_id);
  }
};

class RoomTest : public testing::Test {
 protected:
  void SetUp() override {
    device_.kind = gpu::DeviceChoice::Kind::kSoftware;
    auto scene = scene::parseSceneText(kStillPool, "main");
    ASSERT_TRUE(scene);
    auto water = rooms::Water::create(device_, *std::move(scene));
    if (!water && water.error().code == core::ErrorCode::kNoDevice) GTEST_SKIP() << water.error().message;
    ASSERT_TRUE(water);
    context_ = &(*water)->context();
    builder_ = std::make_unique<rooms::WaterBuilder>(device_);
    auto room = rooms::Room::create("main", *std::move(water), rules_, *builder_);
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
  void send(std::uint64_t command_id, core::Action action = core::Splash{}, std::uint64_t session_id = 1) {
    const auto refused =
        room_->admit({.sender = {.session_id = session_id}, .command_id = command_id, .action = std::move(action)});
    ASSERT_FALSE(refused) << refused->message;
  }

  using Clock = std::chrono::steady_clock;
  gpu::DeviceChoice device_;
  rooms::RoomRules rules_;
  RecordingHub hub_;
  RecordingObserver observer_;
  rooms::EncoderThread encoder_{hub_};
  std::unique_ptr<rooms::WaterBuilder> builder_;
  std::shared_ptr<rooms::Room> room_;
  gpu::Context* context_ = nullptr;  ///< of the room's first water
};

}  // namespace spindrift::test
