// Clients connect, watch, stop reading, leave and come back while frames are made, encoded and sent. In the thread
// sanitizer's build this run covers all threads of the network and the encoder at once.
#include <map>
#include <mutex>

#include <gtest/gtest.h>

#include <spindrift/codec/frame_decoder.h>

#include "fake_water.h"
#include "scripted_client.h"

namespace spindrift::test {
namespace {

constexpr int kFrameCount = 12;
constexpr double kAsManyAsThereAre_hz = 240.0;

/// Reads frames of every layer in one packing, at any level, until each has arrived often enough. Returns what is wrong
/// with the first bad one.
std::string readFrames(ScriptedClient& client, v1::Packing packing, v1::Level level = v1::LEVEL_FULL) {
  const bool packed = packing == v1::PACKING_PACKED;
  for (const v1::Layer layer : {v1::LAYER_SURFACE, v1::LAYER_FOAM, v1::LAYER_PARTICLES}) {
    v1::Subscribe wanted;
    wanted.set_layer(layer);
    wanted.set_max_rate_hz(kAsManyAsThereAre_hz);
    wanted.set_packing(packing);
    wanted.set_level(level);
    wanted.set_adapts(true);
    client.subscribe(wanted);
  }
  codec::PackedSurfaceDecoder packed_surface;
  codec::PackedFoamDecoder packed_foam;
  std::map<v1::Layer, int> counts{{v1::LAYER_SURFACE, 0}, {v1::LAYER_FOAM, 0}, {v1::LAYER_PARTICLES, 0}};
  const auto is_done = [&] {
    for (const auto& [layer, count] : counts) {
      if (count < kFrameCount) return false;
    }
    return true;
  };
  while (!is_done()) {
    const auto message = client.waitFor(v1::ServerMessage::kFrame);
    if (!message) return "no frame came";
    const v1::LayerFrame& frame = message->frame();
    ++counts[frame.layer()];
    if (frame.layer() == v1::LAYER_SURFACE) {
      const auto surface = packed ? packed_surface.decode(frame) : codec::decodeSurface(frame);
      if (!surface) return surface.error().message;
      const float mark_m = static_cast<float>(markOf(frame.tick()) * kFakeQuantum_m);
      if (surface->elevation_m.at(0) != mark_m) return "samples of another tick";
      const bool is_coarse = frame.level() == v1::LEVEL_COARSE;
      if (surface->count.x != (is_coarse ? kFakeCoarseCount : kFakeResolutionCount)) return "another level";
    } else if (frame.layer() == v1::LAYER_FOAM) {
      const auto foam = packed ? packed_foam.decode(frame) : codec::decodeFoam(frame);
      if (!foam) return foam.error().message;
    } else {
      const auto particles = packed ? codec::decodePackedParticles(frame) : codec::decodeParticles(frame);
      if (!particles) return particles.error().message;
    }
  }
  return "";
}

/// A client that subscribes to all layers and reads nothing while the room continues.
std::string holdBack(const FakeWater& water, std::uint16_t port, std::size_t room) {
  ScriptedClient client(port, FakeGateway::kRooms[room]);
  if (!client.isOpen()) return "not let in";
  const v1::Packing packing = room == 0 ? v1::PACKING_PACKED : v1::PACKING_PLAIN;
  client.subscribe(v1::LAYER_SURFACE, kAsManyAsThereAre_hz, packing);
  client.subscribe(v1::LAYER_PARTICLES, kAsManyAsThereAre_hz, packing);
  water.waitFrames(room, 2 * kFrameCount);
  // The frames that waited for it can all be decoded.
  return room == 0 ? readFrames(client, packing) : "";
}

/// Connects and leaves in one of several ways. Returns what went wrong, empty if nothing did.
std::string visit(const FakeWater& water, std::uint16_t port, int person, int turn) {
  const auto room = static_cast<std::size_t>(person % 2);
  if (turn % 3 == 2) return holdBack(water, port, room);
  ScriptedClient client(port, FakeGateway::kRooms[room]);
  if (!client.isOpen()) return "not let in";
  client.hello();
  const v1::Packing first = turn % 2 == 0 ? v1::PACKING_PLAIN : v1::PACKING_PACKED;
  const v1::Level level = person % 3 == 1 ? v1::LEVEL_COARSE : v1::LEVEL_FULL;
  if (auto wrong = readFrames(client, first, level); !wrong.empty()) return wrong;
  if (!client.apply(person % 3 == 0 ? reset() : splash())) return "no answer to a command";
  // Frames of the previous packing may still be in flight; none comes after the pong.
  for (const v1::Layer layer : {v1::LAYER_SURFACE, v1::LAYER_FOAM, v1::LAYER_PARTICLES}) client.unsubscribe(layer);
  if (!client.barrier()) return "no pong";
  if (turn % 2 == 0) return client.ws().close() ? "" : "no goodbye";
  return readFrames(client, v1::PACKING_PLAIN);  // then disconnects without a close frame
}

TEST(JoinLeave, EveryFrameDecodesWhileClientsJoinAndLeave) {
  constexpr int kPersonCount = 6;
  constexpr int kTurnCount = 6;
  FakeWater water({.thread_count = 3, .messages_per_s = 1e6, .message_burst_count = 1e6});
  std::mutex mutex;
  std::vector<std::string> wrongs;
  std::vector<std::thread> people;
  for (int person = 0; person < kPersonCount; ++person) {
    people.emplace_back([&, person] {
      for (int turn = 0; turn < kTurnCount; ++turn) {
        const std::string wrong = visit(water, water.server->port(), person, turn);
        if (wrong.empty()) continue;
        const std::lock_guard lock(mutex);
        wrongs.push_back("person " + std::to_string(person) + ", turn " + std::to_string(turn) + ": " + wrong);
      }
    });
  }
  // Reads the counters all the time, as the log does.
  std::uint64_t frame_count = 0;
  for (int look = 0; look < 20; ++look) {
    water.waitFrames(0, 2);
    frame_count =
        water.server->stats().sent_frame_count + water.encoder->frameCounts(FakeGateway::kRooms[0]).replaced_count +
        water.encoder->costs()[codec::indexOf({v1::LAYER_SURFACE})][core::indexOf(core::Level::kFull)].frame_count;
  }
  for (std::thread& one : people) one.join();
  EXPECT_TRUE(wrongs.empty()) << wrongs.front() << " and " << wrongs.size() - 1 << " more";
  EXPECT_GT(frame_count, 0U);
  EXPECT_EQ(water.gateway.opened_count, kPersonCount * kTurnCount);
  water.server->stop();
  EXPECT_EQ(water.gateway.closed_count, kPersonCount * kTurnCount) << "every session that opened was closed";
  EXPECT_EQ(water.server->stats().open_session_count, 0U);
}

TEST(JoinLeave, StopsInTheMiddleOfEverything) {
  for (int round = 0; round < 5; ++round) {
    FakeWater water({.thread_count = 2, .close_timeout = std::chrono::milliseconds(200)});
    std::vector<ScriptedClient> clients;
    for (int k = 0; k < 4; ++k) {
      clients.emplace_back(water.server->port(), FakeGateway::kRooms[static_cast<std::size_t>(k % 2)]);
      ASSERT_TRUE(clients.back().isOpen());
      clients.back().subscribe(v1::LAYER_SURFACE, kAsManyAsThereAre_hz, k < 2 ? v1::PACKING_PLAIN : v1::PACKING_PACKED);
    }
    water.waitFrames(0, 3);
  }
}

}  // namespace
}  // namespace spindrift::test
