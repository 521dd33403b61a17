// The sweeps: steps in units of their bound, stiffness, viscosity, count, Courant number, depth, amplitude, cells,
// patch size, commands.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include <fmt/format.h>

#include <spindrift/study/stability.h>

#include "particle_choices.h"
#include "wave_modes.h"

namespace spindrift::study {
namespace {

using core::PressureSolver;
using core::Stencil;

/// The motion of a settled column is a hundredth of the energy of its weight; above this share it is not at rest.
constexpr double kBoilingShare = 0.05;
/// The same after a splash: more energy than the splash can have added.
constexpr double kMovingShare = 0.4;
/// Water compressed by a quarter is not at rest either.
constexpr double kSqueezed = 1.25;
/// A wave's energy should not grow after its start; the factor two allows for energy that still arrives after half a
/// second.
constexpr double kGrowingWave = 2.0;

/// Water at rest in a periodic box: about `count` particles in 10 layers.
core::Scene box(std::uint32_t count) {
  core::Scene scene;
  scene.name = "box";
  scene.particles.emplace();
  core::ParticleScene& p = *scene.particles;
  p.count = count;
  p.layers_count = 10;
  p.box_side_m = 1.0;
  p.headroom_m = 1.0;
  p.max_speed_mps = 4.0;
  p.sound_speed_mps = 20.0;
  p.viscosity_pas = 5.0;
  p.boundary_x = p.boundary_z = core::Boundary::kPeriodic;
  return scene;
}

/// The scene with one substep per tick of `factor` times the tightest bound of its rules.
core::Scene withStep(core::Scene scene, double factor) {
  scene.allow_unstable = true;
  scene.fixed_substeps_count = 1;
  const auto derived = sim::derive(scene);
  if (derived && !derived->rules.empty()) scene.tick_rate_hz = 1.0 / (factor * derived->rules.front().max_dt_s);
  return scene;
}

std::vector<double> pick(bool quick, std::vector<double> few, std::vector<double> many) {
  return quick ? std::move(few) : std::move(many);
}

constexpr double kQuickSecondsAfter = 1.0;

void addSteps(bool quick, std::vector<Sweep>& sweeps) {
  const std::vector<double> factors = pick(quick, {0.75, 1, 1.5, 4}, {0.5, 0.75, 1, 1.25, 1.5, 1.75, 2, 2.5, 3, 4});
  for (const PressureSolver solver : kSolvers) {
    for (const core::KernelSet set : kKernelSets) {
      if (quick && set != core::KernelSet::kWendlandC2) continue;
      sweeps.push_back({fmt::format("step, {}, {}", nameOf(solver), nameOf(set)), "bounds", factors, 1.0,
                        [=](double factor) {
                          core::Scene scene = box(1000);
                          scene.particles->solver = solver;
                          scene.particles->kernel_set = set;
                          return withStep(scene, factor);
                        },
                        [](sim::WaterSim& water, double) {
                          (void)water.start(core::Splash{0, 0, 0.3, 0.4, 0.1});
                        },
                        quick ? 2.0 : 3.0, kMovingShare, kSqueezed});
    }
  }
  sweeps.push_back({"step of thick water (1,000 Pa s)",
                    "bounds",
                    factors,
                    1.0,
                    [](double factor) {
                      core::Scene scene = box(1000);
                      scene.particles->viscosity_pas = 1000.0;
                      scene.particles->sound_speed_mps = 5.0;
                      scene.particles->max_speed_mps = 1.0;
                      return withStep(scene, factor);
                    },
                    {},
                    quick ? 2.0 : 3.0,
                    kBoilingShare});
}

/// 12 m of breaking water with spray.
core::Scene twoWayWater(std::uint32_t resolution_count) {
  core::Scene scene;
  scene.name = "two_way";
  scene.wave.emplace();
  scene.wave->resolution_count = resolution_count;
  scene.wave->side_m = 12.0;
  scene.particles.emplace();
  scene.particles->count = 6000;
  scene.coupling.emplace();
  scene.coupling->mode = core::CouplingMode::kTwoWay;
  return scene;
}

void addWaves(bool quick, std::vector<Sweep>& sweeps) {
  for (const Stencil stencil : {Stencil::kFivePoint, Stencil::kNinePoint}) {
    for (const core::WaveBoundary side : {core::WaveBoundary::kReflect, core::WaveBoundary::kAbsorb}) {
      const bool nine = stencil == Stencil::kNinePoint;
      const bool absorbs = side == core::WaveBoundary::kAbsorb;
      // The bound for open water also holds in a sponge, however strong: here the sponge takes more than half of a wave
      // per step.
      sweeps.push_back({fmt::format("Courant number, {}-point{}", nine ? 9 : 5, absorbs ? ", absorbing sides" : ""), "",
                        pick(quick, {0.1, 0.5, 0.7, 0.75, 0.85, 0.9, 1.2},
                             {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.72, 0.75, 0.8, 0.85, 0.87, 0.9, 1.0, 1.1, 1.2}),
                        nine ? std::sqrt(3.0) / 2 : std::numbers::sqrt2 / 2,
                        [=](double courant) {
                          core::Scene scene = waveScene(64, 8.0, 1.5, courant, stencil, side);
                          scene.wave->fixed_substeps_count = 1;
                          scene.wave->sponge_width_m = 0.5;
                          scene.wave->absorption = core::Absorption::kSponge;
                          scene.allow_unstable = true;
                          return scene;
                        },
                        [](sim::WaterSim& water, double) {
                          (void)water.start(core::Splash{0.5, 0.3, 1.0, 0.2, 0.1});
                        },
                        5.0, kGrowingWave});
      sweeps.back().stable_elevation_m = 0.3;
    }
  }
  sweeps.push_back({"depth", "m", pick(quick, {0.05, 1, 100}, {0.05, 0.2, 1, 5, 20, 100}), std::nullopt,
                    [](double depth_m) {
                      core::Scene scene;
                      scene.name = "depth";
                      scene.wave.emplace();
                      scene.wave->resolution_count = 64;
                      scene.wave->side_m = 16.0;
                      scene.wave->depth_m = depth_m;
                      return scene;
                    },
                    [](sim::WaterSim& water, double depth_m) {
                      (void)water.start(core::Splash{0.5, 0.3, 1.5, std::min(0.9 * depth_m, 10.0), 0.2});
                    },
                    5.0, kGrowingWave});
  sweeps.push_back({"splash in two-way water", "depths", pick(quick, {0.1, 0.9}, {0.1, 0.3, 0.6, 0.9}), std::nullopt,
                    [](double) { return twoWayWater(96); },
                    [](sim::WaterSim& water, double share) {
                      (void)water.start(core::Splash{0.5, 0.3, 1.5, share * 1.5, 0.05});
                    },
                    4.0, kGrowingWave});
  sweeps.push_back({"wave in two-way water", "depths", pick(quick, {3}, {0.1, 0.3, 1, 3, 10}), std::nullopt,
                    [](double) {
                      core::Scene scene = twoWayWater(96);
                      scene.wave->steepening_ratio = 1.0;
                      scene.wave->boundary_minus_x = scene.wave->boundary_plus_x = core::WaveBoundary::kReflect;
                      return scene;
                    },
                    [](sim::WaterSim& water, double share) {
                      core::BreakingWave wave;
                      wave.amplitude_m = share * 1.5;
                      wave.duration_s = 0.3;  // ends before its energy is first measured
                      (void)water.start(wave);
                    },
                    4.0, kGrowingWave});
  sweeps.push_back({"cells of two-way water, drops of 0.1 m", "",
                    pick(quick, {48, 288}, {48, 96, 192, 288, 384, 576, 768}), std::nullopt,
                    [](double cells) { return twoWayWater(static_cast<std::uint32_t>(cells)); },
                    [](sim::WaterSim& water, double) {
                      (void)water.start(core::Splash{0.5, 0.3, 1.5, 1.2, 0.2});
                    },
                    quick ? 1.5 : 4.0, kGrowingWave});
}

/// Sends a random command out of all that clients may send, including refused ones.
void command(sim::WaterSim& water, std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(random);
  };
  switch (random() % 6) {
    case 0:
      (void)water.start(
          core::Splash{between(-6, 6), between(-6, 6), between(0.05, 4), between(0.01, 3), between(0.02, 1)});
      break;
    case 1: {
      core::BreakingWave wave;
      wave.side = static_cast<core::Side>(random() % 5);
      wave.direction_deg = between(-180, 180);
      wave.amplitude_m = between(0.01, 3);
      wave.length_m = between(0.3, 8);
      (void)water.start(wave);
      break;
    }
    case 2: {
      core::Boat boat;
      boat.x_m = between(-5, 5);
      boat.z_m = between(-5, 5);
      boat.heading_deg = between(-180, 180);
      (void)water.spawnBoat(boat);
      break;
    }
    case 3:
      (void)water.controlBoat(static_cast<std::uint32_t>(1 + random() % 32), between(-1, 1), between(-1, 1));
      break;
    case 4:
      (void)water.removeBoat(static_cast<std::uint32_t>(1 + random() % 32));
      break;
    default: {
      core::Scene scene = water.scene();
      scene.gravity_mps2 = between(0, 50);
      scene.wave->depth_m = between(0.3, 10);
      scene.wave->damping_per_s = between(0, 5);
      scene.wave->steepening_ratio = between(0, 1);
      scene.particles->viscosity_pas = between(0, 100);
      scene.storm->level_ratio = between(0, 1);
      (void)water.setScene(scene);
    }
  }
}

void addCommands(bool quick, std::vector<Sweep>& sweeps) {
  const auto random = std::make_shared<std::mt19937>(1);
  sweeps.push_back({"commands of every kind",
                    "a tick",
                    pick(quick, {1, 30}, {1, 10, 100, 1000}),
                    std::nullopt,
                    [](double) {
                      core::Scene scene = twoWayWater(96);
                      scene.wave->steepening_ratio = 0.5;
                      scene.boats.emplace();
                      scene.storm.emplace();
                      return scene;
                    },
                    {},
                    quick ? 1.0 : 10.0,
                    1e9,
                    1e9,
                    [random](sim::WaterSim& water, double count, int) {
                      for (int i = 0; i < static_cast<int>(count); ++i) command(water, *random);
                    }});
}

void addParticles(bool quick, std::vector<Sweep>& sweeps) {
  sweeps.push_back({"sound speed, the rules' own steps",
                    "m/s",
                    pick(quick, {5, 100}, {3, 5, 10, 20, 50, 100}),
                    std::nullopt,
                    [](double sound_mps) {
                      core::Scene scene = box(1000);
                      scene.particles->sound_speed_mps = sound_mps;
                      return scene;
                    },
                    {},
                    2.0,
                    kBoilingShare});
  sweeps.push_back({"viscosity, the rules' own steps",
                    "Pa s",
                    pick(quick, {0, 1000}, {0, 1, 10, 100, 1000}),
                    std::nullopt,
                    [](double viscosity_pas) {
                      core::Scene scene = box(1000);
                      scene.particles->viscosity_pas = viscosity_pas;
                      return scene;
                    },
                    {},
                    2.0,
                    kBoilingShare});
  sweeps.push_back({"particles",
                    "",
                    pick(quick, {1, 10, 1000}, {1, 2, 10, 100, 1000, 10'000, 65'536}),
                    std::nullopt,
                    [](double count) {
                      core::Scene scene = box(static_cast<std::uint32_t>(count));
                      scene.particles->boundary_x = scene.particles->boundary_z = core::Boundary::kWall;
                      scene.particles->layers_count = std::clamp(std::cbrt(count), 1.0, 16.0);
                      scene.particles->solver = PressureSolver::kPositionBased;
                      return scene;
                    },
                    {},
                    1.0,
                    kBoilingShare});
  if (!quick) {
    sweeps.push_back({"particles, up to the capacity",
                      "",
                      {262'144, 1'048'576},
                      std::nullopt,
                      [](double count) {
                        core::Scene scene = box(static_cast<std::uint32_t>(count));
                        scene.particles->layers_count = 32;
                        scene.particles->box_side_m = 10.0;
                        scene.particles->headroom_m = 3.0;
                        return scene;
                      },
                      {},
                      0.1,
                      kBoilingShare,
                      1e9,
                      {},
                      0.1});
  }
  sweeps.push_back({"patch on the pool", "of its side", pick(quick, {0.2, 1}, {0.1, 0.2, 0.5, 0.8, 1}), std::nullopt,
                    [](double scale) {
                      core::Scene scene;
                      scene.name = "patch";
                      scene.wave.emplace();
                      scene.wave->resolution_count = 64;
                      scene.particles.emplace();
                      scene.particles->count = 3000;
                      scene.particles->layers_count = 3;
                      scene.particles->patch_scale = scale;
                      scene.coupling.emplace();
                      return scene;
                    },
                    [](sim::WaterSim& water, double) {
                      (void)water.start(core::Splash{0, 0, 2.0, 1.0, 0.2});
                    },
                    3.0, 1e9});
}

}  // namespace

std::vector<Sweep> stabilitySweeps(bool quick) {
  std::vector<Sweep> sweeps;
  addSteps(quick, sweeps);
  addWaves(quick, sweeps);
  addParticles(quick, sweeps);
  addCommands(quick, sweeps);
  if (quick) {
    for (Sweep& sweep : sweeps) sweep.seconds_after = std::min(sweep.seconds_after, kQuickSecondsAfter);
  }
  return sweeps;
}

}  // namespace spindrift::study
