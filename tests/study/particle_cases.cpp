// Particles at rest.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <spindrift/sim/water_sim.h>

#include "cases.h"
#include "particle_choices.h"
#include "ticks.h"

namespace spindrift::study {
namespace {

using core::Boundary;

double rootMeanSquareSpeed(const sim::WaterSim& water) {
  return std::sqrt(2 * water.health().kinetic_energy_j / (water.derived().particles->mass_kg * water.particleCount()));
}

/// A column of 14 x 20 x 14 particles, 2 m of water.
core::Scene column(Boundary sides) {
  core::Scene scene;
  scene.name = "column";
  scene.particles.emplace();
  core::ParticleScene& p = *scene.particles;
  p.count = 3920;
  p.layers_count = 20;
  p.box_side_m = 1.4;
  p.headroom_m = 1.0;
  p.sound_speed_mps = 40.0;
  p.max_speed_mps = 6.0;
  p.viscosity_pas = 10.0;
  p.boundary_x = p.boundary_z = sides;
  return scene;
}

}  // namespace

Outcome stillWater(gpu::Context& ctx, bool quick) {
  core::Scene scene;
  scene.name = "still";
  scene.wave.emplace();
  scene.particles.emplace();
  scene.particles->count = 8192;
  scene.particles->layers_count = 3;
  scene.particles->settle_s = 6.0;
  scene.coupling.emplace();
  auto water = sim::WaterSim::create(ctx, scene);
  if (!water) return water.error();
  const double seconds = quick ? 3.0 : 60.0;
  const sim::StateCopy before = (*water)->copyState();
  double fastest_mps = 0.0;
  double highest_m = 0.0;
  const auto watch = [&] {
    fastest_mps = std::max(fastest_mps, rootMeanSquareSpeed(**water));
    highest_m = std::max(highest_m, (*water)->health().max_elevation_m);
  };
  if (auto done = runTo(**water, seconds, watch); !done) return done.error();
  const sim::StateCopy after = (*water)->copyState();
  double drift_m = 0.0;
  for (std::size_t i = 1; i < after.position.size(); i += 4) drift_m += after.position[i] - before.position[i];
  drift_m /= static_cast<double>((*water)->particleCount());
  const std::string name = fmt::format("8,112 particles on a level wave, {:.0f} s: ", seconds);
  // Floor speed: a ninth of the particles' spacing of 0.46 m per second.
  return CaseResult{
      std::vector<Row>{{name + "largest speed (root mean square)", "m/s", fastest_mps, 0.05, Tolerance::kAtMost, 0.0,
                        "nothing moves"},
                       {name + "elevation", "m", highest_m, 0.0, Tolerance::kAtMost, 0.0, "nothing moves"},
                       {name + "drift in height", "m", drift_m, 0.0, Tolerance::kAbsolute, 0.01, "nothing moves"}},
      {}};
}

Outcome hydrostaticColumn(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const Boundary sides : {Boundary::kPeriodic, Boundary::kWall}) {
    for (const core::KernelSet set : kKernelSets) {
      // The quick table uses the default kernel set between walls.
      if (quick && (set != core::KernelSet::kWendlandC2 || sides != Boundary::kWall)) continue;
      core::Scene scene = column(sides);
      scene.particles->kernel_set = set;
      auto made = sim::WaterSim::create(ctx, scene);
      if (!made) return made.error();
      sim::WaterSim& water = **made;
      const sim::ParticleLayout& l = *water.derived().particles;
      // Slices are as thick as the support radius, the smallest length that SPH resolves; mean of the last two seconds.
      const auto slices = static_cast<std::size_t>(l.layers_count * l.spacing_m / l.support_radius_m);
      std::vector<double> pressure_pa(slices + 1), height_m(slices + 1), count(slices + 1);
      const int tick_count = quick ? 330 : 1200;
      for (int ticks_done = 0; ticks_done < tick_count; ++ticks_done) {
        if (auto done = tick(water); !done) return done.error();
        if (ticks_done < tick_count - 120 || ticks_done % 6) continue;
        const sim::StateCopy state = water.copyState();
        for (std::size_t i = 0; i < l.count; ++i) {
          const double y_m = state.position[4 * i + 1] + l.band_m;
          const auto k = std::min(static_cast<std::size_t>(std::max(y_m / l.support_radius_m, 0.0)), slices);
          pressure_pa[k] += std::pow(scene.particles->sound_speed_mps, 2) * (state.density_kgpm3[i] - 1000.0);
          height_m[k] += y_m;
          count[k] += 1;
        }
      }
      const double depth_m = l.layers_count * l.spacing_m;
      double worst = 0.0;
      for (std::size_t k = 0; k < slices / 2; ++k) {
        const double expected_pa = 1000.0 * scene.gravity_mps2 * (depth_m - height_m[k] / count[k]);
        worst = std::max(worst, std::abs(pressure_pa[k] / count[k] / expected_pa - 1));
      }
      const std::string name =
          fmt::format("{}, {} sides: ", nameOf(set), sides == Boundary::kWall ? "walls at the" : "periodic");
      rows.push_back({name + "worst pressure in the lower half, slices of H", "%", 100 * worst, 5.0, Tolerance::kAtMost,
                      0.0, "p = rho0 g depth"});
      const double c2 = std::pow(scene.particles->sound_speed_mps, 2);
      rows.push_back({name + "density at the bottom over rho0", "", 1.0 + pressure_pa[0] / count[0] / c2 / 1000.0,
                      1.0 + scene.gravity_mps2 * depth_m / c2, Tolerance::kAtMost, 0.0,
                      "1 + g d / c0^2, the stated compressibility"});
    }
  }
  return CaseResult{std::move(rows), {}};
}

}  // namespace spindrift::study
