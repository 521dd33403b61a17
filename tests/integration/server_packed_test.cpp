// Packed streams over a real connection: every frame can be decoded, whenever clients join.
#include <cmath>
#include <map>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

class PackedFrames : public WaveServerTest {
 protected:
  static void watch(ScriptedClient& one, double max_rate_hz = 60.0) {
    one.subscribe(v1::LAYER_SURFACE, max_rate_hz, v1::PACKING_PACKED);
  }
};

TEST_F(PackedFrames, CanAllBeReadAndMostAreDeltas) {
  ScriptedClient one = client();
  watch(one);
  one.send([] {
    v1::ClientMessage message;
    *message.mutable_command() = splash();
    message.mutable_command()->set_command_id(77);
    return message;
  }());
  codec::PackedSurfaceDecoder decoder;
  int continuing_count = 0;
  double highest_m = 0.0;
  for (int i = 0; i < 40; ++i) {
    const auto frame = one.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    if (i == 0) {
      EXPECT_TRUE(frame->keyframe()) << "a newcomer has nothing to build on";
    }
    continuing_count += frame->keyframe() ? 0 : 1;
    const auto surface = decoder.decode(*frame);
    ASSERT_TRUE(surface) << surface.error().message;
    for (const float eta_m : surface->elevation_m) highest_m = std::max<double>(highest_m, eta_m);
  }
  EXPECT_GT(continuing_count, 0);
  EXPECT_GT(highest_m, 0.01) << "the splash is to be seen";
}

TEST_F(PackedFrames, HaveTheSamplesOfPlainOnes) {
  ScriptedClient packed = client();
  ScriptedClient plain = client();
  ASSERT_TRUE(packed.apply(splash()));
  watch(packed);
  plain.subscribe(v1::LAYER_SURFACE);
  codec::PackedSurfaceDecoder decoder;
  std::map<std::uint64_t, std::vector<float>> by_tick;
  for (int i = 0; i < 20; ++i) {
    const auto frame = packed.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    auto surface = decoder.decode(*frame);
    ASSERT_TRUE(surface) << surface.error().message;
    by_tick[frame->tick()] = std::move(surface->elevation_m);
  }
  int compared_count = 0;
  for (int i = 0; i < 20; ++i) {
    const auto frame = plain.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    const auto surface = codec::decodeSurface(*frame);
    ASSERT_TRUE(surface) << "a client that subscribed to plain frames gets no packed ones";
    const auto same = by_tick.find(frame->tick());
    if (same == by_tick.end()) continue;
    EXPECT_EQ(same->second, surface->elevation_m) << "tick " << frame->tick();
    ++compared_count;
  }
  EXPECT_GT(compared_count, 0);
}

TEST_F(PackedFrames, LateClientStartsWithAKeyframe) {
  ScriptedClient early = client();
  watch(early);
  codec::PackedSurfaceDecoder early_decoder, late_decoder;
  const auto readOne = [](ScriptedClient& one, codec::PackedSurfaceDecoder& decoder) {
    auto frame = one.nextFrame(v1::LAYER_SURFACE);
    EXPECT_TRUE(frame);
    if (frame) {
      const auto surface = decoder.decode(*frame);
      EXPECT_TRUE(surface) << surface.error().message;
    }
    return frame;
  };
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(readOne(early, early_decoder));
  ScriptedClient late = client();
  watch(late);
  const auto first = readOne(late, late_decoder);
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->keyframe());
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(readOne(late, late_decoder));
    ASSERT_TRUE(readOne(early, early_decoder));
  }
}

TEST_F(PackedFrames, LowerRateGetsKeyframesOnly) {
  ScriptedClient slow = client();
  watch(slow, 5.0);
  ScriptedClient fast = client();
  watch(fast);
  codec::PackedSurfaceDecoder decoder;
  std::uint64_t last_tick = 0;
  for (int i = 0; i < 5; ++i) {
    const auto frame = slow.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    EXPECT_TRUE(frame->keyframe());
    const auto surface = decoder.decode(*frame);
    ASSERT_TRUE(surface) << surface.error().message;
    EXPECT_GT(frame->tick(), last_tick + (last_tick > 0 ? 2 : 0));
    last_tick = frame->tick();
  }
}

TEST_F(PackedFrames, SubscribingToTheOtherPackingStopsTheFirst) {
  ScriptedClient one = client();
  watch(one);
  ASSERT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  one.subscribe(v1::LAYER_SURFACE);
  ASSERT_TRUE(one.barrier());
  for (int i = 0; i < 5; ++i) {
    const auto frame = one.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(frame);
    EXPECT_TRUE(frame->has_surface_fixed16());
  }
}

TEST_F(PackedFrames, WatchedStreamIsEncodedOnce) {
  const codec::Stream packed{v1::LAYER_SURFACE, v1::PACKING_PACKED};
  std::vector<ScriptedClient> clients;
  for (int i = 0; i < 6; ++i) clients.push_back(client());
  for (ScriptedClient& one : clients) {
    watch(one);
    ASSERT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  }
  const std::uint64_t encoded_before = encodedFrameCount(packed);
  const auto read = [&] {
    for (ScriptedClient& one : clients) ASSERT_TRUE(one.nextFrame(v1::LAYER_SURFACE));
  };
  EXPECT_TRUE(areEncodedOnce(
      6, kWaitingFrames, [&] { return encodedFrameCount(packed); }, read, 15));
  const std::uint64_t encoded_count = encodedFrameCount(packed) - encoded_before;
  EXPECT_GE(2 * encoded_count, 15u) << "frames encoded before the measurement may be read in it";
  EXPECT_EQ(encodedFrameCount({v1::LAYER_SURFACE}), 0u) << "plain frames were not subscribed to";
}

class PackedParticles : public ServerTest {};

TEST_F(PackedParticles, CountEqualsThatOfThePlainPacking) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_PARTICLES, 60.0, v1::PACKING_PACKED);
  for (int i = 0; i < 10; ++i) {
    const auto frame = one.nextFrame(v1::LAYER_PARTICLES);
    ASSERT_TRUE(frame);
    ASSERT_TRUE(frame->has_particles_by_cell());
    EXPECT_LT(frame->payload().size(), 512u * 12 / 3) << "less than a third of the plain bytes";
    const auto particles = codec::decodePackedParticles(*frame);
    ASSERT_TRUE(particles) << particles.error().message;
    EXPECT_EQ(particles->count, 512u);
    for (const float x_m : particles->position_m) ASSERT_LE(std::abs(x_m), 8.0f);
    for (const float v_mps : particles->velocity_mps) ASSERT_TRUE(std::isfinite(v_mps));
  }
}

class PackedFloaters : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", R"(
      wave { resolution_count: 32 side_m: 16 depth_m: 2 }
      floaters {
        capacity_count: 4
        floaters { x_m: -4 kind: FLOATER_KIND_BALL }
        floaters { x_m: 3 y_m: 1 kind: FLOATER_KIND_CRATE }
      }
      stream { frame_rate_hz: 60 }
    )"}};
  }
};

TEST_F(PackedFloaters, HaveThePositionsOfPlainOnesWhileObjectsComeAndGo) {
  ScriptedClient packed = person({.minor = 7});
  ScriptedClient plain = client();
  packed.subscribe(v1::LAYER_FLOATERS, 60.0, v1::PACKING_PACKED);
  plain.subscribe(v1::LAYER_FLOATERS);
  codec::PackedFloaterDecoder decoder;
  std::map<std::uint64_t, std::vector<codec::FloaterSample>> by_state;
  int delta_count = 0;
  std::uint32_t dropped = 0;
  for (int i = 0; i < 40; ++i) {
    if (i == 10) dropped = plain.ask(spawnFloater(0, 4)).ack().floater_id();
    if (i == 25) {
      ASSERT_TRUE(plain.apply(removeFloater(dropped)));
    }
    const auto frame = packed.nextFrame(v1::LAYER_FLOATERS);
    ASSERT_TRUE(frame);
    ASSERT_TRUE(frame->has_floaters_predicted());
    if (i == 0) {
      EXPECT_TRUE(frame->keyframe()) << "a newcomer has nothing to build on";
    }
    delta_count += frame->keyframe() ? 0 : 1;
    auto floaters = decoder.decode(*frame);
    ASSERT_TRUE(floaters) << floaters.error().message;
    by_state[frame->state_id()] = *std::move(floaters);
  }
  EXPECT_GT(delta_count, 20);
  ASSERT_NE(dropped, 0u);
  int compared_count = 0;
  std::size_t most_count = 0;
  for (int i = 0; i < 30; ++i) {
    const auto frame = plain.nextFrame(v1::LAYER_FLOATERS);
    ASSERT_TRUE(frame);
    const auto floaters = codec::decodeFloaters(*frame);
    ASSERT_TRUE(floaters) << "a client that subscribed to plain frames gets no packed ones";
    const auto same = by_state.find(frame->state_id());
    if (same == by_state.end()) continue;
    ++compared_count;
    most_count = std::max(most_count, floaters->size());
    ASSERT_EQ(same->second.size(), floaters->size());
    for (std::size_t k = 0; k < floaters->size(); ++k) {
      EXPECT_EQ(same->second[k].floater_id, floaters->at(k).floater_id);
      EXPECT_EQ(same->second[k].kind, floaters->at(k).kind);
      EXPECT_DOUBLE_EQ(same->second[k].size_m, floaters->at(k).size_m);
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(same->second[k].position_m[axis], floaters->at(k).position_m[axis], 1e-9);
    }
  }
  EXPECT_GT(compared_count, 0);
  EXPECT_GE(most_count, 2u);
}

TEST_F(PackedFloaters, EveryLevelHasDeltasOfItsOwn) {
  ScriptedClient full = person({.minor = 7});
  full.subscribe(v1::LAYER_FLOATERS, 60.0, v1::PACKING_PACKED);
  for (const v1::Level level : {v1::LEVEL_COARSE, v1::LEVEL_MEDIUM, v1::LEVEL_FINE}) {
    ScriptedClient one = person({.minor = 7});
    v1::Subscribe wanted;
    wanted.set_layer(v1::LAYER_FLOATERS);
    wanted.set_max_rate_hz(60.0);
    wanted.set_packing(v1::PACKING_PACKED);
    wanted.set_level(level);
    one.subscribe(wanted);
    codec::PackedFloaterDecoder decoder;
    int delta_count = 0;
    for (int i = 0; i < 10; ++i) {
      const auto frame = one.nextFrame(v1::LAYER_FLOATERS);
      ASSERT_TRUE(frame);
      EXPECT_EQ(frame->level(), level);
      const auto floaters = decoder.decode(*frame);
      ASSERT_TRUE(floaters) << floaters.error().message;
      EXPECT_EQ(floaters->size(), 2u);
      delta_count += frame->keyframe() ? 0 : 1;
    }
    EXPECT_GT(delta_count, 0) << v1::Level_Name(level);
  }
}

TEST_F(PackedFloaters, AreSentPlainToClientsOfOlderVersions) {
  ScriptedClient old = person({.minor = 6});
  old.subscribe(v1::LAYER_FLOATERS, 60.0, v1::PACKING_PACKED);
  const auto frame = old.nextFrame(v1::LAYER_FLOATERS);
  ASSERT_TRUE(frame);
  EXPECT_TRUE(codec::decodeFloaters(*frame));
}

TEST_F(PackedFrames, ArePlainForALayerWithoutAPackedForm) {
  ScriptedClient one = client();
  one.subscribe(v1::LAYER_DIAGNOSTICS, 60.0, v1::PACKING_PACKED);
  EXPECT_TRUE(one.waitFor(v1::ServerMessage::kDiagnostics));
}

}  // namespace
}  // namespace spindrift::test
