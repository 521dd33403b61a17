// Compares one step on the device with the same step in double precision over all pairs of particles.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <spindrift/study/step_comparison.h>
#include <spindrift/study/water_reference.h>

#include "cases.h"
#include "particle_choices.h"
#include "ticks.h"
#include "wave_modes.h"

namespace spindrift::study {
namespace {

/// About `count` particles between walls on a flat floor, or on a small wave.
core::Scene smallWater(std::uint32_t count, bool coupled) {
  core::Scene scene;
  scene.name = "small";
  scene.particles.emplace();
  core::ParticleScene& p = *scene.particles;
  p.count = count;
  p.headroom_m = 3.0;
  p.viscosity_pas = 100.0;
  if (coupled) {
    scene.wave.emplace();
    scene.wave->resolution_count = 32;
    scene.wave->side_m = 8.0;
    scene.coupling.emplace();
  } else {
    p.box_side_m = 4.0;
    p.layers_count = 5;
    p.boundary_x = p.boundary_z = core::Boundary::kWall;
  }
  return scene;
}

core::Result<Row> waveStep(gpu::Context& ctx, core::Stencil stencil) {
  const core::Scene scene = waveScene(96, 12.0, 1.5, 0.5, stencil, core::WaveBoundary::kReflect);
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  setSurface(**water, [](double x, double z) { return 0.3 * std::sin(1.3 * x) * std::cos(0.7 * z) + 0.1 * x; });
  const std::vector<double> before = (*water)->copyState().elevation_m;
  if (auto done = tick(**water); !done) return done.error();
  const std::vector<double> now = (*water)->copyState().elevation_m;
  if (auto done = tick(**water); !done) return done.error();
  const std::vector<double> after = (*water)->copyState().elevation_m;
  const std::vector<double> reference = referenceWaveStep(scene, (*water)->derived(), now, before);
  double worst_m = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) worst_m = std::max(worst_m, std::abs(after[i] - reference[i]));
  return Row{fmt::format("wave, {}, 96 x 96 cells: largest error of the elevation",
                         stencil == core::Stencil::kNinePoint ? "9-point" : "5-point"),
             "m",
             worst_m,
             1e-6,
             Tolerance::kAtMost,
             0.0,
             "leapfrog on three levels in double precision"};
}

}  // namespace

Outcome oneStep(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const core::Stencil stencil : {core::Stencil::kFivePoint, core::Stencil::kNinePoint}) {
    auto row = waveStep(ctx, stencil);
    if (!row) return row.error();
    rows.push_back(*std::move(row));
  }
  for (const core::PressureSolver solver : kSolvers) {
    for (const core::KernelSet set : kKernelSets) {
      for (const bool coupled : {true, false}) {
        // The reference of a correction supports floors at rest only.
        if (coupled && solver == core::PressureSolver::kPositionBased) continue;
        core::Scene scene = smallWater(quick ? 700 : 2100, coupled);
        scene.particles->solver = solver;
        scene.particles->kernel_set = set;
        auto water = sim::WaterSim::create(ctx, oneSubstepScene(scene));
        if (!water) return water.error();
        const auto compared = compareStep(**water);
        if (!compared) return compared.error();
        const StepErrors& errors = *compared;
        const std::string name = fmt::format("{}, {}, {}, {} particles: ", nameOf(solver), nameOf(set),
                                             coupled ? "on a wave" : "between walls", (*water)->particleCount());
        const std::string source =
            fmt::format("double precision, every pair; {} particles away from floor and sides", errors.compared_count);
        rows.push_back({name + "density, largest relative error", "", errors.density_ratio, 1e-5, Tolerance::kAtMost,
                        0.0, source});
        rows.push_back({name + (solver == core::PressureSolver::kPositionBased ? "correction" : "acceleration") +
                            ", largest error over the mean",
                        "", errors.motion_ratio, 1e-4, Tolerance::kAtMost, 0.0, source});
      }
    }
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
