// Boats: draught and wake.
#include <cmath>

#include <fmt/format.h>
#include <shared/boats.h>

#include "cases.h"
#include "ticks.h"
#include "wave_modes.h"

namespace spindrift::study {

Outcome floatingBody(gpu::Context& ctx, bool quick) {
  std::vector<Row> rows;
  for (const double density_ratio : {0.2, 0.5, 0.8}) {
    core::Scene scene;
    scene.name = "boat";
    scene.wave.emplace();
    scene.wave->resolution_count = 128;
    scene.wave->side_m = 20.0;
    scene.wave->depth_m = 1.5;
    scene.wave->damping_per_s = 1.0;
    scene.wave->setBoundaries(core::WaveBoundary::kReflect);
    scene.boats.emplace();
    scene.boats->boats = {core::Boat{.length_m = 3.0, .beam_m = 1.2, .height_m = 0.8, .density_ratio = density_ratio}};
    auto water = sim::WaterSim::create(ctx, scene);
    if (!water) return water.error();
    if (auto done = run(**water, quick ? 900 : 1800); !done) return done.error();
    const sim::StateCopy state = (*water)->copyState();
    const double keel_m = state.boats[1] - 0.4;
    // The walls keep the displaced water, so the level away from the hull is a little higher.
    const double level_m = state.elevation_m[5 + 128 * 5];
    rows.push_back({fmt::format("draught of a hull of 0.8 m at density {}", density_ratio), "m", level_m - keel_m,
                    density_ratio * 0.8, Tolerance::kRelative, 0.03, "Archimedes"});
  }
  return CaseResult{std::move(rows), {}};
}

Outcome machWedge(gpu::Context& ctx, bool /*quick*/) {
  core::Scene scene;
  scene.name = "wedge";
  scene.wave.emplace();
  scene.wave->resolution_count = 256;
  scene.wave->side_m = 40.0;
  scene.wave->depth_m = 0.4;
  scene.wave->setBoundaries(core::WaveBoundary::kReflect);
  scene.boats.emplace();
  scene.boats->boats = {core::Boat{
      .x_m = -15.0, .length_m = 1.5, .beam_m = 0.6, .height_m = 0.3, .max_speed_mps = 5.0, .throttle_ratio = 1.0}};
  auto made = sim::WaterSim::create(ctx, scene);
  if (!made) return made.error();
  sim::WaterSim& water = **made;
  if (auto done = run(water, 360); !done) return done.error();
  const sim::StateCopy state = water.copyState();
  const double x_m = state.boats[0];
  const double forward_mps = state.boats[8];
  const double cell_m = 40.0 / 256;
  // Distance from the track to the highest point of the wake's arm, this far behind the boat.
  const auto arm_m = [&](double behind_m) {
    const auto x = static_cast<std::size_t>((x_m - behind_m + 20.0) / cell_m);
    std::size_t best = 130;
    for (std::size_t z = 130; z < 250; ++z) {
      if (std::abs(state.elevation_m[x + 256 * z]) > std::abs(state.elevation_m[x + 256 * best])) best = z;
    }
    return static_cast<double>(best) * cell_m;
  };
  const double c_mps = water.derived().wave->speed_mps;
  return CaseResult{
      std::vector<Row>{{fmt::format("half angle of the wedge at {:.2f} c", forward_mps / c_mps), "rad",
                        std::atan((arm_m(9.0) - arm_m(5.0)) / 4.0), std::asin(c_mps / forward_mps),
                        Tolerance::kAbsolute, 0.12,
                        "arcsin(c/U): the wave equation has no dispersion, so no Kelvin wake; tolerance: one cell in "
                        "each of the two places"}},
      {}};
}

}  // namespace spindrift::study
