// The structure of the thesis computes what ours does, and neighbours are counted right.
#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/bench/thesis.h>

#include "neighbours.h"
#include "small_scene.h"
#include "test_device.h"

namespace spindrift::bench {
namespace {

class Thesis : public ::testing::Test {
 protected:
  void SetUp() override {
    auto context = gpu::testContext();
    if (!context) GTEST_SKIP() << "no device: " << context.error().message;
    ctx_ = *std::move(context);
  }

  std::unique_ptr<ThesisComparison> compare(const core::Scene& scene, std::uint32_t count) {
    auto made = ThesisComparison::create(*ctx_, scene, count);
    if (!made) throw std::runtime_error(made.error().message);
    return *std::move(made);
  }

  static void expectEqual(const ThesisDifference& difference) {
    EXPECT_LE(difference.density, kThesisTolerance.density);
    EXPECT_LE(difference.acceleration, kThesisTolerance.acceleration);
    EXPECT_LE(difference.position, kThesisTolerance.position);
    // The order of sums differs, so not a single different bit would mean that one of them did not run.
    EXPECT_GT(difference.density, 0.0);
    EXPECT_GT(difference.acceleration, 0.0);
  }

  std::unique_ptr<gpu::Context> ctx_;
};

TEST_F(Thesis, MovesTheSameParticlesOnAWaveWithPeriodicSides) {
  core::Scene scene = sim::smallScene();
  scene.events.push_back({.at_s = 0.5, .effect = core::Splash{0, 0, 1.5, 0.4, 0.2}});
  for (const std::uint32_t count : {700U, 3000U}) expectEqual(compare(scene, count)->difference());
}

TEST_F(Thesis, MovesTheSameParticlesBetweenWallsWithTheThesisForces) {
  core::Scene scene = sim::smallScene();
  scene.wave.reset();
  scene.coupling.reset();
  scene.particles->box_side_m = 4.0;
  scene.particles->boundary_x = scene.particles->boundary_z = core::Boundary::kWall;
  scene.particles->kernel_set = core::KernelSet::kMuller;
  scene.particles->equation_of_state = core::EquationOfState::kLinear;
  scene.particles->pressure_force = core::PressureForce::kMean;
  scene.events.push_back({.at_s = 0.5, .effect = core::Splash{0, 0, 1.0, 0.3, 0.2}});
  expectEqual(compare(scene, 1500)->difference());
}

TEST_F(Thesis, StepsOfDifferentNumbersAreNotEqual) {
  const auto both = compare(sim::smallScene(), 700);
  const double same = both->difference().position;
  both->stepThesis();
  EXPECT_GT(both->differenceNow().position, 10 * same);
}

TEST_F(Thesis, RefusesAPoolOfParticles) {
  core::Scene scene = sim::smallScene();
  scene.coupling->mode = core::CouplingMode::kTwoWay;
  const auto refused = ThesisComparison::create(*ctx_, scene, 700);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::ErrorCode::kInvalidInput);
  EXPECT_NE(refused.error().message.find("no fixed number of particles"), std::string::npos);
}

TEST(Neighbours, OfALatticeAreCountedAcrossPeriodicSidesAndNotAcrossOthers) {
  constexpr int kSide = 6;
  std::vector<float> position;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    for (const int step : {1, kSide, kSide * kSide}) position.push_back(static_cast<float>(i / step % kSide));
    position.push_back(0.0F);
  }
  // Within 1.2 spacings: 6 inside of the lattice; each face that is not periodic lacks one for 1/6 of the particles.
  EXPECT_DOUBLE_EQ(meanNeighbours(position, {.support_radius_m = 1.2, .side_m = {6.0, 6.0, 6.0}}), 6.0);
  EXPECT_DOUBLE_EQ(meanNeighbours(position, {.support_radius_m = 1.2, .side_m = {6.0, 0.0, 6.0}}), 6.0 - 2.0 / 6.0);
  EXPECT_DOUBLE_EQ(meanNeighbours(position, {.support_radius_m = 1.2}), 5.0);
  // Within 1.5 spacings: 18 inside.
  EXPECT_DOUBLE_EQ(meanNeighbours(position, {.support_radius_m = 1.5, .side_m = {6.0, 6.0, 6.0}}), 18.0);
  EXPECT_EQ(meanNeighbours({}, {.support_radius_m = 1.0}), 0.0);
}

}  // namespace
}  // namespace spindrift::bench
