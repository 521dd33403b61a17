// Boats that another program moves: where they are, what they press with, the forces on them, and how they become the
// water's again.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <shared/boats.h>
#include <shared/fixed_point.h>

#include <spindrift/study/hull_pressure.h>

#include "sim_fixture.h"

namespace spindrift::sim::moved_boats {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr std::uint32_t kCells = 64;
constexpr double kSide_m = 12.8;
constexpr double kDepth_m = 1.5;
constexpr double kWeight_npm3 = 1000.0 * 9.81;

core::Boat hull() {
  return {.length_m = 3.0, .beam_m = 1.2, .height_m = 0.8, .density_ratio = 0.25};
}

core::Scene basin(core::Bulk bulk = core::Bulk::kLinear) {
  core::Scene scene;
  scene.name = "moved boats";
  scene.wave.emplace();
  scene.wave->resolution_count = kCells;
  scene.wave->side_m = kSide_m;
  scene.wave->depth_m = kDepth_m;
  scene.wave->damping_per_s = 0.0;
  scene.wave->bulk = bulk;
  setBoundaries(*scene.wave, core::WaveBoundary::kPeriodic);
  scene.boats.emplace();
  scene.boats->boats = {hull()};
  return scene;
}

/// The hull of basin() at rest with this draught.
HullMotion heldAt(double draught_m) {
  return {.boat_id = 1, .y_m = 0.4 - draught_m};
}

class MovedBoats : public OnDevice {
 protected:
  static void place(WaterSim& sim, const HullMotion& motion) {
    const auto moved = sim.moveBoat(motion);
    ASSERT_TRUE(moved) << moved.error().message;
  }
  /// Returns the forces of all ticks so far. An asynchronous device may tell of an end some time after finish().
  std::vector<HullForces> allForces(WaterSim& sim) {
    ctx_->finish();
    std::vector<HullForces> out = sim.takeHullForces();
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (sim.hullForcesInFlight() > 0 && std::chrono::steady_clock::now() < deadline)
      std::ranges::move(sim.takeHullForces(), std::back_inserter(out));
    return out;
  }
  /// Steps, with the same pose again before each tick, and returns what the last one did to the boat.
  HullForce forceAfter(WaterSim& sim, const HullMotion& motion, int tick_count) {
    HullForces last;
    for (int k = 0; k < tick_count; ++k) {
      place(sim, motion);
      sim.step();
      for (HullForces& forces : allForces(sim)) last = std::move(forces);
      EXPECT_EQ(last.tick, sim.tick());
    }
    EXPECT_THAT(last.hulls, SizeIs(1));
    if (last.hulls.empty()) return {};
    EXPECT_EQ(last.hulls.front().boat_id, 1u);
    return last.hulls.front();
  }
  static std::array<float, 28> boatOf(WaterSim& sim) {
    std::array<float, 28> out{};
    std::ranges::copy_n(sim.copyState().boats.begin(), 28, out.begin());
    return out;
  }
};

TEST_F(MovedBoats, BuoyancyIsThatOfTheDisplacedBoxAtAnyDraught) {
  WaterSim& sim = make(basin());
  for (const double draught_m : {-0.1, 0.0, 0.05, 0.2, 0.5, 0.8, 1.1}) {
    const HullForce force = forceAfter(sim, heldAt(draught_m), 1);
    const double volume_m3 = 3.0 * 1.2 * std::clamp(draught_m, 0.0, 0.8);
    EXPECT_NEAR(force.hydrostatic.force_n[1], kWeight_npm3 * volume_m3, 0.004 * kWeight_npm3 * volume_m3 + 1e-3);
    EXPECT_NEAR(force.hydrostatic.force_n[0], 0.0, 1e-6);
    EXPECT_NEAR(force.hydrostatic.moment_nm[0], 0.0, 1e-3 * kWeight_npm3);
  }
}

TEST_F(MovedBoats, AHullAtRestFeelsNothingButItsBuoyancy) {
  core::Scene scene = basin();
  scene.wave->damping_per_s = 1.0;
  WaterSim& sim = make(scene);
  const HullForce force = forceAfter(sim, heldAt(0.2), 900);
  const double area_m2 = 3.0 * 1.2;
  const double raised_m = area_m2 * 0.2 / (kSide_m * kSide_m);  // by the displaced water
  EXPECT_NEAR(force.dynamic.force_n[1], kWeight_npm3 * area_m2 * raised_m, 0.02 * kWeight_npm3 * area_m2 * raised_m);
  for (const std::size_t axis : {0u, 2u}) {
    EXPECT_NEAR(force.dynamic.force_n[axis], 0.0, 1.0);
    EXPECT_NEAR(force.drag.force_n[axis], 0.0, 1.0);
  }
}

TEST_F(MovedBoats, AHeeledAndTrimmedHullIsTurnedBack) {
  WaterSim& sim = make(basin());
  HullMotion motion = heldAt(0.3);
  motion.roll_rad = 0.03;
  motion.pitch_rad = 0.02;
  const HullForce force = forceAfter(sim, motion, 1);
  // Wall-sided: second moment of the hull's shape, less the lever of the buoyancy under the centre.
  const double shape = 0.30635 / 0.9064;  // integrals of s^2 exp(-s^4) and exp(-s^4) over s > 0
  const double area_m2 = 3.0 * 1.2, lever_m4 = area_m2 * 0.3 * (0.8 - 0.3) / 2;
  const double roll_nm = kWeight_npm3 * (area_m2 * 0.6 * 0.6 * shape - lever_m4) * 0.03;
  const double pitch_nm = kWeight_npm3 * (area_m2 * 1.5 * 1.5 * shape - lever_m4) * 0.02;
  EXPECT_NEAR(force.hydrostatic.moment_nm[0], -roll_nm, 0.03 * roll_nm);
  EXPECT_NEAR(force.hydrostatic.moment_nm[1], -pitch_nm, 0.03 * pitch_nm);
}

/// Momentum of nonlinear water over its density. [m^4/s]
std::array<double, 2> momentumOf(const StateCopy& state) {
  const double cell_m2 = kSide_m * kSide_m / (kCells * kCells);
  std::array<double, 2> out{};
  for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
    const std::size_t x = i % kCells, z = i / kCells;
    const std::array<std::size_t, 2> there = {(x + 1) % kCells + kCells * z, x + kCells * ((z + 1) % kCells)};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double water_m = kDepth_m + 0.5 * (state.elevation_m[i] + state.elevation_m[there[axis]]);
      out[axis] += cell_m2 * water_m * double{state.flow_m2ps[4 * i + axis]};
    }
  }
  return out;
}

TEST_F(MovedBoats, TheWaterGetsTheMomentumThatTheHullIsToldToLose) {
  WaterSim& sim = make(basin(core::Bulk::kNonlinear));
  HullMotion motion = heldAt(0.25);
  motion.x_m = -3.0;
  motion.heading_rad = 0.4;
  motion.velocity_x_mps = 1.4;
  motion.velocity_z_mps = 0.9;
  motion.yaw_rate_radps = 0.3;
  const double tick_s = sim.derived().tick_s;
  std::array<double, 2> given{};
  std::array<double, 2> drag{}, start{};
  constexpr int kTicks = 150;
  for (int k = 0; k < kTicks; ++k) {
    const HullForce force = forceAfter(sim, motion, 1);
    if (k == 29) {  // the splash of the beginning is over
      start = momentumOf(sim.copyState());
      given = drag = {};
    } else {
      for (std::size_t axis = 0; axis < 2; ++axis) {
        given[axis] -= tick_s * (force.dynamic.force_n[2 * axis] + force.drag.force_n[2 * axis]);
        drag[axis] -= tick_s * force.drag.force_n[2 * axis];
      }
    }
    motion.x_m += tick_s * motion.velocity_x_mps;
    motion.z_m += tick_s * motion.velocity_z_mps;
    motion.heading_rad += tick_s * motion.yaw_rate_radps;
  }
  const auto end = momentumOf(sim.copyState());
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double gained = 1000.0 * (end[axis] - start[axis]);
    EXPECT_GT(std::abs(given[axis]), 50.0);
    EXPECT_GT(std::abs(given[axis] - drag[axis]), 0.05 * std::abs(given[axis])) << "waves take a part";
    EXPECT_NEAR(gained, given[axis], 0.01 * std::abs(given[axis])) << "axis " << axis;
  }
}

TEST_F(MovedBoats, TheLastOfSeveralPosesInATickCounts) {
  const auto stateAfter = [&](const std::vector<double>& draughts_m) {
    WaterSim& sim = make(basin());
    for (int k = 0; k < 10; ++k) {
      for (const double draught_m : draughts_m) place(sim, heldAt(draught_m));
      sim.step();
    }
    return sim.stateHash();
  };
  const std::uint64_t one = stateAfter({0.3});
  EXPECT_EQ(stateAfter({0.1, 0.75, 0.3}), one);
  EXPECT_NE(stateAfter({0.1}), one);
}

TEST_F(MovedBoats, ABoatContinuesForHalfASecondAndIsThenTheWaters) {
  WaterSim& sim = make(basin());
  sim.step();
  HullMotion motion = heldAt(0.2);
  motion.velocity_x_mps = 2.0;
  place(sim, motion);
  const int tick_count = static_cast<int>(std::lround(kMovedFor_s / sim.derived().tick_s));
  for (int k = 1; k <= tick_count; ++k) {
    sim.step();
    EXPECT_NEAR(boatOf(sim)[0], 2.0 * k * sim.derived().tick_s, 1e-4);
    EXPECT_EQ(boatOf(sim)[1], 0.2f);
  }
  EXPECT_EQ(boatOf(sim)[22], 0.0f);
  EXPECT_THAT(allForces(sim), SizeIs(testing::Le(tick_count)));
  const float before_mps = boatOf(sim)[8];
  for (int k = 0; k < 30; ++k) sim.step();
  EXPECT_LT(boatOf(sim)[8], before_mps) << "drag slows it now";
  EXPECT_THAT(allForces(sim), IsEmpty());
}

TEST_F(MovedBoats, AReleasedBoatIsAsFreeAsBefore) {
  core::Scene scene = basin();
  scene.wave->damping_per_s = 1.0;
  WaterSim& sim = make(scene);
  for (int k = 0; k < 600; ++k) sim.step();
  const float rest_m = boatOf(sim)[1];
  HullMotion motion{.boat_id = 1, .y_m = rest_m};
  place(sim, motion);
  sim.step();
  ASSERT_TRUE(sim.releaseBoat(1));
  ASSERT_TRUE(sim.releaseBoat(1)) << "nobody moves it";
  for (int k = 0; k < 60; ++k) sim.step();
  EXPECT_NEAR(boatOf(sim)[1], rest_m, 0.01);
  EXPECT_EQ(boatOf(sim)[22], 0.0f);
}

TEST_F(MovedBoats, ABoatThrownIntoTheAirFallsAndFloats) {
  WaterSim& sim = make(basin());
  for (int k = 0; k < 70; ++k) {
    place(sim, {.boat_id = 1, .y_m = 2.0, .pitch_rad = 1.2});
    sim.step();
  }
  EXPECT_NEAR(boatOf(sim)[4], 1.2, 1e-6);
  ASSERT_TRUE(sim.releaseBoat(1));
  for (int k = 0; k < 600; ++k) sim.step();
  EXPECT_NEAR(boatOf(sim)[1], 0.2, 0.1);
  EXPECT_EQ(sim.recoveredCount(), 0u);
}

TEST_F(MovedBoats, ForcesOfEveryTickComeWithItsNumber) {
  WaterSim& sim = make(basin());
  std::vector<std::uint64_t> ticks;
  for (int k = 0; k < 20; ++k) {
    place(sim, heldAt(0.2));
    sim.step();
    EXPECT_LE(sim.hullForcesInFlight(), WaterSim::kMaxTicksInFlight + 1);
    for (const HullForces& forces : sim.takeHullForces()) ticks.push_back(forces.tick);
  }
  for (const HullForces& forces : allForces(sim)) ticks.push_back(forces.tick);
  ASSERT_EQ(ticks.size(), 20u);
  for (std::size_t k = 0; k < ticks.size(); ++k) EXPECT_EQ(ticks[k], k + 1);
  EXPECT_EQ(sim.hullForcesInFlight(), 0u);
}

TEST_F(MovedBoats, ASavedStateContinuesBitForBit) {
  WaterSim& sim = make(basin());
  HullMotion motion = heldAt(0.3);
  motion.velocity_z_mps = 1.0;
  for (int k = 0; k < 20; ++k) sim.step();
  place(sim, motion);
  for (int k = 0; k < 10; ++k) sim.step();
  const SavedState saved = sim.savedState();
  auto other = WaterSim::create(*ctx_, basin());
  ASSERT_TRUE(other);
  ASSERT_TRUE((*other)->restore(saved));
  for (int k = 0; k < 40; ++k) {  // over the end of its half second
    sim.step();
    (*other)->step();
    if (k == 5) {
      motion.z_m = boatOf(sim)[2];
      place(sim, motion);
      place(**other, motion);
    }
  }
  EXPECT_EQ((*other)->stateHash(), sim.stateHash());
}

TEST_F(MovedBoats, AnotherFidelityKeepsMovingTheBoat) {
  WaterSim& sim = make(basin());
  for (int k = 0; k < 70; ++k) {
    place(sim, heldAt(0.6));
    sim.step();
  }
  core::Scene finer = basin();
  finer.wave->resolution_count = 96;
  auto other = WaterSim::create(*ctx_, finer);
  ASSERT_TRUE(other);
  ASSERT_TRUE((*other)->takeOver(sim.carriedState()));
  for (int k = 0; k < 7; ++k) (*other)->step();
  EXPECT_NEAR(boatOf(**other)[1], -0.2, 1e-6);
  const auto forces = allForces(**other);
  ASSERT_THAT(forces, SizeIs(7));
  const double volume_m3 = 3.0 * 1.2 * 0.6;
  EXPECT_NEAR(forces.back().hulls.front().hydrostatic.force_n[1], kWeight_npm3 * volume_m3,
              0.004 * kWeight_npm3 * volume_m3);
  for (int k = 0; k < 30; ++k) (*other)->step();
  EXPECT_EQ(boatOf(**other)[22], 0.0f);
}

TEST_F(MovedBoats, AResetEndsTheMove) {
  WaterSim& sim = make(basin());
  place(sim, heldAt(0.7));
  sim.step();
  sim.reset();
  EXPECT_EQ(boatOf(sim)[22], 0.0f);
  EXPECT_NEAR(boatOf(sim)[1], 0.2, 1e-6);
  sim.step();
  (void)allForces(sim);
  sim.step();
  EXPECT_THAT(allForces(sim), IsEmpty());
}

TEST_F(MovedBoats, WaterThatFailsIsMendedUnderAMovedHull) {
  WaterSim& sim = make(basin());
  for (int k = 0; k < 130; ++k) {
    place(sim, heldAt(0.3));
    sim.step();
    (void)sim.takeHullForces();
  }
  StateCopy broken = sim.copyState();
  broken.flow_m2ps[100] = std::numeric_limits<float>::infinity();
  sim.setState(broken);
  for (int k = 0; k < 20; ++k) {
    place(sim, heldAt(0.3));
    sim.step();
    (void)sim.takeHullForces();
  }
  EXPECT_GE(sim.recoveredCount(), 1u);
  const HullForce force = forceAfter(sim, heldAt(0.3), 60);
  EXPECT_NEAR(force.hydrostatic.force_n[1], kWeight_npm3 * 1.08, 0.01 * kWeight_npm3);
  EXPECT_TRUE(std::isfinite(force.dynamic.force_n[1]));
}

TEST_F(MovedBoats, OthersBounceOffAMovedBoatAndDoNotMoveIt) {
  core::Scene scene = basin();
  core::Boat other = hull();
  other.x_m = -4.5;
  other.throttle_ratio = 1.0;
  scene.boats->boats.push_back(other);
  WaterSim& sim = make(scene);
  for (int k = 0; k < 300; ++k) {
    place(sim, heldAt(0.2));
    sim.step();
  }
  const auto boats = sim.copyState().boats;
  EXPECT_EQ(boats[0], 0.0f);
  EXPECT_EQ(boats[2], 0.0f);
  EXPECT_LT(boats[28], -2.5f) << "it stands in the way";
}

TEST_F(MovedBoats, HullsBelowTheFloorAndOnLandPressWithNoMoreThanTheWater) {
  core::Scene scene = basin(core::Bulk::kNonlinear);
  setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
  scene.beaches.push_back({});
  scene.boats->boats.front().height_m = 4.0;
  WaterSim& sim = make(scene);
  for (int k = 0; k < 120; ++k) {
    place(sim, {.boat_id = 1, .x_m = k % 2 ? 6.3 : -6.3, .y_m = k % 3 ? -400.0 : 3.0, .velocity_y_mps = -50});
    sim.step();
  }
  EXPECT_EQ(sim.recoveredCount(), 0u);
  EXPECT_EQ(sim.health().nonfinite_count, 0u);
}

TEST_F(MovedBoats, UnknownBoatsAndScenesWithoutAWaveAreRefused) {
  WaterSim& sim = make(basin());
  const auto unknown = sim.moveBoat({.boat_id = 9});
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, testing::HasSubstr("boat_id: 9"));
  EXPECT_FALSE(sim.releaseBoat(9));
  core::Scene dry = smallScene();
  dry.wave.reset();
  dry.coupling.reset();
  dry.boats.emplace();
  dry.boats->boats = {hull()};
  WaterSim& particles = make(dry);
  EXPECT_FALSE(particles.moveBoat({.boat_id = 1}));
  EXPECT_FALSE(particles.releaseBoat(1));
  particles.step();
}

}  // namespace
}  // namespace spindrift::sim::moved_boats
