// What lasts from one tick to the next is declared by the parts: in every shipped scene no buffer is forgotten, and the
// hash covers all of it.
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <shared/pool.h>

#include <spindrift/scene/scene_loader.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

std::vector<std::string> shippedScenes() {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(SPINDRIFT_SOURCE_DIR "/server/scenes"))
    if (entry.path().extension() == ".textproto") out.push_back(entry.path().stem());
  std::ranges::sort(out);
  return out;
}

std::vector<std::uint32_t> wordsOf(const gpu::Buffer& buffer) {
  return buffer.downloadVector<std::uint32_t>(buffer.sizeBytes() / sizeof(std::uint32_t));
}

/// Effects, a frame of all layers, a driven boat and a floater: every pass of the scene runs.
void runEveryPass(WaterSim& water) {
  (void)water.start(core::Splash{0.3, -0.2, 1.2, 0.5, 0.1});
  (void)water.start(core::BreakingWave{core::Side::kMinusX, 0.3, 2.0, 0.3});
  (void)water.controlBoat(1, 1.0, -0.5);
  (void)water.spawnFloater(core::Floater{});
  for (int tick = 0; tick < 3; ++tick) {
    water.step();
    (void)water.requestFrame(FrameRequest::allLayers());
    (void)water.takeFrames();
  }
}

class StateBuffersOf : public OnDevice, public ::testing::WithParamInterface<std::string> {
 protected:
  void SetUp() override {
    OnDevice::SetUp();
    if (!ctx_) return;
    const auto scene = scene::loadSceneFile(SPINDRIFT_SOURCE_DIR "/server/scenes/" + GetParam() + ".textproto");
    ASSERT_TRUE(scene) << scene.error().message;
    core::Scene stormy = scene::toCore(*scene);
    if (stormy.storm) stormy.storm->level_ratio = 1.0;
    if (stormy.particles) stormy.particles->settle_s = 0.0;  // other positions in the same buffers
    runEveryPass(make(stormy));
  }
};

TEST_P(StateBuffersOf, CoverAllThatShadersWriteAndAreHashedAndCopied) {
  const StateBuffers declared = sim_->stateBuffers();
  for (const auto& [id, name] : ctx_->lastingBuffers()) {
    EXPECT_TRUE(std::ranges::any_of(declared, [&](const StateBuffer& each) { return each.buffer->id() == id; }))
        << "buffer \"" << name << "\": a shader writes it, and its part neither makes it as scratch nor names it in "
        << "declareState() (state_buffer.h)";
  }
  const StateCopy copy = sim_->copyState();
  std::set<std::string> copied;
  if (!copy.elevation_m.empty()) copied.insert("elevation");
  StateCopy::forEachArray(copy, [&](std::string_view name, const auto& words) {
    if (!words.empty()) copied.emplace(name);
  });
  const SavedState saved = sim_->savedState();
  const std::uint64_t hash = sim_->stateHash();
  EXPECT_EQ(hash, hashOf(saved));
  std::set<std::string> carried;
  std::size_t lasting_count = 0;
  for (const StateBuffer& each : declared) {
    EXPECT_TRUE(each.lasts || !(each.checkpoint || each.carried)) << each.buffer->name();
    if (!each.lasts) continue;
    ASSERT_LT(lasting_count, saved.buffers.size());
    const SavedBuffer& own = saved.buffers[lasting_count++];
    EXPECT_EQ(own.name, each.buffer->name());
    EXPECT_EQ(std::ranges::count(saved.buffers, own.name, &SavedBuffer::name), 1) << own.name;
    if (own.words.empty()) continue;  // particles of a pool without live ones
    if (each.carried) carried.insert(own.name);
    const std::size_t at = own.words.size() - 1;
    each.buffer->uploadValue(own.words[at] ^ 1u, at * sizeof(std::uint32_t));
    EXPECT_NE(sim_->stateHash(), hash) << own.name;
    each.buffer->uploadValue(own.words[at], at * sizeof(std::uint32_t));
  }
  EXPECT_EQ(lasting_count, saved.buffers.size());
  EXPECT_EQ(carried, copied);
  EXPECT_EQ(sim_->stateHash(), hash);
}

INSTANTIATE_TEST_SUITE_P(Scenes, StateBuffersOf, testing::ValuesIn(shippedScenes()),
                         [](const auto& scene) { return scene.param; });

class StateHash : public OnDevice {};

TEST_F(StateHash, CoversTimeEffectsAndBoats) {
  core::Scene scene = smallScene();
  scene.boats.emplace().boats.emplace_back();
  WaterSim& water = make(scene);
  std::set<std::uint64_t> hashes{water.stateHash()};
  EXPECT_EQ(water.stateHash(), *hashes.begin());
  ASSERT_TRUE(water.start(core::Splash{}));
  EXPECT_TRUE(hashes.insert(water.stateHash()).second) << "an effect that has not begun to act";
  const auto boat = water.spawnBoat(core::Boat{.x_m = 2.0});
  ASSERT_TRUE(boat);
  EXPECT_TRUE(hashes.insert(water.stateHash()).second);
  ASSERT_TRUE(water.controlBoat(*boat, 0.5, 0.0));
  EXPECT_TRUE(hashes.insert(water.stateHash()).second) << "controls, which the next tick brings to the device";
  water.reset();
  const std::uint64_t start = water.stateHash();
  EXPECT_TRUE(hashes.insert(start).second) << "as at the start, but for the id of the next boat";
  SavedState later = water.savedState();
  later.run_tick += 1;
  EXPECT_NE(hashOf(later), start);
  later.run_tick -= 1;
  EXPECT_EQ(hashOf(later), start);
  later.host.sea.fade_begin_s = 0.0;
  EXPECT_NE(hashOf(later), start);
}

TEST_F(StateHash, LeavesOutWhatIsBehindTheLiveParticlesOfAPool) {
  core::Scene scene = smallScene();
  scene.coupling->mode = core::CouplingMode::kTwoWay;
  WaterSim& water = make(scene);
  ASSERT_TRUE(water.start(core::Splash{0.0, 0.0, 1.5, 0.9, 0.15}));
  for (int tick = 0; tick < 600 && water.copyState().position.empty(); ++tick) water.step();
  const std::size_t live_count = water.copyState().pool.at(POOL_LIVE);
  ASSERT_GT(live_count, 0u);
  ASSERT_LT(live_count, water.derived().particles->count);
  const std::uint64_t hash = water.stateHash();
  std::size_t buffer_count = 0;
  for (const StateBuffer& each : water.stateBuffers()) {
    if (!each.per_particle) continue;
    ++buffer_count;
    const std::vector<std::uint32_t> words = wordsOf(*each.buffer);
    each.buffer->uploadValue(~words[4 * live_count], 4 * live_count * sizeof(std::uint32_t));
    EXPECT_EQ(water.stateHash(), hash) << each.buffer->name();
    each.buffer->uploadValue(~words[4 * live_count - 1], (4 * live_count - 1) * sizeof(std::uint32_t));
    EXPECT_NE(water.stateHash(), hash) << each.buffer->name();
    each.buffer->upload(words);
  }
  EXPECT_EQ(buffer_count, 3u);
}

TEST_F(StateHash, EveryCarriedBufferContinuesAtTakeOver) {
  core::Scene scene = smallScene();
  scene.coupling->mode = core::CouplingMode::kTwoWay;
  scene.foam->surface = true;
  scene.boats.emplace().boats.emplace_back(core::Boat{.throttle_ratio = 1.0});
  core::setBoundaries(*scene.wave, core::WaveBoundary::kAbsorb);
  scene.wave->absorption = core::Absorption::kPml;
  WaterSim& water = make(scene);
  ASSERT_TRUE(water.start(core::Splash{0.0, 0.0, 1.5, 0.9, 0.15}));
  for (int tick = 0; tick < 600 && water.copyState().position.empty(); ++tick) water.step();
  for (int tick = 0; tick < 10; ++tick) water.step();
  const auto fresh = WaterSim::create(*ctx_, scene);
  ASSERT_TRUE(fresh) << fresh.error().message;
  std::vector<std::vector<std::uint32_t>> before;
  for (const StateBuffer& each : (*fresh)->stateBuffers()) before.push_back(wordsOf(*each.buffer));
  ASSERT_TRUE((*fresh)->takeOver(water.carriedState()));
  const StateBuffers here = water.stateBuffers();
  const StateBuffers there = (*fresh)->stateBuffers();
  std::set<std::string> changed;
  for (std::size_t k = 0; k < there.size(); ++k) {
    if (!there[k].carried) continue;
    ASSERT_NE(wordsOf(*here[k].buffer), before[k]) << there[k].buffer->name() << " has no content here";
    EXPECT_NE(wordsOf(*there[k].buffer), before[k]) << there[k].buffer->name();
    changed.insert(there[k].buffer->name());
  }
  EXPECT_EQ(changed, (std::set<std::string>{"boats", "breaking", "elevation", "elevation from x faces", "flow", "foam",
                                            "pool", "position", "velocity"}));
}

}  // namespace
}  // namespace spindrift::sim
