#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <spindrift/study/step_comparison.h>
#include <spindrift/study/water_reference.h>

#include "ticks.h"

namespace spindrift::study {
namespace {

double size(const Vec3& v) {
  return std::hypot(v[0], v[1], v[2]);
}

Vec3 vectorAt(const std::vector<float>& values, std::size_t i) {
  return {values[4 * i], values[4 * i + 1], values[4 * i + 2]};
}

/// Compares the computed motion of a particle with the reference.
class Comparison {
 public:
  void density(double measured, double reference) {
    errors_.density_ratio = std::max(errors_.density_ratio, std::abs(measured - reference) / reference);
  }
  void motion(const Vec3& measured, const Vec3& reference) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      largest_ = std::max(largest_, std::abs(measured[axis] - reference[axis]));
    sum_ += size(reference);
    ++errors_.compared_count;
  }
  StepErrors errors() const {
    StepErrors out = errors_;
    out.motion_ratio = largest_ / (sum_ / static_cast<double>(out.compared_count));
    return out;
  }

 private:
  StepErrors errors_;
  double largest_ = 0.0;
  double sum_ = 0.0;
};

StepErrors compareAccelerations(const core::Scene& scene, const sim::Derived& d, const sim::StateCopy& before,
                                const sim::StateCopy& after) {
  const std::size_t n = d.particles->count;
  std::vector<Vec3> x(n), v(n);
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = vectorAt(before.position, i);
    v[i] = vectorAt(before.velocity, i);
  }
  ReferenceSurface surface;
  if (scene.coupling) surface = surfaceFrom(scene, d, after.elevation_m, after.flow_m2ps);
  const auto rho = referenceDensity(scene, d, surface, x);
  const auto a = referenceAcceleration(scene, d, surface, x, v, rho);
  Comparison comparison;
  for (std::size_t k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(after.position[4 * k + 3]);
    comparison.density(after.density_kgpm3[k], rho[i]);
    const Vec3 x_after = vectorAt(after.position, k);
    const Vec3 v_after = vectorAt(after.velocity, k);
    Vec3 measured;
    double moved_otherwise = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      measured[axis] = (v_after[axis] - v[i][axis]) / d.dt_s;
      moved_otherwise = std::max(moved_otherwise, std::abs(x_after[axis] - x[i][axis] - d.dt_s * v_after[axis]));
    }
    if (moved_otherwise > 1e-5) continue;  // the floor, a side or wrapping changed it
    comparison.motion(measured, a[i]);
  }
  return comparison.errors();
}

StepErrors compareCorrections(const core::Scene& scene, const sim::Derived& d, const sim::StateCopy& before,
                              const sim::StateCopy& after) {
  const std::size_t n = d.particles->count;
  const sim::ParticleLayout& l = *d.particles;
  std::vector<Vec3> predicted(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float gravity = axis == 1 ? static_cast<float>(d.dt_s * scene.gravity_mps2) : 0.0f;
      predicted[i][axis] =
          before.position[4 * i + axis] + static_cast<float>(d.dt_s) * (before.velocity[4 * i + axis] - gravity);
    }
  }
  const auto reference = referenceProjection(scene, d, {}, predicted);
  Comparison comparison;
  for (std::size_t k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(after.position[4 * k + 3]);
    // Only particles far from the floor's hard limit and from the sides, before and after the step.
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double gap_m = axis == 1 ? 0.11 * l.spacing_m : 1e-3;
      for (const double at : {predicted[i][axis], predicted[i][axis] + reference.move_m[i][axis]})
        inside = inside && at > l.min_m[axis] + gap_m && at < l.max_m[axis] - gap_m;
    }
    if (!inside) continue;
    comparison.density(after.density_kgpm3[k], reference.rho[i]);
    Vec3 moved = vectorAt(after.position, k);
    for (std::size_t axis = 0; axis < 3; ++axis) moved[axis] -= predicted[i][axis];
    comparison.motion(moved, reference.move_m[i]);
  }
  return comparison.errors();
}

}  // namespace

core::Scene oneSubstepScene(core::Scene scene) {
  scene.fixed_substeps_count = 1;
  scene.tick_rate_hz = 240;
  scene.allow_unstable = true;
  if (scene.particles->solver == core::PressureSolver::kPositionBased) {
    scene.particles->iterations_count = 1;
    scene.particles->viscosity_pas = 0.0;
  }
  return scene;
}

sim::StateCopy stirredState(sim::WaterSim& water) {
  sim::StateCopy state = water.copyState();
  std::mt19937 random(7);
  const auto unit = [&] { return 2.0 * std::generate_canonical<double, 53>(random) - 1.0; };
  const sim::ParticleLayout& l = *water.derived().particles;
  for (std::size_t i = 0; i < state.position.size(); i += 4) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double moved = state.position[i + axis] + 0.3 * l.spacing_m * unit();
      state.position[i + axis] = static_cast<float>(std::clamp(moved, l.min_m[axis] + 1e-3, l.max_m[axis] - 1e-3));
      state.velocity[i + axis] = static_cast<float>(0.2 * unit());
    }
  }
  if (water.derived().wave) {
    const int nx = static_cast<int>(water.derived().wave->count_x);
    const int nz = static_cast<int>(water.derived().wave->count_z);
    const double k = 2 * std::numbers::pi / nx;
    for (int z = 0; z < nz; ++z) {
      for (int x = 0; x < nx; ++x) {
        const auto i = static_cast<std::size_t>(x + nx * z);
        state.elevation_m[i] = 0.1 * std::sin(k * x) * std::cos(2 * k * z);
        state.flow_m2ps[2 * i] = static_cast<float>(0.2 * std::sin(k * (x - 0.2)) * std::cos(2 * k * z));
        state.flow_m2ps[2 * i + 1] = static_cast<float>(0.1 * std::cos(k * x));
      }
    }
  }
  return state;
}

core::Result<StepErrors> compareStep(sim::WaterSim& water) {
  const sim::StateCopy before = stirredState(water);
  water.setState(before);
  if (auto done = tick(water); !done) return done.error();
  const sim::StateCopy after = water.copyState();
  const bool corrects = water.scene().particles->solver == core::PressureSolver::kPositionBased;
  return (corrects ? compareCorrections : compareAccelerations)(water.scene(), water.derived(), before, after);
}

}  // namespace spindrift::study
