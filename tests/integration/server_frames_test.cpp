// The data plane over a real connection: frames of subscribed layers, and no encoding without subscriptions.
#include <cmath>
#include <set>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

using testing::ElementsAre;

class Frames : public ServerTest {};
class WaveFrames : public WaveServerTest {};

TEST_F(Frames, GreetingHasSceneLayersAndParameters) {
  ScriptedClient one(server().port());
  ASSERT_TRUE(one.isOpen());
  const v1::Greeting& greeting = one.greeting();
  EXPECT_EQ(greeting.version().major(), 1u);
  EXPECT_EQ(greeting.room(), "main");
  EXPECT_EQ(greeting.device(), server().simulation().deviceLine());
  EXPECT_THAT(greeting.layers(), ElementsAre(v1::LAYER_SURFACE, v1::LAYER_PARTICLES, v1::LAYER_DIAGNOSTICS));
  EXPECT_EQ(greeting.scene().wave().resolution_count(), 32u);
  EXPECT_EQ(greeting.scene().gravity_mps2(), core::Scene{}.gravity_mps2) << "a default that the scene leaves out";
  EXPECT_GT(greeting.limits().message_max_bytes(), 0u);
  EXPECT_EQ(greeting.room_state().speed(), 1.0);
  EXPECT_FALSE(greeting.room_state().paused());
  std::set<std::string> paths;
  for (const v1::ParameterDescription& parameter : greeting.parameters()) paths.insert(parameter.path());
  EXPECT_TRUE(paths.contains("particles.viscosity_pas"));
  EXPECT_TRUE(paths.contains("wave.damping_per_s"));
  EXPECT_FALSE(paths.contains("wave.resolution_count")) << "needs a restart";
}

TEST_F(Frames, SurfaceAndParticlesDecodeToFiniteValues) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  one.subscribe(v1::LAYER_PARTICLES);
  std::uint64_t surface_tick = 0;
  std::uint64_t particle_tick = 0;
  for (int i = 0; i < 10; ++i) {
    const auto message = one.waitFor(v1::ServerMessage::kFrame);
    ASSERT_TRUE(message);
    const v1::LayerFrame& frame = message->frame();
    EXPECT_NEAR(frame.time_s(), static_cast<double>(frame.tick()) / 60.0, 1e-9);
    if (frame.layer() == v1::LAYER_SURFACE) {
      EXPECT_GT(frame.tick(), surface_tick);
      surface_tick = frame.tick();
      const auto surface = codec::decodeSurface(frame);
      ASSERT_TRUE(surface) << surface.error().message;
      EXPECT_EQ(surface->count.x, 32u);
      EXPECT_EQ(surface->length_m, 8.0);
      for (const float eta_m : surface->elevation_m) ASSERT_TRUE(std::isfinite(eta_m));
    } else {
      EXPECT_GT(frame.tick(), particle_tick);
      particle_tick = frame.tick();
      const auto particles = codec::decodeParticles(frame);
      ASSERT_TRUE(particles) << particles.error().message;
      EXPECT_EQ(particles->count, 512u);
      for (const float x_m : particles->position_m) ASSERT_TRUE(std::isfinite(x_m));
      for (const float v_mps : particles->velocity_mps) ASSERT_TRUE(std::isfinite(v_mps));
    }
  }
  EXPECT_GT(surface_tick, 0u);
  EXPECT_GT(particle_tick, 0u);
}

TEST_F(Frames, DiagnosticsReportAHealthyRoom) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_DIAGNOSTICS);
  std::uint64_t tick = 0;
  for (int i = 0; i < 5; ++i) {
    const auto message = one.waitFor(v1::ServerMessage::kDiagnostics);
    ASSERT_TRUE(message);
    const v1::Diagnostics& health = message->diagnostics();
    EXPECT_GT(health.tick(), tick);
    tick = health.tick();
    EXPECT_EQ(health.particle_count(), 512u);
    EXPECT_GE(health.substeps_count(), 1u);
    EXPECT_GT(health.step_ms(), 0.0);
    EXPECT_TRUE(std::isfinite(health.kinetic_energy_j()));
    EXPECT_EQ(health.nonfinite_count(), 0u);
    EXPECT_EQ(health.escaped_count(), 0u);
    EXPECT_EQ(health.recovered_count(), 0u);
  }
}

TEST_F(WaveFrames, AreEncodedOnceForThreeClients) {
  std::vector<ScriptedClient> clients;
  for (int i = 0; i < 3; ++i) clients.push_back(client());
  for (ScriptedClient& one : clients) {
    one.subscribe(v1::LAYER_SURFACE);
    ASSERT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  }
  const auto begin = clients[0].apply(setSpeed(1.0));
  ASSERT_TRUE(begin);
  const std::uint64_t encoded_before = encodedFrameCount({v1::LAYER_SURFACE});
  std::set<std::uint64_t> ticks;
  const auto read = [&] {
    for (ScriptedClient& one : clients) {
      const auto frame = one.nextFrame(v1::LAYER_SURFACE);
      ASSERT_TRUE(frame);
      ticks.insert(frame->tick());
    }
  };
  const auto encoded = [this] { return encodedFrameCount({v1::LAYER_SURFACE}); };
  EXPECT_TRUE(areEncodedOnce(3, kWaitingFrames, encoded, read, 20));
  const std::uint64_t encoded_count = encoded() - encoded_before;
  const auto end = clients[0].apply(setSpeed(1.0));
  ASSERT_TRUE(end);
  EXPECT_GE(2 * encoded_count, ticks.size()) << "frames encoded before the measurement may be read in it";
  // Frames encoded per client would be three per tick.
  EXPECT_LE(encoded_count, *end - *begin + 2);
}

TEST_F(WaveFrames, BytesOfATickAreEqualForEveryClient) {
  ScriptedClient one = client();
  ScriptedClient two = client();
  ASSERT_TRUE(one.apply(splash()));
  one.subscribe(v1::LAYER_SURFACE);
  two.subscribe(v1::LAYER_SURFACE);
  auto left = one.nextFrame(v1::LAYER_SURFACE);
  auto right = two.nextFrame(v1::LAYER_SURFACE);
  int compared_count = 0;
  while (left && right && compared_count < 5) {
    if (left->tick() == right->tick()) {
      EXPECT_EQ(left->SerializeAsString(), right->SerializeAsString());
      ++compared_count;
    }
    if (left->tick() <= right->tick()) {
      left = one.nextFrame(v1::LAYER_SURFACE);
    } else {
      right = two.nextFrame(v1::LAYER_SURFACE);
    }
  }
  EXPECT_EQ(compared_count, 5);
}

TEST_F(Frames, AreNotEncodedWithoutSubscriptions) {
  ScriptedClient one = client();
  ASSERT_TRUE(one.runFor(30));
  for (const v1::Layer layer : {v1::LAYER_SURFACE, v1::LAYER_PARTICLES, v1::LAYER_DIAGNOSTICS}) {
    EXPECT_EQ(encodedFrameCount({layer}), 0u) << v1::Layer_Name(layer);
  }
  EXPECT_EQ(server().networkStats().sent_frame_count, 0u);
}

TEST_F(Frames, UnsubscribedLayerIsNotSent) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  for (int i = 0; i < 10; ++i) {
    const auto message = one.waitFor([](const v1::ServerMessage& m) { return m.has_frame() || m.has_diagnostics(); });
    ASSERT_TRUE(message);
    ASSERT_TRUE(message->has_frame());
    EXPECT_EQ(message->frame().layer(), v1::LAYER_SURFACE);
  }
  EXPECT_EQ(encodedFrameCount({v1::LAYER_PARTICLES}), 0u);
  EXPECT_EQ(encodedFrameCount({v1::LAYER_DIAGNOSTICS}), 0u);
}

TEST_F(WaveFrames, StopWhenUnsubscribed) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  one.unsubscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(one.barrier());
  const std::uint64_t sent_count = server().networkStats().sent_frame_count;
  const std::uint64_t encoded_count = encodedFrameCount({v1::LAYER_SURFACE});
  ASSERT_TRUE(one.runFor(30));
  // One frame may have been in flight; a room that continued would have sent thirty.
  EXPECT_LE(server().networkStats().sent_frame_count, sent_count + 1);
  EXPECT_LE(encodedFrameCount({v1::LAYER_SURFACE}), encoded_count + 1);
}

TEST_F(WaveFrames, ContinueForOthersWhenAClientVanishes) {
  ScriptedClient stays = client();
  stays.subscribe(v1::LAYER_SURFACE);
  {
    ScriptedClient vanishes = client();
    vanishes.subscribe(v1::LAYER_SURFACE);
    ASSERT_TRUE(vanishes.nextFrame(v1::LAYER_SURFACE));
    vanishes.ws().vanish();
  }
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(stays.nextFrame(v1::LAYER_SURFACE));
}

TEST_F(WaveFrames, LayerThatTheRoomLacksIsNeverSent) {
  ScriptedClient one = client();
  EXPECT_THAT(one.greeting().layers(), ElementsAre(v1::LAYER_SURFACE, v1::LAYER_DIAGNOSTICS));
  one.subscribe(v1::LAYER_PARTICLES);
  ASSERT_TRUE(one.runFor(30));
  EXPECT_EQ(server().networkStats().sent_frame_count, 0u);
}

}  // namespace
}  // namespace spindrift::test
