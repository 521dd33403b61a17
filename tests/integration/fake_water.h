// The network and the encoder without water: a thread makes frames of random samples and passes them to the server's
// EncoderThread. Needs no device, so that sanitizers observe all threads.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/net/server.h>
#include <spindrift/rooms/encoder_thread.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/service/stream_index.h>
#include <spindrift/wire/client_message.h>
#include <spindrift/wire/server_message.h>

#include "commands.h"

namespace spindrift::test {

inline constexpr std::uint32_t kFakeResolutionCount = 32;
inline constexpr std::uint32_t kFakeCoarseCount = 16;
inline constexpr double kFakeQuantum_m = 1.0 / 1024;
/// The first sample of every frame, so that a reader can check whether the samples belong to the tick.
inline std::int16_t markOf(std::uint64_t tick) {
  return static_cast<std::int16_t>(tick % 30'000);
}

/// One frame; its spans point into memory that the lease owns, as with a readback slot.
inline core::FrameView fakeFrame(std::uint64_t tick, std::minstd_rand& random) {
  struct Slot {
    std::vector<std::uint32_t> surface = std::vector<std::uint32_t>(kFakeResolutionCount * kFakeResolutionCount / 2);
    std::vector<std::uint32_t> foam = std::vector<std::uint32_t>(kFakeResolutionCount * kFakeResolutionCount / 4);
    std::vector<std::uint32_t> coarse = std::vector<std::uint32_t>(kFakeCoarseCount * kFakeCoarseCount / 2);
    std::vector<std::uint32_t> particles;
  };
  const auto slot = std::make_shared<Slot>();
  for (std::uint32_t& word : slot->surface) word = random() & 0x003f003fU;
  slot->surface[0] = static_cast<std::uint16_t>(markOf(tick));
  for (std::uint32_t& word : slot->coarse) word = random() & 0x003f003fU;
  slot->coarse[0] = slot->surface[0];
  for (std::uint32_t& word : slot->foam) word = random() & 0x0f000f00U;
  slot->particles.resize(3 * (random() % 300));
  for (std::uint32_t& word : slot->particles) word = static_cast<std::uint32_t>(random()) & 0x00ffffffU;

  core::FrameView frame;
  frame.tick = tick;
  frame.time_s = static_cast<double>(tick) / 60;
  frame.at(core::Level::kFull).surface =
      core::SurfaceView{{kFakeResolutionCount, kFakeResolutionCount}, 8.0, 8.0, kFakeQuantum_m, slot->surface};
  frame.at(core::Level::kFull).foam =
      core::FoamView{{kFakeResolutionCount, kFakeResolutionCount}, 8.0, 8.0, slot->foam};
  frame.reduced_counts.planes = 1;
  core::LevelView& coarse = frame.at(core::Level::kCoarse);
  coarse.surface = core::SurfaceView{{kFakeCoarseCount, kFakeCoarseCount}, 8.0, 8.0, kFakeQuantum_m, slot->coarse};
  coarse.foam = core::FoamView{{kFakeCoarseCount, kFakeCoarseCount},
                               8.0,
                               8.0,
                               std::span(slot->foam).first(kFakeCoarseCount * kFakeCoarseCount / 4)};
  core::ParticleView particles;
  particles.count = static_cast<std::uint32_t>(slot->particles.size() / 3);
  for (double& min : particles.min_m) min = -4.0;
  for (double& max : particles.max_m) max = 4.0;
  particles.max_speed_mps = 8.0;
  particles.radius_m = 0.0625;
  particles.words = slot->particles;
  frame.at(core::Level::kFull).particles = particles;
  frame.diagnostics.emplace();
  frame.lease = slot;
  return frame;
}

/// The application for clients: greets, takes subscriptions like the real gateway, answers every command with an Ack.
class FakeGateway final : public net::Application, public rooms::FrameOutlet {
 public:
  FakeGateway() {
    auto scene = scene::parseSceneText("wave {} particles { count: 100 } coupling {} foam {}", "fake.textproto");
    scene_ = *scene;
  }

  void serverStarts(net::Hub& hub) override { hub_ = &hub; }
  core::Result<void> acceptSession(const std::string&) override { return {}; }
  void sessionOpened(net::SessionId session, const net::SessionOpening& opening) override {
    const std::string& room = opening.room;
    ++opened_count;
    v1::Greeting greeting;
    greeting.set_room(room);
    greeting.set_session_id(session);
    greeting.mutable_room_state()->set_speed(1.0);
    hub_->sendAnswer(session, wire::greeting(std::move(greeting), scene_));
    hub_->join(session, room, demandOf(room));  // afterwards, so that no state message precedes the greeting
  }
  void sessionMessage(net::SessionId session, core::ByteView bytes) override {
    const wire::ClientMessage message = wire::parseClientMessage(bytes);
    if (const auto* subscribe = std::get_if<wire::Subscribe>(&message)) {
      const codec::Stream wanted = codec::streamOf(subscribe->layer, subscribe->packing);
      for (const codec::Stream stream : codec::allStreams()) {
        if (stream.layer != wanted.layer) continue;
        hub_->watch(session, service::streamIndex(stream),
                    {.max_rate_hz = stream.packing == wanted.packing ? subscribe->max_rate_hz : 0.0,
                     .level = subscribe->level,
                     .adapts = subscribe->adapts});
      }
    } else if (const auto* ping = std::get_if<v1::Ping>(&message)) {
      hub_->sendAnswer(session, wire::pong(ping->client_time_s(), 0.0));
    } else if (const auto* command = std::get_if<v1::Command>(&message)) {
      hub_->broadcastState(kRooms[command->command_id() % 2], {.name = "room_state"}, wire::roomState(v1::RoomState()));
      if (command->has_reset()) hub_->join(session, kRooms[1], demands[1]);
      hub_->sendAnswer(session, wire::ack(ackOf(command->command_id(), 0)));
    }
  }
  void sessionClosed(net::SessionId, const net::SessionEnd&) override { ++closed_count; }
  void publish(const std::string& room, codec::Stream stream, const codec::EncodedFrame& frame,
               const core::FrameLevels& levels) override {
    service::publishTo(*hub_, room, stream, frame, levels);
  }
  void httpRequest(const net::HttpRequest&, net::HttpResponder respond) override { respond(std::nullopt); }

  /// The rooms that get frames.
  static inline const std::array<std::string, 2> kRooms{"", "pool"};
  const std::array<std::shared_ptr<core::DemandTable>, 2> demands{std::make_shared<core::DemandTable>(),
                                                                  std::make_shared<core::DemandTable>()};

  std::atomic<int> opened_count{0};
  std::atomic<int> closed_count{0};

 private:
  [[nodiscard]] std::shared_ptr<core::DemandTable> demandOf(const std::string& room) const {
    return demands[room == kRooms[1] ? 1 : 0];
  }

  net::Hub* hub_ = nullptr;
  v1::Scene scene_;
};

/// A server, its encoder, and one thread per room that makes frames until the end.
class FakeWater {
 public:
  explicit FakeWater(net::ServerOptions options) {
    options.port = 0;
    auto started = net::Server::start(options, gateway);
    if (!started) throw std::runtime_error(started.error().message);
    server = std::move(*started);
    encoder = std::make_unique<rooms::EncoderThread>(gateway);
    for (std::size_t room = 0; room < makers_.size(); ++room) {
      makers_[room] = std::thread([this, room] { makeFrames(room); });
    }
  }
  ~FakeWater() {
    stopping_ = true;
    for (std::thread& maker : makers_) maker.join();
    encoder->stop();
    server->stop();
  }
  FakeWater(const FakeWater&) = delete;
  FakeWater& operator=(const FakeWater&) = delete;

  std::uint64_t tick(std::size_t room) const { return ticks_[room]; }
  /// Waits until the room has made this many more frames.
  void waitFrames(std::size_t room, std::uint64_t count) const {
    const std::uint64_t end = ticks_[room] + count;
    while (ticks_[room] < end) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }

  FakeGateway gateway;
  std::unique_ptr<net::Server> server;
  std::unique_ptr<rooms::EncoderThread> encoder;

 private:
  void makeFrames(std::size_t room) {
    std::minstd_rand random(static_cast<unsigned>(room) + 1);
    while (!stopping_) {
      encoder->submit(FakeGateway::kRooms[room], gateway.demands[room], fakeFrame(++ticks_[room], random));
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  std::atomic<bool> stopping_{false};
  std::array<std::atomic<std::uint64_t>, 2> ticks_{};
  std::array<std::thread, 2> makers_;
};

}  // namespace spindrift::test
