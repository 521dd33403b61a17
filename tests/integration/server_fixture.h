// A whole server in this process, with small scenes on the software device and a free port.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include <spindrift/codec/frame_decoder.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/service/water_server.h>

#include "scripted_client.h"

namespace spindrift::test {

/// Every part, no event: the surface is exactly flat until the first command.
inline constexpr const char* kStillPool = R"(
  wave { resolution_count: 32 side_m: 8 depth_m: 1 }
  particles { count: 512 layers_count: 2 headroom_m: 2 }
  coupling {}
  foam {}
)";

/// The cheapest scene there is: sixty frames per second, one frame per tick.
inline constexpr const char* kStillWave = R"(
  wave { resolution_count: 32 side_m: 8 depth_m: 1 }
  stream { frame_rate_hz: 60 }
)";

struct RoomText {
  std::string name;
  std::string scene;
};

class ServerTest : public testing::Test {
 protected:
  virtual std::vector<RoomText> rooms() const { return {{"main", kStillPool}}; }

  /// The scenes for ChangeScene.
  virtual water::SceneCatalog scenes() const { return {}; }
  /// Further changes to the options by a test.
  virtual void adjust(service::WaterServerOptions& /*options*/) const {}

  core::Result<std::unique_ptr<service::WaterServer>> tryToStart() const {
    service::WaterServerOptions options;
    options.device.kind = gpu::DeviceChoice::Kind::kSoftware;
    options.network.port = 0;
    options.rules.scenes = scenes();
    for (const RoomText& room : rooms()) {
      auto scene = scene::parseSceneText(room.scene, room.name);
      EXPECT_TRUE(scene) << scene.error().message;
      options.rooms.push_back({room.name, *std::move(scene)});
    }
    adjust(options);
    return service::WaterServer::start(std::move(options));
  }

  void SetUp() override {
    auto started = tryToStart();
    if (!started && started.error().code == core::ErrorCode::kNoDevice) GTEST_SKIP() << started.error().message;
    ASSERT_TRUE(started) << started.error().message;
    server_ = *std::move(started);
  }

  service::WaterServer& server() { return *server_; }
  /// Ends the server; SetUp() starts another one.
  void stop() { server_.reset(); }
  const rooms::EncoderThread& encoder() const { return server_->encoder(); }

  /// Frames of a stream encoded so far, of all levels and rooms.
  std::uint64_t encodedFrameCount(codec::Stream stream) const {
    std::uint64_t count = 0;
    const rooms::EncoderThread::Costs costs = encoder().costs();
    for (const auto& level : costs[codec::indexOf(stream)]) count += level.frame_count;
    return count;
  }

  /// Layer frames that sessions were given so far: sent, or replaced by a newer one before they were sent. Frames that
  /// still wait are not counted: at most two per session and layer, one in its slot and one on its way to the socket.
  std::uint64_t offeredFrameCount() const {
    const net::ServerStats stats = server_->networkStats();
    return stats.sent_frame_count + stats.dropped_frame_count;
  }

  /// Reads frames until each of them, encoded since this began, was given to `clients_count` sessions, except for
  /// `waiting_count` that may still wait; returns whether it was. `read` reads one frame of every client. The frames on
  /// their way from the encoder to the sessions are the more the busier the machine is, but not the more the longer
  /// this reads; frames encoded for each client, or twice, would be too many however long it reads.
  bool areEncodedOnce(std::uint64_t clients_count, std::uint64_t waiting_count,
                      const std::function<std::uint64_t()>& encoded, const std::function<void()>& read,
                      int least_rounds) const {
    constexpr int kMostRounds = 600;
    const std::uint64_t offered_before = offeredFrameCount();
    const std::uint64_t encoded_before = encoded();
    for (int round = 1; round <= kMostRounds && !testing::Test::HasFatalFailure(); ++round) {
      read();
      if (round < least_rounds) continue;
      const std::uint64_t encoded_count = encoded() - encoded_before;
      // In thirds, so that frames encoded twice do not come within the bound in the long run.
      if (3 * clients_count * encoded_count <=
          4 * (offeredFrameCount() - offered_before) + 3 * clients_count * waiting_count)
        return true;
    }
    return false;
  }

  /// A client that has said hello.
  ScriptedClient client(const std::string& room = "") { return person({}, room); }

  /// A client that has sent Hello as a person; welcome() is empty if it was refused.
  ScriptedClient person(const Person& who, const std::string& room = "") {
    ScriptedClient made(server_->port(), room);
    EXPECT_TRUE(made.isOpen());
    made.hello(who);
    (void)made.welcome();  // from here on it receives state messages
    return made;
  }

 private:
  std::unique_ptr<service::WaterServer> server_;
};

class WaveServerTest : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kStillWave}}; }
};

/// Encoded frames of one layer that a session may not have counted yet: those of ServerTest::offeredFrameCount(), and
/// one that is between the encoder and the sessions.
inline constexpr std::uint64_t kWaitingFrames = 3;

/// Largest elevation of a frame; -1 if it cannot be decoded.
inline double maxElevation_m(const v1::LayerFrame& frame) {
  const auto surface = codec::decodeSurface(frame);
  if (!surface) return -1.0;
  double max_m = 0.0;
  for (const float eta_m : surface->elevation_m) max_m = std::max(max_m, std::abs(static_cast<double>(eta_m)));
  return max_m;
}

}  // namespace spindrift::test
