// The device's step against the reference in double precision, through the solver's public interface.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <spindrift/study/step_comparison.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

class Solver : public OnDevice {
 protected:
  void compare(const core::Scene& scene) {
    WaterSim& sim = make(study::oneSubstepScene(scene));
    const auto compared = study::compareStep(sim);
    ASSERT_TRUE(compared) << compared.error().message;
    const study::StepErrors& errors = *compared;
    const std::uint32_t count = sim.derived().particles->count;
    EXPECT_GT(errors.compared_count, count / 2);
    EXPECT_LE(errors.density_ratio, 1e-5) << "largest relative density error of " << count << " particles";
    EXPECT_LE(errors.motion_ratio, 1e-4) << "largest error of acceleration or correction over their mean";
  }
};

TEST_F(Solver, AgreesWithTheReferenceInACoupledPeriodicPatch) {
  for (const std::uint32_t count : {300u, 1100u}) compare(smallScene(count));
}

TEST_F(Solver, AgreesWithTheReferenceForEachKernelSet) {
  for (const auto set : {core::KernelSet::kMuller, core::KernelSet::kCubicSpline, core::KernelSet::kWendlandC2}) {
    core::Scene scene = smallScene(500);
    scene.particles->kernel_set = set;
    compare(scene);
  }
}

TEST_F(Solver, AgreesWithTheReferenceForEachVirtualLattice) {
  for (const std::uint32_t lattice : {3u, 5u}) {
    core::Scene scene = smallScene(450);
    scene.coupling->lattice_count = lattice;
    compare(scene);
  }
}

TEST_F(Solver, AgreesWithTheReferenceBetweenWallsOnAFlatFloor) {
  core::Scene scene = smallScene(700);
  scene.wave.reset();
  scene.coupling.reset();
  scene.particles->box_side_m = 4.0;
  scene.particles->layers_count = 5;
  scene.particles->boundary_x = core::Boundary::kWall;
  scene.particles->boundary_z = core::Boundary::kWall;
  compare(scene);
}

TEST_F(Solver, AgreesWithTheReferenceWithOnePeriodicAxisAndAWiderSupport) {
  core::Scene scene = smallScene(800);
  scene.particles->support_ratio = 2.4;
  scene.particles->boundary_z = core::Boundary::kWall;
  compare(scene);
}

TEST_F(Solver, AgreesWithTheReferenceForEachEquationOfStateAndForceForm) {
  std::uint32_t count = 310;  // changes for each case; never a multiple of the work group
  for (const auto set : {core::KernelSet::kMuller, core::KernelSet::kCubicSpline, core::KernelSet::kWendlandC2}) {
    for (const auto equation : {core::EquationOfState::kLinear, core::EquationOfState::kTait}) {
      for (const auto force : {core::PressureForce::kConserving, core::PressureForce::kMean}) {
        core::Scene scene = smallScene(count += 37);
        scene.particles->kernel_set = set;
        scene.particles->equation_of_state = equation;
        scene.particles->pressure_force = force;
        scene.particles->cohesion = count % 2 == 0;
        scene.particles->boundary_x = count % 3 == 0 ? core::Boundary::kWall : core::Boundary::kPeriodic;
        SCOPED_TRACE(count);
        compare(scene);
      }
    }
  }
}

TEST_F(Solver, AgreesWithTheReferenceInAnOblongBoxThatIsPartlyFilled) {
  core::Scene scene = smallScene(600);
  scene.wave.reset();
  scene.coupling.reset();
  scene.particles->box_side_m = 6.0;
  scene.particles->box_width_m = 2.5;
  scene.particles->fill_x_ratio = 0.4;
  scene.particles->layers_count = 7;
  scene.particles->boundary_x = core::Boundary::kWall;
  scene.particles->boundary_z = core::Boundary::kWall;
  compare(scene);
}

TEST_F(Solver, OneIterationOfPositionsAgreesWithTheReference) {
  for (const bool walls : {false, true}) {
    for (const auto set : {core::KernelSet::kMuller, core::KernelSet::kCubicSpline, core::KernelSet::kWendlandC2}) {
      core::Scene scene = smallScene(450);
      scene.wave.reset();
      scene.coupling.reset();
      scene.particles->box_side_m = 4.0;
      scene.particles->kernel_set = set;
      scene.particles->solver = core::PressureSolver::kPositionBased;
      scene.particles->cohesion = walls;
      if (walls) scene.particles->boundary_x = scene.particles->boundary_z = core::Boundary::kWall;
      compare(scene);
    }
  }
}

TEST_F(Solver, AgreesWithTheReferenceWhereAColumnHasMoreCandidatesThanBits) {
  for (const auto solver : {core::PressureSolver::kWeaklyCompressible, core::PressureSolver::kPositionBased}) {
    core::Scene scene = smallScene(1200);
    scene.wave.reset();
    scene.coupling.reset();
    scene.particles->box_side_m = 3.0;
    scene.particles->layers_count = 10;
    scene.particles->support_ratio =
        2.6;  // 53 candidates in a column inside of the lattice, grid/candidates.glsl has 32 bits
    scene.particles->boundary_x = scene.particles->boundary_z = core::Boundary::kWall;
    scene.particles->solver = solver;
    compare(scene);
  }
}

TEST_F(Solver, AgreesWithTheReferenceInABoxThatIsPeriodicInEveryDirection) {
  for (const auto solver : {core::PressureSolver::kWeaklyCompressible, core::PressureSolver::kPositionBased}) {
    core::Scene scene = smallScene(5 * 12 * 12);
    scene.wave.reset();
    scene.coupling.reset();
    scene.gravity_mps2 = 0.0;
    scene.particles->box_side_m = 2.0;
    scene.particles->layers_count = 5;
    scene.particles->periodic_y = true;
    scene.particles->fill_density_ratio = 1.1;
    scene.particles->solver = solver;
    compare(scene);
  }
}

/// Two particles, 0.8 spacings apart and far from the others, with speeds +-`speed_mps` along their line; returns the
/// speeds along it after one step without viscosity.
class Pair : public Solver {
 protected:
  std::array<double, 2> after(core::PressureSolver solver, float speed_mps) {
    core::Scene scene = smallScene(900);
    scene.wave.reset();
    scene.coupling.reset();
    scene.foam.reset();
    scene.particles->box_side_m = 8.0;
    scene.particles->viscosity_pas = 0.0;
    scene.particles->solver = solver;
    WaterSim& sim = make(study::oneSubstepScene(scene));
    StateCopy state = sim.copyState();
    state.velocity.assign(state.velocity.size(), 0.0f);
    const auto gap_m = static_cast<float>(0.8 * sim.derived().particles->spacing_m);
    for (std::size_t k = 0; k < 2; ++k) {
      const float side = k == 0 ? -1.0f : 1.0f;
      state.position[4 * k] = side * gap_m / 2;
      state.position[4 * k + 1] = 2.5f;
      state.position[4 * k + 2] = 0.0f;
      state.velocity[4 * k] = -side * speed_mps;
    }
    sim.setState(state);
    sim.step();
    const StateCopy moved = sim.copyState();
    std::array<double, 2> out{};
    for (std::size_t i = 0; i < moved.position.size() / 4; ++i) {
      if (moved.position[4 * i + 3] < 1.5f)
        out[static_cast<std::size_t>(moved.position[4 * i + 3])] = moved.velocity[4 * i];
    }
    return out;
  }
};

TEST_F(Pair, LosesSpeedWhereItApproachesAndNeverBounces) {
  for (const auto solver : {core::PressureSolver::kWeaklyCompressible, core::PressureSolver::kPositionBased}) {
    double kept_before = 1.0;
    for (const float speed_mps : {0.1f, 1.0f, 3.0f}) {
      const auto [left, right] = after(solver, speed_mps);
      EXPECT_NEAR(left, -right, 1e-5 * speed_mps) << "momentum";
      EXPECT_GT(left, 0.0);
      EXPECT_LT(left / speed_mps, kept_before) << "faster pairs lose more";
      kept_before = left / speed_mps;
    }
  }
}

TEST_F(Pair, KeepsItsSpeedWhereItParts) {
  for (const auto solver : {core::PressureSolver::kWeaklyCompressible, core::PressureSolver::kPositionBased}) {
    const auto [left, right] = after(solver, -1.0f);
    EXPECT_NEAR(left, -1.0, 1e-5);
    EXPECT_NEAR(right, 1.0, 1e-5);
  }
}

TEST_F(Solver, PairForcesCancel) {
  core::Scene scene = smallScene(900);
  scene.wave.reset();
  scene.coupling.reset();
  scene.foam.reset();
  scene.gravity_mps2 = 0.0;
  scene.particles->box_side_m = 8.0;
  scene.fixed_substeps_count = 1;
  scene.allow_unstable = true;
  scene.tick_rate_hz = 240;
  WaterSim& sim = make(scene);
  StateCopy state = study::stirredState(sim);
  // Far above the floor, so that the floor adds nothing.
  for (std::size_t i = 1; i < state.position.size(); i += 4)
    state.position[i] = std::min(state.position[i] + 2.2f, 2.9f);
  sim.setState(state);
  double before[3] = {0, 0, 0};
  for (std::size_t i = 0; i < state.velocity.size(); ++i) {
    if (i % 4 < 3) before[i % 4] += state.velocity[i];
  }
  sim.step();
  const StateCopy after = sim.copyState();
  double change[3] = {-before[0], -before[1], -before[2]};
  double size = 0.0;
  for (std::size_t i = 0; i < after.velocity.size(); ++i) {
    if (i % 4 < 3) {
      change[i % 4] += after.velocity[i];
      size += std::abs(after.velocity[i]);
    }
  }
  for (const double c : change) EXPECT_LE(std::abs(c), 1e-5 * size);
}

}  // namespace
}  // namespace spindrift::sim
