// Levels of detail over a real connection: chosen by the client, and by the server for one that cannot keep up.
#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <set>
#include <thread>

#include <spindrift/bench/levels.h>
#include <spindrift/gpu/context.h>
#include <spindrift/sim/water_sim.h>

#include "server_fixture.h"

namespace spindrift::test {
namespace {

/// A surface of 256 x 256 samples has one level below full; so do 9,000 particles.
constexpr const char* kWidePool = R"(
  wave { resolution_count: 256 side_m: 24 depth_m: 1 }
  particles { count: 10000 layers_count: 2 headroom_m: 2 }
  coupling {}
  foam {}
)";
constexpr const char* kWideWave = R"(
  wave { resolution_count: 256 side_m: 24 depth_m: 1 }
  stream { frame_rate_hz: 60 }
)";

v1::Subscribe subscription(v1::Layer layer, v1::Level level, v1::Packing packing = v1::PACKING_PLAIN) {
  v1::Subscribe out;
  out.set_layer(layer);
  out.set_max_rate_hz(60.0);
  out.set_level(level);
  out.set_packing(packing);
  return out;
}

class LevelsOfAPool : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kWidePool}}; }
};

TEST_F(LevelsOfAPool, ClientGetsTheRequestedLevel) {
  std::map<v1::Level, std::uint32_t> resolution_count, particle_count;
  for (const v1::Level level : {v1::LEVEL_COARSE, v1::LEVEL_MEDIUM, v1::LEVEL_FULL}) {
    ScriptedClient one = client();
    one.subscribe(subscription(v1::LAYER_SURFACE, level));
    one.subscribe(subscription(v1::LAYER_PARTICLES, level));
    // A level that leaves nothing out is sent as FULL.
    const v1::Level expected = level == v1::LEVEL_COARSE ? v1::LEVEL_COARSE : v1::LEVEL_FULL;
    const auto surface = one.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(surface);
    EXPECT_EQ(surface->level(), expected);
    const auto samples = codec::decodeSurface(*surface);
    ASSERT_TRUE(samples) << samples.error().message;
    resolution_count[level] = samples->count.x;
    const auto particles = one.nextFrame(v1::LAYER_PARTICLES);
    ASSERT_TRUE(particles);
    EXPECT_EQ(particles->level(), expected);
    const auto places = codec::decodeParticles(*particles);
    ASSERT_TRUE(places) << places.error().message;
    particle_count[level] = places->count;
  }
  EXPECT_EQ(resolution_count[v1::LEVEL_COARSE], 128u);
  EXPECT_EQ(resolution_count[v1::LEVEL_MEDIUM], 256u);
  EXPECT_EQ(resolution_count[v1::LEVEL_FULL], 256u);
  EXPECT_LE(particle_count[v1::LEVEL_COARSE], 8192u);
  EXPECT_GT(particle_count[v1::LEVEL_COARSE], 7000u);
  EXPECT_GT(particle_count[v1::LEVEL_FULL], 8192u);
  EXPECT_EQ(particle_count[v1::LEVEL_MEDIUM], particle_count[v1::LEVEL_FULL]);
}

TEST_F(LevelsOfAPool, PackedLevelsDecodeWhileAClientChangesLevel) {
  ScriptedClient one = client();
  codec::PackedSurfaceDecoder decoder;
  for (const v1::Level level : {v1::LEVEL_FULL, v1::LEVEL_COARSE, v1::LEVEL_FULL, v1::LEVEL_COARSE}) {
    one.subscribe(subscription(v1::LAYER_SURFACE, level, v1::PACKING_PACKED));
    one.subscribe(subscription(v1::LAYER_PARTICLES, level, v1::PACKING_PACKED));
    bool is_first = true;
    for (int frames_of_level = 0; frames_of_level < 5;) {
      const auto frame = one.nextFrame(v1::LAYER_SURFACE);
      ASSERT_TRUE(frame);
      const auto samples = decoder.decode(*frame);
      ASSERT_TRUE(samples) << samples.error().message;
      if (frame->level() != level) continue;  // was in flight
      if (is_first) {
        EXPECT_TRUE(frame->keyframe()) << "nothing to build on at another level";
      }
      is_first = false;
      EXPECT_EQ(samples->count.x, level == v1::LEVEL_COARSE ? 128u : 256u);
      ++frames_of_level;
    }
    const auto particles = one.nextFrame(v1::LAYER_PARTICLES);
    ASSERT_TRUE(particles);
    EXPECT_TRUE(codec::decodePackedParticles(*particles));
  }
}

TEST_F(LevelsOfAPool, WatchedLevelIsEncodedOnce) {
  const auto frames = [this](core::Level level) {
    const codec::Stream packed{v1::LAYER_SURFACE, v1::PACKING_PACKED};
    return encoder().costs()[codec::indexOf(packed)][core::indexOf(level)].frame_count;
  };
  std::vector<ScriptedClient> full, coarse;
  for (int k = 0; k < 3; ++k) {
    full.push_back(client());
    full.back().subscribe(subscription(v1::LAYER_SURFACE, v1::LEVEL_FULL, v1::PACKING_PACKED));
    ASSERT_TRUE(full.back().nextFrame(v1::LAYER_SURFACE));
  }
  // Each encoded frame goes to the three clients of its level.
  const std::uint64_t full_before = frames(core::Level::kFull);
  const auto read_full = [&] { ASSERT_TRUE(full[0].nextFrame(v1::LAYER_SURFACE)); };
  EXPECT_TRUE(areEncodedOnce(
      3, kWaitingFrames, [&] { return frames(core::Level::kFull); }, read_full, 20));
  const std::uint64_t full_count = frames(core::Level::kFull) - full_before;
  EXPECT_EQ(frames(core::Level::kCoarse), 0u) << "the level is not watched";
  // Frames encoded before the measurement are read in it.
  EXPECT_GE(2 * full_count, 20u);

  for (int k = 0; k < 3; ++k) {
    coarse.push_back(client());
    coarse.back().subscribe(subscription(v1::LAYER_SURFACE, v1::LEVEL_COARSE, v1::PACKING_PACKED));
    ASSERT_TRUE(coarse.back().nextFrame(v1::LAYER_SURFACE));
  }
  const auto begin = std::chrono::steady_clock::now();
  const std::uint64_t full_later = frames(core::Level::kFull);
  const std::uint64_t coarse_before = frames(core::Level::kCoarse);
  const auto both = [&] { return frames(core::Level::kFull) + frames(core::Level::kCoarse); };
  const auto read_coarse = [&] { ASSERT_TRUE(coarse[0].nextFrame(v1::LAYER_SURFACE)); };
  EXPECT_TRUE(areEncodedOnce(3, 2 * kWaitingFrames, both, read_coarse, 10));
  const std::uint64_t coarse_count = frames(core::Level::kCoarse) - coarse_before;
  const double duration_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_GE(2 * coarse_count, 10u);
  EXPECT_LE(coarse_count, frames(core::Level::kFull) - full_later + 1) << "frames of the level are frames of the room";
  EXPECT_LE(coarse_count, 20.0 * duration_s + 3.0) << "at most 20 per second, independent of other watchers";
}

/// A scene in which the level coarse leaves nothing out.
class LevelsOfAPond : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override {
    return {{"main", R"(
      wave { resolution_count: 64 side_m: 8 depth_m: 1 }
      particles { count: 1000 layers_count: 1 headroom_m: 2 }
      coupling {}
      foam { surface: true }
      boats { capacity_count: 2 }
    )"}};
  }
};

TEST_F(LevelsOfAPond, LayersOfALevelShowTheSameTicks) {
  constexpr std::array kLayers{v1::LAYER_SURFACE, v1::LAYER_PARTICLES, v1::LAYER_FOAM, v1::LAYER_BODIES};
  const auto watch = [&](ScriptedClient& one, v1::Level level) {
    for (const v1::Layer layer : kLayers) one.subscribe(subscription(layer, level));
  };
  // Each tick of which a client has a frame, with its layers.
  const auto moments = [](ScriptedClient& one) {
    std::map<std::uint64_t, std::set<v1::Layer>> out;
    while (out.size() < 14) {
      const auto message = one.waitFor(v1::ServerMessage::kFrame);
      if (!message) break;
      out[message->frame().tick()].insert(message->frame().layer());
    }
    out.erase(out.begin());  // the subscriptions came one after the other
    if (!out.empty()) out.erase(std::prev(out.end()));
    return out;
  };
  const auto whole = [&](const auto& of_ticks) {
    return std::ranges::count_if(of_ticks, [&](const auto& one) { return one.second.size() == kLayers.size(); });
  };
  const auto particle_frames = [&] {
    return encoder().costs()[codec::indexOf({v1::LAYER_PARTICLES})][core::indexOf(core::Level::kFull)].frame_count;
  };

  ScriptedClient coarse = client();
  watch(coarse, v1::LEVEL_COARSE);
  ASSERT_TRUE(coarse.nextFrame(v1::LAYER_BODIES));
  const std::uint64_t first_count = particle_frames();
  const auto first_tick = coarse.apply(splash());
  const auto of_coarse = moments(coarse);
  const auto last_tick = coarse.apply(splash());
  const std::uint64_t last_count = particle_frames();
  ASSERT_EQ(of_coarse.size(), 12U);
  EXPECT_GE(whole(of_coarse), 9) << "a busy machine may lose some frames";
  // A frame is made every second tick, and nobody takes every second frame.
  ASSERT_TRUE(first_tick && last_tick);
  EXPECT_LT(static_cast<double>(last_count - first_count), 0.4 * static_cast<double>(*last_tick - *first_tick));

  ScriptedClient full = client();
  watch(full, v1::LEVEL_FULL);
  ASSERT_TRUE(full.nextFrame(v1::LAYER_BODIES));
  EXPECT_GE(whole(moments(coarse)), 9);
}

TEST(LevelBudgets, HoldForTheLargestPool) {
  // Half a second after a splash, when the surface moves most.
  const auto parsed = scene::parseSceneText(R"(
    tick_rate_hz: 60
    wave { resolution_count: 512 side_m: 24 depth_m: 1.5 damping_per_s: 0.15 }
    particles { count: 131072 layers_count: 3 headroom_m: 5 sound_speed_mps: 14 max_speed_mps: 8 viscosity_pas: 60 }
    coupling {}
    foam { surface: true }
    events { at_s: 0.05 effect { splash { x_m: -2 z_m: 1.5 radius_m: 2.2 depth_m: 1.3 duration_s: 0.25 } } }
  )",
                                            "budget.textproto");
  ASSERT_TRUE(parsed) << parsed.error().message;
  auto context = gpu::Context::create({gpu::DeviceChoice::Kind::kSoftware, 0});
  if (!context) GTEST_SKIP() << "no software EGL device here: " << context.error().message;
  const core::Scene scene = scene::toCore(*parsed);
  auto sim = sim::WaterSim::create(**context, scene);
  ASSERT_TRUE(sim) << sim.error().message;
  bench::LevelMeter meter(scene.stream.frame_rate_hz);
  for (int tick = 0; tick < 20; ++tick) {
    (*sim)->step();
    if (tick % 2 != 0) continue;
    ASSERT_TRUE((*sim)->requestFrame(bench::LevelMeter::request(scene)));
    (*context)->finish();
    for (const core::FrameView& frame : (*sim)->takeFrames()) meter.add(frame);
  }
  const boost::json::array rows = meter.print(stderr);
  ASSERT_EQ(rows.size(), 3u) << "the finest reduced level leaves nothing out";
  double below = 0.0;
  for (const auto& row : rows) {
    const double mbitps = row.at("mbit_per_s").as_double();
    EXPECT_GT(mbitps, below) << row.at("level");
    EXPECT_LE(mbitps, row.at("budget_mbit_per_s").as_double()) << row.at("level");
    EXPECT_LT(row.at("particle_bits").as_double(), row.at("particle_bits_if_added").as_double()) << row.at("level");
    below = mbitps;
  }
}

class LevelsOfAWave : public ServerTest {
 protected:
  std::vector<RoomText> rooms() const override { return {{"main", kWideWave}}; }
};

TEST_F(LevelsOfAWave, SlowClientIsLoweredAndRaisedAgain) {
  constexpr int kReceiveBufferBytes = 32 * 1024;
  ScriptedClient slow(server().port(), "", kReceiveBufferBytes);
  ASSERT_TRUE(slow.isOpen());
  slow.hello();
  v1::Subscribe wanted = subscription(v1::LAYER_SURFACE, v1::LEVEL_FULL);
  wanted.set_adapts(true);
  slow.subscribe(wanted);
  ScriptedClient steady = client();
  steady.subscribe(subscription(v1::LAYER_SURFACE, v1::LEVEL_FULL));
  ASSERT_TRUE(slow.nextFrame(v1::LAYER_SURFACE));

  const auto levelTold = [&](std::chrono::milliseconds between) -> std::optional<v1::Level> {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (std::chrono::steady_clock::now() < end) {
      const auto bytes = slow.ws().receive();
      if (!bytes) return std::nullopt;
      const auto message = codec::parseServerMessage(*bytes);
      if (message && message->has_level_changed()) return message->level_changed().level();
      std::this_thread::sleep_for(between);
    }
    return std::nullopt;
  };
  using namespace std::chrono_literals;
  // Reads three of sixty frames per second.
  EXPECT_EQ(levelTold(300ms), v1::LEVEL_COARSE);
  EXPECT_EQ(server().networkStats().lowered_level_count, 1u);
  // Reads all frames.
  EXPECT_EQ(levelTold(0ms), v1::LEVEL_FULL);
  EXPECT_EQ(server().networkStats().raised_level_count, 1u);
  const auto frame = slow.waitFor([](const v1::ServerMessage& message) {
    return message.has_frame() && message.frame().level() == v1::LEVEL_FULL;
  });
  EXPECT_TRUE(frame) << "the frames follow";
  for (int k = 0; k < 10; ++k) {
    const auto of_other = steady.nextFrame(v1::LAYER_SURFACE);
    ASSERT_TRUE(of_other);
    EXPECT_EQ(of_other->level(), v1::LEVEL_FULL) << "it did not ask for less";
  }
}

TEST_F(LevelsOfAWave, AnUnknownLevelIsRefused) {
  ScriptedClient one = client();
  one.subscribe(subscription(v1::LAYER_SURFACE, static_cast<v1::Level>(9)));
  const auto refusal = one.waitFor(v1::ServerMessage::kRefusal);
  ASSERT_TRUE(refusal);
  EXPECT_THAT(refusal->refusal().message(), testing::HasSubstr("subscribe.level: 9"));
}

}  // namespace
}  // namespace spindrift::test
