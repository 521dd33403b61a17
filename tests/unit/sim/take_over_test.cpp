// A simulation takes over the water of another one at another resolution.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <shared/boats.h>

#include <spindrift/sim_setup/scene_parts.h>

#include "same_water_scenes.h"
#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

class TakeOver : public OnDevice {
 protected:
  std::unique_ptr<WaterSim> another(const core::Scene& scene) {
    auto made = WaterSim::create(*ctx_, scene);
    if (!made) throw std::runtime_error(made.error().message);
    return *std::move(made);
  }
  /// Mean elevation of 8 x 8 squares over the water, x fastest.
  static std::vector<double> squares(WaterSim& sim) {
    const StateCopy state = sim.copyState();
    const std::uint32_t n = sim.derived().wave->count_x;
    std::vector<double> out(64, 0.0);
    for (std::size_t i = 0; i < state.elevation_m.size(); ++i)
      out[8 * (i / n / (n / 8)) + i % n / (n / 8)] +=
          state.elevation_m[i] * 64.0 / static_cast<double>(std::size_t{n} * n);
    return out;
  }
};

TEST_F(TakeOver, AWaveGoesOnAtAnotherResolution) {
  for (const std::uint32_t to_count : {96u, 240u}) {
    WaterSim& sim = make(basin(160));
    ASSERT_TRUE(sim.start(core::Splash{1.0, -1.0, 2.5, 0.3, 0.2}));
    for (int k = 0; k < 60; ++k) sim.step();
    const auto next = another(basin(to_count));
    for (int k = 0; k < 4; ++k) next->step();
    next->reset();
    ASSERT_TRUE(next->takeOver(sim.carriedState()));
    EXPECT_NEAR(next->time_s(), 1.0, 1e-9);
    for (int k = 0; k < 60; ++k) {
      sim.step();
      next->step();
      ASSERT_EQ(next->health().volume_error_units, 0);
    }
    EXPECT_GT(next->health().tick, 0u);
    const auto wanted = squares(sim);
    const auto found = squares(*next);
    double off = 0.0, held = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      off += std::pow(found[i] - wanted[i], 2);
      held += std::pow(wanted[i], 2);
    }
    EXPECT_LT(std::sqrt(off / held), 0.08) << "to " << to_count << " cells";
  }
}

TEST_F(TakeOver, BoatsKeepIdsPosesSpeedsAndControls) {
  WaterSim& sim = make(harbor(96));
  const auto boat = sim.spawnBoat(core::Boat{.x_m = -2.0, .z_m = 4.0});
  ASSERT_TRUE(boat);
  ASSERT_TRUE(sim.removeBoat(1));
  ASSERT_TRUE(sim.controlBoat(*boat, 0.7, -0.3));
  for (int k = 0; k < 90; ++k) sim.step();
  const auto next = another(harbor(144));
  const CarriedState carried = sim.carriedState();
  ASSERT_TRUE(next->takeOver(carried));
  EXPECT_EQ(next->copyState().boats, carried.state.boats);
  ASSERT_EQ(next->boats().size(), 1u);
  EXPECT_EQ(next->boats()[0].boat_id, *boat);
  EXPECT_EQ(next->nextBoatId(), sim.nextBoatId());
  for (int k = 0; k < 60; ++k) {
    sim.step();
    next->step();
  }
  const StateCopy a = sim.copyState(), b = next->copyState();
  const std::size_t slot = 4 * BOAT_TEXELS;  // the second one
  EXPECT_NEAR(a.boats[slot], b.boats[slot], 0.1f) << "x: it drives on";
  EXPECT_NEAR(a.boats[slot + 2], b.boats[slot + 2], 0.1f);
  EXPECT_NEAR(a.boats[slot + 1], b.boats[slot + 1], 0.03f) << "y: it does not jump";
  EXPECT_GT(std::hypot(b.boats[slot] - carried.state.boats[slot], b.boats[slot + 2] - carried.state.boats[slot + 2]),
            0.3f);
  EXPECT_EQ(next->health().volume_error_units, 0);
}

TEST_F(TakeOver, AnEffectInProgressAndSprayInTheAirGoOn) {
  WaterSim& sim = make(twoWay(96, 0.12));
  ASSERT_TRUE(sim.start(core::Splash{0.0, 0.0, 2.0, 1.0, 0.15}));
  while (sim.health().particle_count < 100 && sim.time_s() < 5) sim.step();
  ASSERT_GE(sim.health().particle_count, 100u);
  ASSERT_TRUE(sim.start(core::Splash{4.0, 4.0, 1.0, 0.3, 0.5}));
  for (int k = 0; k < 5; ++k) sim.step();
  const auto next = another(twoWay(144, 0.09));
  ASSERT_TRUE(next->takeOver(sim.carriedState()));
  for (int k = 0; k < 20; ++k) {
    sim.step();
    next->step();
    ASSERT_EQ(next->health().volume_error_units, 0);
  }
  EXPECT_GT(next->health().particle_count, sim.health().particle_count) << "the drops are smaller";
  const auto depthAt = [](WaterSim& water) {
    const StateCopy state = water.copyState();
    const WaveLayout& wave = *water.derived().wave;
    const auto at = static_cast<std::size_t>((4.0 + wave.length_m / 2) / wave.cell_m);
    return state.elevation_m[at + at * wave.count_x];
  };
  EXPECT_LT(depthAt(*next), -0.05);
  EXPECT_NEAR(depthAt(*next), depthAt(sim), 0.05);
  for (int k = 0; k < 900 && next->health().particle_count > 0; ++k) next->step();
  EXPECT_EQ(next->health().particle_count, 0u);
  EXPECT_EQ(next->health().volume_error_units, 0);
}

TEST_F(TakeOver, AWindSeaComesInWithoutABreak) {
  const auto stormy = [](std::uint32_t n) {
    core::Scene scene = harbor(n);
    scene.boats.reset();
    scene.storm.emplace();
    scene.storm->level_ratio = 0.5;
    scene.storm->drops_per_m2_s = 0.0;
    scene.storm->wind_speed_mps = 12.0;
    scene.storm->wind_direction_deg = 0.0;  // from the open side
    return scene;
  };
  WaterSim& sim = make(stormy(96));
  for (int k = 0; k < 600; ++k) sim.step();
  const auto next = another(stormy(144));
  ASSERT_TRUE(next->takeOver(sim.carriedState()));
  double off = 0.0, held = 0.0;
  for (int k = 0; k < 60; ++k) {
    sim.step();
    next->step();
    ASSERT_EQ(next->health().volume_error_units, 0);
    if (k % 10 != 9) continue;
    const auto wanted = squares(sim), found = squares(*next);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      off += std::pow(found[i] - wanted[i], 2);
      held += std::pow(wanted[i], 2);
    }
  }
  RecordProperty("off_percent", static_cast<int>(100 * std::sqrt(off / held)));
  EXPECT_GT(std::sqrt(held / (6 * 64)), 0.005) << "there is a sea";
  // The finer grid resolves other waves; those of the coarser one fade into them in four seconds.
  EXPECT_LT(std::sqrt(off / held), 0.1);
}

TEST_F(TakeOver, IsTheSameTwiceAndAfterItAResetStartsAtTheBeginning) {
  WaterSim& sim = make(harbor(96));
  for (int k = 0; k < 30; ++k) sim.step();
  const CarriedState carried = sim.carriedState();
  const auto next = another(harbor(144));
  const auto start = next->stateHash();
  ASSERT_TRUE(next->takeOver(carried));
  next->step();
  const auto one = next->stateHash();
  next->reset();
  EXPECT_EQ(next->stateHash(), start);
  ASSERT_TRUE(next->takeOver(carried));
  next->step();
  EXPECT_EQ(next->stateHash(), one);
}

TEST_F(TakeOver, OfOtherWaterIsRefusedAndChangesNothing) {
  WaterSim& sim = make(harbor(96));
  const CarriedState carried = sim.carriedState();
  const auto next = another(basin(96));
  const auto before = next->stateHash();
  const auto taken = next->takeOver(carried);
  ASSERT_FALSE(taken);
  EXPECT_THAT(taken.error().message, testing::HasSubstr("cannot continue"));
  EXPECT_EQ(next->stateHash(), before);
}

TEST_F(OnDevice, WaterWithoutBoatsKeepsTheNumberOfTheNextBoat) {
  core::Scene scene = smallScene();
  WaterSim& water = make(scene);
  water.numberBoatsFrom(33);
  const SavedState saved = water.savedState();
  const CarriedState carried = water.carriedState();
  for (const bool restores : {true, false}) {
    WaterSim& fresh = make(scene);
    ASSERT_TRUE(restores ? fresh.restore(saved) : fresh.takeOver(carried));
    EXPECT_EQ(fresh.nextBoatId(), 33u) << (restores ? "restored" : "taken over");
  }
}

}  // namespace
}  // namespace spindrift::sim
