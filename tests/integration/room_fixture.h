// A room alone, run tick by tick by the test: without network and simulation thread.
#pragma once

#include <gmock/gmock.h>

#include <spindrift/codec/stream.h>
#include <spindrift/rooms/room.h>
#include <spindrift/scene/scene_loader.h>

#include "open_room.h"
#include "server_fixture.h"
#include "silent_outlets.h"

namespace spindrift::test {

using namespace std::chrono_literals;

/// Records the room's outlets.
struct RecordingOutlets final : SilentOutlets {
  int scene_count = 0;
  int recovered_count = 0;
  int frame_count = 0;
  std::vector<core::LevelSet> ready_levels;  ///< of each frame
  bool keeps_frames = false;                 ///< those on the device, as an encoder that does not come to them
  std::vector<core::FrameView> kept_frames;
  std::vector<std::uint64_t> applied;
  std::vector<v1::QueryAnswer> query_answers;
  std::vector<v1::HullForces> hull_forces;
  std::vector<std::string> rejected;
  std::vector<std::string> fidelity_news;
  std::vector<std::uint64_t> rejected_ids;

  void sceneChanged(const rooms::Room&) override { ++scene_count; }
  void fidelityChanged(const rooms::Room&, const std::string& how) override { fidelity_news.push_back(how); }
  void hasRecovered(const rooms::Room&, const std::string&) override { ++recovered_count; }
  void commandApplied(const rooms::Command& command, const v1::Ack&) override { applied.push_back(command.id()); }
  void commandRejected(const rooms::Command&, const wire::CommandRejection& rejection) override {
    rejected.push_back(rejection.message());
    rejected_ids.push_back(rejection.command_id());
  }
  void queryAnswered(const rooms::Room&, const core::Sender&, const v1::QueryAnswer& answer) override {
    query_answers.push_back(answer);
  }
  void hullsFelt(const rooms::Room&, const core::Sender&, const v1::HullForces& forces) override {
    hull_forces.push_back(forces);
  }
  void frameReady(const rooms::Room&, core::FrameView frame) override {
    ++frame_count;
    ready_levels.push_back(frame.due);
    if (keeps_frames && frame.lease) kept_frames.push_back(std::move(frame));
  }
};

class RoomTest : public testing::Test {
 protected:
  void SetUp() override {
    device_.kind = gpu::DeviceChoice::Kind::kSoftware;
    auto scene = scene::parseSceneText(sceneText(), sceneName());
    ASSERT_TRUE(scene);
    auto water = water::Water::create(device_, *std::move(scene));
    if (!water && water.error().code == core::ErrorCode::kNoDevice) GTEST_SKIP() << water.error().message;
    ASSERT_TRUE(water);
    context_ = &(*water)->context();
    builder_ = std::make_unique<water::WaterBuilder>(device_, rules_.scenes);
    auto room = test::openRoom("main", *std::move(water), rules_, *builder_, outlets_, place());
    ASSERT_TRUE(room);
    room_ = *std::move(room);
    watchEverything();
    room_->loadFrom([] { return rooms::ServerLoad{.people_count = 1}; });
    room_->start(Clock::now());
  }
  void TearDown() override {
    if (room_) room_->releaseDevice();
  }

  virtual std::string sceneText() const { return kStillPool; }
  virtual std::string sceneName() const { return "main"; }
  /// Where the room is kept on disk.
  virtual history::RoomPlace place() { return {}; }

  /// One session watches everything at full detail.
  void watchEverything() {
    room_->demand()->addSessions(1);
    for (const codec::Stream& stream : codec::allStreams())
      room_->demand()->set(codec::indexOf(stream), this, core::DemandTable::Need{});
  }

  /// Runs the room until the condition holds; false after kPatience.
  bool runUntil(const std::function<bool()>& holds) {
    const auto deadline = Clock::now() + kPatience;
    while (!holds()) {
      if (Clock::now() > deadline) return false;
      room_->run(Clock::now());
      std::this_thread::sleep_for(1ms);
    }
    return true;
  }
  void send(std::uint64_t command_id, v1::Command message = splash(), std::uint64_t session_id = 1,
            std::uint32_t person_id = 0) {
    auto checked = wire::checkCommand(numbered(command_id, std::move(message)));
    ASSERT_TRUE(std::holds_alternative<v1::Command>(checked));
    const auto refused = room_->admit({.sender = {.session_id = session_id, .person_id = person_id},
                                       .message = std::get<v1::Command>(std::move(checked))});
    ASSERT_FALSE(refused) << refused->message();
  }

  using Clock = std::chrono::steady_clock;
  gpu::DeviceChoice device_;
  rooms::RoomRules rules_;
  RecordingOutlets outlets_;
  std::unique_ptr<water::WaterBuilder> builder_;
  std::shared_ptr<rooms::Room> room_;
  gpu::Context* context_ = nullptr;  ///< of the room's first water
};

}  // namespace spindrift::test
