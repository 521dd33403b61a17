// The device's step against the double-precision reference, through the solver's public interface.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "sim_fixture.h"
#include "water_reference.h"

namespace spindrift::sim {
namespace {

using testing::ReferenceSurface;
using testing::Vec3;

/// A state of the scene's own size: the starting lattice, stirred by up to 0.3 s, with random speeds, and a wavy
/// surface.
StateCopy stirred(WaterSim& sim) {
  StateCopy state = sim.copyState();
  std::mt19937 random(7);
  const auto unit = [&] { return 2.0 * std::generate_canonical<double, 53>(random) - 1.0; };
  const ParticleLayout& l = *sim.derived().particles;
  for (std::size_t i = 0; i < state.position.size(); i += 4) {
    for (int axis = 0; axis < 3; ++axis) {
      const double moved = state.position[i + axis] + 0.3 * l.spacing_m * unit();
      state.position[i + axis] = static_cast<float>(std::clamp(moved, l.min_m[axis] + 1e-3, l.max_m[axis] - 1e-3));
      state.velocity[i + axis] = static_cast<float>(0.2 * unit());
    }
  }
  if (sim.derived().wave) {
    const int n = static_cast<int>(sim.derived().wave->resolution_count);
    for (int z = 0; z < n; ++z) {
      for (int x = 0; x < n; ++x) {
        const double k = 2 * M_PI / n;
        const auto i = static_cast<std::size_t>(x + n * z);
        state.elevation_m[i] = 0.1 * std::sin(k * x) * std::cos(2 * k * z);
        state.flow_m2ps[2 * i] = static_cast<float>(0.2 * std::sin(k * (x - 0.2)) * std::cos(2 * k * z));
        state.flow_m2ps[2 * i + 1] = static_cast<float>(0.1 * std::cos(k * x));
      }
    }
  }
  return state;
}

class Solver : public OnDevice {
 protected:
  /// Runs one substep from a stirred state and compares density and acceleration of every particle that neither met the
  /// floor nor a side in it.
  void compare(core::Scene scene) {
    scene.fixed_substeps_count = 1;
    scene.tick_rate_hz = 240;
    scene.allow_unstable = true;
    WaterSim& sim = make(scene);
    const StateCopy before = stirred(sim);
    sim.setState(before);
    sim.step();
    const StateCopy after = sim.copyState();
    const Derived& d = sim.derived();
    const std::size_t n = d.particles->count;

    std::vector<Vec3> x(n), v(n);
    for (std::size_t i = 0; i < n; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        x[i][axis] = before.position[4 * i + axis];
        v[i][axis] = before.velocity[4 * i + axis];
      }
    }
    ReferenceSurface surface;
    if (scene.coupling) surface = testing::surfaceFrom(scene, d, after.elevation_m, after.flow_m2ps);
    const auto rho = testing::referenceDensity(scene, d, surface, x);
    const auto a = testing::referenceAcceleration(scene, d, surface, x, v, rho);

    double rho_error = 0.0;
    double a_error = 0.0;
    double a_scale = 0.0;
    std::size_t compared = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const auto i = static_cast<std::size_t>(after.position[4 * k + 3]);
      rho_error = std::max(rho_error, std::abs(after.density_kgpm3[k] - rho[i]) / rho[i]);
      double moved_as_told = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        moved_as_told = std::max(
            moved_as_told, std::abs(after.position[4 * k + axis] - x[i][axis] - d.dt_s * after.velocity[4 * k + axis]));
      }
      if (moved_as_told > 1e-5) continue;  // floor, side or wrap had its say
      double error = 0.0;
      double size = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        const double measured = (static_cast<double>(after.velocity[4 * k + axis]) - v[i][axis]) / d.dt_s;
        error = std::max(error, std::abs(measured - a[i][axis]));
        size += a[i][axis] * a[i][axis];
      }
      a_scale += std::sqrt(size);
      a_error = std::max(a_error, error);
      ++compared;
    }
    ASSERT_GT(compared, n / 2);
    a_scale /= static_cast<double>(compared);
    EXPECT_LE(rho_error, 1e-5) << "largest relative density error of " << n << " particles";
    EXPECT_LE(a_error / a_scale, 1e-4) << "largest acceleration error over the mean of " << a_scale << " m/s^2";
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
  std::uint32_t count = 310;  // another size each time, none of them a multiple of the work group
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
      scene.particles->iterations_count = 1;
      scene.particles->cohesion = walls;
      scene.particles->viscosity_pas = 0.0;
      if (walls) scene.particles->boundary_x = scene.particles->boundary_z = core::Boundary::kWall;
      scene.fixed_substeps_count = 1;
      scene.tick_rate_hz = 240;
      WaterSim& sim = make(scene);
      const StateCopy before = stirred(sim);
      sim.setState(before);
      sim.step();
      const StateCopy after = sim.copyState();
      const Derived& d = sim.derived();
      const std::size_t n = d.particles->count;
      std::vector<Vec3> predicted(n);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const float gravity = axis == 1 ? static_cast<float>(d.dt_s * scene.gravity_mps2) : 0.0f;
          predicted[i][axis] =
              before.position[4 * i + axis] + static_cast<float>(d.dt_s) * (before.velocity[4 * i + axis] - gravity);
        }
      }
      const auto reference = testing::referenceProjection(scene, d, {}, predicted);
      double rho_error = 0.0;
      double error = 0.0;
      double scale = 0.0;
      std::size_t compared = 0;
      for (std::size_t k = 0; k < n; ++k) {
        const auto i = static_cast<std::size_t>(after.position[4 * k + 3]);
        bool inside = predicted[i][1] + reference.move_m[i][1] > d.particles->min_m[1] + 0.11 * d.particles->spacing_m;
        for (const std::size_t axis : {0u, 2u}) {
          for (const double at : {predicted[i][axis], predicted[i][axis] + reference.move_m[i][axis]})
            inside = inside && at > d.particles->min_m[axis] + 1e-3 && at < d.particles->max_m[axis] - 1e-3;
        }
        if (!inside) continue;
        rho_error = std::max(rho_error, std::abs(after.density_kgpm3[k] - reference.rho[i]) / reference.rho[i]);
        ++compared;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double moved = after.position[4 * k + axis] - predicted[i][axis];
          error = std::max(error, std::abs(moved - reference.move_m[i][axis]));
          scale += std::abs(reference.move_m[i][axis]);
        }
      }
      ASSERT_GT(compared, n / 2);
      scale /= static_cast<double>(compared);
      EXPECT_LE(rho_error, 1e-5);
      EXPECT_LE(error / scale, 1e-4) << "largest error of a correction over their mean of " << scale << " m";
    }
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
  StateCopy state = stirred(sim);
  // Far above the floor, so that it adds nothing.
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
