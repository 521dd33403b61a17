// The number of particles changed while other parameters were not what they are now: the lattice follows from both.
#include <gmock/gmock.h>

#include <spindrift/scene/scene_loader.h>
#include <spindrift/water/room_water.h>

#include "commands.h"

namespace spindrift::test {
namespace {

constexpr const char* kTank = R"(
  wave { resolution_count: 32 side_m: 8 depth_m: 1 }
  particles { count: 256 layers_count: 2 headroom_m: 2 }
  coupling {}
)";

class KeptLayout : public testing::Test {
 protected:
  std::unique_ptr<water::RoomWater> make() {
    auto scene = scene::parseSceneText(kTank, "tank");
    if (!scene) throw std::runtime_error(scene.error().message);
    auto water = water::Water::create({gpu::DeviceChoice::Kind::kSoftware, 0}, *std::move(scene));
    if (!water) return nullptr;
    return std::make_unique<water::RoomWater>(*std::move(water));
  }
  static void set(water::RoomWater& water, const std::string& path, double value) {
    const auto rejected = water.apply(setParameter(path, value));
    EXPECT_FALSE(rejected) << rejected->message();
  }
};

TEST_F(KeptLayout, RoomResumesWithAnOlderParticleLayout) {
  const auto before = make();
  if (!before) GTEST_SKIP() << "no device";
  set(*before, "gravity_mps2", 8.0);
  set(*before, "particles.count", 400);
  ASSERT_FALSE(before->apply(reset()));
  set(*before, "gravity_mps2", 11.0);
  set(*before, "particles.count", 256);
  set(*before, "gravity_mps2", 9.81);
  for (int k = 0; k < 5; ++k) before->step();
  v1::KeptState state;
  before->save(state);

  const auto after = make();
  after->bind();
  const auto restored = after->restore(state);
  ASSERT_TRUE(restored) << restored.error().message;
  const auto expectTheSame = [&](const char* when) {
    after->bind();
    const std::uint64_t hash = after->sim().stateHash();
    before->bind();
    EXPECT_EQ(before->sim().stateHash(), hash) << when;
  };
  const auto both = [&](const auto& act) {
    before->bind();
    act(*before);
    after->bind();
    act(*after);
  };
  both([](water::RoomWater& water) { water.step(); });
  expectTheSame("after a tick");
  both([](water::RoomWater& water) { (void)water.apply(reset()); });
  expectTheSame("after a reset");
  both([](water::RoomWater& water) { set(water, "particles.count", 300); });
  expectTheSame("after another number of particles");
  before->bind();
}

}  // namespace
}  // namespace spindrift::test
