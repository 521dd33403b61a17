// The variants of particle scenes, in motion: both solvers, walls, dams, foam, and another number of particles in a
// running room.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <spindrift/sim_setup/lattice.h>

#include "sim_fixture.h"

namespace spindrift::sim {
namespace {

using core::Boundary;
using core::PressureSolver;

/// Particles alone, in a box with walls or periodic sides.
core::Scene boxScene(std::uint32_t count, double layers, Boundary boundary) {
  core::Scene scene = smallScene(count);
  scene.wave.reset();
  scene.coupling.reset();
  scene.particles->layers_count = layers;
  scene.particles->box_side_m = 3.0;
  scene.particles->boundary_x = scene.particles->boundary_z = boundary;
  return scene;
}

double kineticEnergy(const StateCopy& state, double mass_kg) {
  double sum = 0;
  for (std::size_t i = 0; i < state.velocity.size(); ++i) {
    if (i % 4 < 3) sum += 0.5 * mass_kg * state.velocity[i] * state.velocity[i];
  }
  return sum;
}

double fastest(const StateCopy& state) {
  double speed = 0;
  for (std::size_t i = 0; i < state.velocity.size(); i += 4)
    speed = std::max<double>(speed, std::hypot(state.velocity[i], state.velocity[i + 1], state.velocity[i + 2]));
  return speed;
}

bool isFinite(const StateCopy& state) {
  const auto finite = [](float value) { return std::isfinite(value); };
  return std::ranges::all_of(state.position, finite) && std::ranges::all_of(state.velocity, finite) &&
         std::ranges::all_of(state.density_kgpm3, finite);
}

class Variants : public OnDevice {};

TEST_F(Variants, StillPoolsStayStillWithBothSolversBetweenWallsAndPeriodicSides) {
  for (const auto solver : {PressureSolver::kWeaklyCompressible, PressureSolver::kPositionBased}) {
    for (const auto boundary : {Boundary::kWall, Boundary::kPeriodic}) {
      core::Scene scene = boxScene(900, 4, boundary);
      scene.particles->solver = solver;
      WaterSim& sim = make(scene);
      double worst = 0;
      for (int i = 0; i < 300; ++i) {
        sim.step();
        worst = std::max(worst, sim.health().kinetic_energy_j);
      }
      const double mass = sim.derived().particles->mass_kg * sim.derived().particles->count;
      const auto rms = [&](double energy_j) { return std::sqrt(2 * energy_j / mass); };
      EXPECT_LE(rms(worst), 0.3);
      EXPECT_LE(rms(sim.health().kinetic_energy_j), 0.05);
      EXPECT_EQ(sim.recoveredCount(), 0u);
    }
  }
}

TEST_F(Variants, ASettledColumnHasThePressureOfItsDepthFromTheFloorUp) {
  for (const auto equation : {core::EquationOfState::kLinear, core::EquationOfState::kTait}) {
    core::Scene scene = boxScene(10 * 14 * 14, 10, Boundary::kWall);
    core::ParticleScene& p = *scene.particles;
    p.box_side_m = 1.4;
    p.headroom_m = 1.0;
    p.sound_speed_mps = 30.0;
    p.max_speed_mps = 5.0;
    p.viscosity_pas = 10.0;
    p.equation_of_state = equation;
    WaterSim& sim = make(scene);
    const ParticleLayout& l = *sim.derived().particles;
    // In slices as thick as a support radius, the smallest length that SPH resolves; mean of a second after the lattice
    // has lost its order.
    struct Mean {
      double p = 0, y = 0, n = 0;
    };
    const auto slices = static_cast<std::size_t>(l.layers_count * l.spacing_m / l.support_radius_m);
    std::vector<Mean> inside(slices + 1);
    std::vector<Mean> all(slices + 1);
    for (int tick = 0; tick < 480; ++tick) {
      sim.step();
      if (tick < 420 || tick % 10) continue;
      const StateCopy state = sim.copyState();
      for (std::size_t i = 0; i < l.count; ++i) {
        const float* x = &state.position[4 * i];
        const double y = x[1] + l.band_m;
        const auto slice = std::min(static_cast<std::size_t>(std::max(y / l.support_radius_m, 0.0)), slices);
        const double gap = std::min({x[0] - l.min_m[0], l.max_m[0] - x[0], x[2] - l.min_m[2], l.max_m[2] - x[2]});
        for (Mean* m : {&all[slice], gap > 2 * l.spacing_m ? &inside[slice] : nullptr}) {
          if (!m) continue;
          m->p += std::max(pressureOf(equation, 900.0, 1000.0, state.density_kgpm3[i]), 0.0);
          m->y += y;
          m->n += 1;
        }
      }
    }
    const double bottom_pa = 1000.0 * scene.gravity_mps2 * l.spacing_m * l.layers_count;
    for (const auto& [means, where] : {std::pair(inside, "inside"), std::pair(all, "walls included")}) {
      for (std::size_t k = 0; k + 1 < slices; ++k) {
        const double expected_pa = bottom_pa - 1000.0 * scene.gravity_mps2 * means[k].y / means[k].n;
        // Near the surface, where the pressure is small, the tolerance is 4 % of that at the bottom.
        EXPECT_NEAR(means[k].p / means[k].n, expected_pa, std::max(0.05 * expected_pa, 0.04 * bottom_pa))
            << "at " << means[k].y / means[k].n / l.spacing_m << " spacings over the floor, " << where;
      }
    }
  }
}

TEST_F(Variants, ADamBreakReachesTheEndOfTheBoxWithBothSolvers) {
  for (const auto solver : {PressureSolver::kWeaklyCompressible, PressureSolver::kPositionBased}) {
    core::Scene scene = boxScene(2000, 14, Boundary::kWall);
    scene.particles->solver = solver;
    scene.particles->box_side_m = 4.0;
    scene.particles->box_width_m = 1.0;
    scene.particles->fill_x_ratio = 0.25;
    scene.particles->sound_speed_mps = 30.0;
    scene.particles->viscosity_pas = 5.0;
    WaterSim& sim = make(scene);
    const ParticleLayout& l = *sim.derived().particles;
    const double energy_j = l.mass_kg * l.count * scene.gravity_mps2 * 0.5 * l.band_m;
    double reached = l.min_m[0];
    double speed = 0;
    double energy = 0;
    double density = 0;
    for (int i = 0; i < 180; ++i) {
      sim.step();
      if (i % 10) continue;
      const StateCopy state = sim.copyState();
      ASSERT_TRUE(isFinite(state));
      for (std::size_t k = 0; k < state.position.size(); k += 4) reached = std::max<double>(reached, state.position[k]);
      speed = std::max(speed, fastest(state));
      energy = std::max(energy, kineticEnergy(state, l.mass_kg));
      density = std::max(density, sim.health().mean_density_ratio);
    }
    EXPECT_GT(reached, l.max_m[0] - 0.2) << "the front reaches the far wall";
    EXPECT_LE(energy, energy_j) << "no more motion than the fall can give";
    EXPECT_LE(density, 1.1);
    EXPECT_EQ(sim.nonfiniteCount() + sim.escapedCount(), 0u);
  }
}

TEST_F(Variants, PositionBasedWaterTakesLargeStepsAndNamesItsRule) {
  core::Scene scene = smallScene();
  scene.particles->solver = PressureSolver::kPositionBased;
  scene.particles->sound_speed_mps = 500.0;
  const auto d = derive(scene);
  ASSERT_TRUE(d) << d.error().message;
  EXPECT_EQ(d->substeps_count, 1u);
  const auto cfl = std::ranges::find(d->rules, std::string("particle CFL, 0.4 H / U_max"), &StepRule::name);
  ASSERT_NE(cfl, d->rules.end());
  EXPECT_NEAR(cfl->max_dt_s, 0.4 * d->particles->support_radius_m / scene.particles->max_speed_mps, 1e-12);
}

TEST_F(Variants, EachSolverCompilesItsOwnProgramsOnly) {
  const auto programs = [&](PressureSolver solver) {
    core::Scene scene = boxScene(400, 3, Boundary::kWall);
    scene.particles->solver = solver;
    sim_.reset();
    const auto before = ctx_->ledger().program_count;
    make(scene);
    return ctx_->ledger().program_count - before;
  };
  EXPECT_EQ(programs(PressureSolver::kWeaklyCompressible), 11u);
  EXPECT_EQ(programs(PressureSolver::kPositionBased), 13u);
}

TEST_F(Variants, SprayWithFewNeighboursIsFoam) {
  core::Scene scene = boxScene(400, 3, Boundary::kPeriodic);
  scene.foam->density_deficit_ratio = 10.0;  // never reached
  for (const auto solver : {PressureSolver::kWeaklyCompressible, PressureSolver::kPositionBased}) {
    for (const std::uint32_t neighbours : {0u, 6u}) {
      scene.particles->solver = solver;
      scene.foam->neighbours_count = neighbours;
      WaterSim& sim = make(scene);
      StateCopy state = sim.copyState();
      state.position[1] = 2.0f;
      sim.setState(state);
      sim.step();
      const StateCopy after = sim.copyState();
      for (std::size_t i = 0; i < after.velocity.size(); i += 4)
        EXPECT_EQ(after.velocity[i + 3], after.position[i + 1] > 1.0f && neighbours ? 1.0f : 0.0f);
    }
  }
}

TEST_F(Variants, AnotherNumberOfParticlesKeepsWaterAndMotion) {
  core::Scene scene = smallScene(1500);
  WaterSim& sim = make(scene);
  ASSERT_TRUE(sim.start(core::Splash{0, 0, 1.2, 0.7, 0.2}));
  for (int i = 0; i < 30; ++i) sim.step();
  const auto programs = ctx_->ledger().programs_made_count;
  const double mass_0 = sim.derived().particles->mass_kg * sim.derived().particles->count;
  for (const std::uint32_t count : {4100u, 700u, 2900u, 1500u}) {
    const StateCopy before = sim.copyState();
    const double speed = fastest(before);
    const double energy = kineticEnergy(before, sim.derived().particles->mass_kg);
    const auto tick = sim.tick();
    scene.particles->count = count;
    const auto accepted = sim.setScene(scene);
    ASSERT_TRUE(accepted) << accepted.error().message;
    EXPECT_EQ(sim.tick(), tick);
    const ParticleLayout& l = *sim.derived().particles;
    EXPECT_NEAR(l.count, count, 0.25 * count);
    EXPECT_NEAR(l.mass_kg * l.count, mass_0, 0.25 * mass_0) << "whole layers";
    const StateCopy relaid = sim.copyState();
    ASSERT_TRUE(isFinite(relaid));
    EXPECT_LE(fastest(relaid), 1.001 * speed);
    double later = 0;
    double faster = 0;
    for (int i = 0; i < 40; ++i) {
      sim.step();
      if (i % 4 == 3) {
        const StateCopy now = sim.copyState();
        ASSERT_TRUE(isFinite(now));
        later = std::max(later, kineticEnergy(now, l.mass_kg));
        faster = std::max(faster, fastest(now));
      }
    }
    EXPECT_LE(later, 3 * energy + 0.5 * mass_0 * 0.3 * 0.3);
    EXPECT_LE(faster, 2 * speed + 1.5);
    const auto view = [&] {
      EXPECT_TRUE(sim.requestFrame(FrameRequest::full({.surface = true, .particles = true})));
      ctx_->finish();
      return sim.takeFrames();
    }();
    ASSERT_EQ(view.size(), 1u);
    EXPECT_EQ(view.front().at(core::Level::kFull).particles->words.size(), 3u * l.count);
  }
  EXPECT_EQ(ctx_->ledger().programs_made_count, programs) << "nothing was compiled again";
  EXPECT_EQ(sim.recoveredCount(), 0u);
  const auto restart = derive(scene);
  EXPECT_EQ(restart->particles->layers_count, sim.derived().particles->layers_count) << "back to the first lattice";
}

TEST_F(Variants, SixtyFiveThousandParticlesWork) {
  core::Scene scene = smallScene(1500);
  WaterSim& sim = make(scene);
  sim.step();
  const auto bytes_before = sim.derived().device_bytes;
  scene.particles->count = 65536;
  const auto accepted = sim.setScene(scene);
  ASSERT_TRUE(accepted) << accepted.error().message;
  EXPECT_NEAR(sim.derived().particles->count, 65536.0, 0.1 * 65536);
  EXPECT_GT(sim.derived().device_bytes, 20 * bytes_before);
  for (int i = 0; i < 4; ++i) sim.step();
  const StateCopy state = sim.copyState();
  EXPECT_EQ(state.position.size(), 4u * sim.derived().particles->count);
  EXPECT_TRUE(isFinite(state));
  EXPECT_LE(fastest(state), 1.0) << "still water";
}

/// All combinations of defines: every coupling on every ground, with boats and foam or without.
TEST_F(Variants, EveryMixOfPartsRuns) {
  enum class Ground { kPeriodic, kSponge, kRockAndBeach };
  for (const auto mode : {core::CouplingMode::kOneWay, core::CouplingMode::kTwoWay}) {
    for (const Ground ground : {Ground::kPeriodic, Ground::kSponge, Ground::kRockAndBeach}) {
      for (const bool has_boats : {false, true}) {
        const bool has_foam = has_boats != (ground == Ground::kPeriodic);
        core::Scene scene = smallScene();
        scene.coupling->mode = mode;
        if (ground == Ground::kSponge) setBoundaries(*scene.wave, core::WaveBoundary::kAbsorb);
        if (ground == Ground::kRockAndBeach) {
          setBoundaries(*scene.wave, core::WaveBoundary::kReflect);
          scene.wave->steepening_ratio = 0.5;
          scene.obstacles.emplace_back(core::Rock{.x_m = 2.0, .z_m = 2.0, .radius_m = 0.8, .height_m = 0.5});
          scene.beaches.push_back({.side = core::Side::kMinusX, .width_m = 2.0, .shore_depth_m = 0.0});
        }
        if (has_boats) scene.boats.emplace().boats.emplace_back();
        scene.foam.reset();
        if (has_foam) scene.foam.emplace().surface = ground == Ground::kSponge;
        SCOPED_TRACE(fmt::format("two-way {}, ground {}, boats {}, foam {}", mode == core::CouplingMode::kTwoWay,
                                 static_cast<int>(ground), has_boats, has_foam));
        auto sim = WaterSim::create(*ctx_, scene);
        ASSERT_TRUE(sim) << sim.error().message;
        ASSERT_TRUE((*sim)->start(core::Splash{0.0, 0.0, 1.0, 0.5, 0.1}));
        for (int i = 0; i < 20; ++i) {
          (*sim)->step();
          (void)(*sim)->requestFrame(FrameRequest::allLayers());
          (void)(*sim)->takeFrames();
        }
        EXPECT_TRUE(isFinite((*sim)->copyState()));
        EXPECT_EQ((*sim)->recoveredCount(), 0u);
      }
    }
  }
}

}  // namespace
}  // namespace spindrift::sim
