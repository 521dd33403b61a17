// What must hold however long it runs and whatever people do: the ledger, still water, ten thousand commands, where
// particles are. Each is a short form; variables of the environment make it as long as README says.
#include <cmath>
#include <random>
#include <vector>

#include <spindrift/stream/client_message.h>
#include <spindrift/stream/parameters.h>

#include "stability_scene.h"

namespace spindrift {
namespace {

/// Random values in a range, the same in every run.
class Dice {
 public:
  explicit Dice(std::uint32_t seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * std::generate_canonical<double, 53>(random_); }
  int upTo(int count) { return std::min(static_cast<int>(between(0, count)), count - 1); }

 private:
  std::mt19937 random_;
};

bool allFinite(const std::vector<float>& values) {
  for (const float value : values) {
    if (!std::isfinite(value)) return false;
  }
  return true;
}

/// Random effects, boats and parameters within what the scene allows, as people could send them.
class Crowd {
 public:
  explicit Crowd(v1::Scene scene) : scene_(std::move(scene)), parameters_(stream::describeParameters(scene_)) {
    // What decides the cost of a step, not its health, stays: the full run is about 10,000 commands, not about
    // patience.
    std::erase_if(parameters_, [](const v1::ParameterDescription& p) {
      return p.path() == "particles.count" || p.path() == "particles.sound_speed_mps" ||
             p.path() == "particles.max_speed_mps" || p.path() == "wave.depth_m" || p.path() == "gravity_mps2" ||
             p.path() == "stream.frame_rate_hz";
    });
  }

  /// Sends one command; whether the scene allowed it.
  bool send(sim::WaterSim& water) {
    const core::Action action = any(water);
    if (stream::checkAgainstScene(core::Command{1, 1, action}, scene_)) return false;
    if (const auto* splash = std::get_if<core::Splash>(&action)) return static_cast<bool>(water.start(*splash));
    if (const auto* wave = std::get_if<core::BreakingWave>(&action)) return static_cast<bool>(water.start(*wave));
    if (const auto* spawn = std::get_if<core::SpawnBoat>(&action))
      return static_cast<bool>(water.spawnBoat(spawn->boat));
    if (const auto* control = std::get_if<core::ControlBoat>(&action))
      return static_cast<bool>(water.controlBoat(control->boat_id, control->throttle_ratio, control->rudder_ratio));
    if (const auto* remove = std::get_if<core::RemoveBoat>(&action))
      return static_cast<bool>(water.removeBoat(remove->boat_id));
    if (const auto* set = std::get_if<core::SetParameter>(&action)) {
      v1::Scene changed = scene_;
      if (stream::setParameter(changed, set->path, set->value)) return false;
      if (!water.setScene(stream::toCore(changed))) return false;
      scene_ = std::move(changed);
      return true;
    }
    water.reset();
    return true;
  }

 private:
  core::Action any(const sim::WaterSim& water) {
    const double half_m = scene_.wave().side_m() / 2;
    const auto boats = water.boats();
    const int kind = dice_.upTo(1000);
    if (kind < 1) return core::Reset{};
    if (kind < 250) {
      return core::Splash{dice_.between(-half_m, half_m), dice_.between(-half_m, half_m), dice_.between(0.2, 3.0),
                          dice_.between(0.05, 1.0), dice_.between(0.05, 0.6)};
    }
    if (kind < 400) {
      return core::BreakingWave{static_cast<core::Side>(dice_.upTo(5)),
                                dice_.between(0.05, 1.0),
                                dice_.between(0.5, 8.0),
                                dice_.between(0.1, 1.0),
                                static_cast<core::WaveShape>(dice_.upTo(2)),
                                dice_.between(-180, 180)};
    }
    if (kind < 500) {
      return core::SpawnBoat{core::Boat{.x_m = dice_.between(-half_m, half_m),
                                        .z_m = dice_.between(-half_m, half_m),
                                        .heading_deg = dice_.between(-180, 180),
                                        .length_m = dice_.between(0.8, 5.0),
                                        .beam_m = dice_.between(0.3, 0.8),
                                        .height_m = dice_.between(0.2, 0.8),
                                        .density_ratio = dice_.between(0.1, 0.9),
                                        .max_speed_mps = dice_.between(1.0, 12.0)}};
    }
    if (kind < 750 && !boats.empty()) {
      return core::ControlBoat{boats[static_cast<std::size_t>(dice_.upTo(static_cast<int>(boats.size())))].boat_id,
                               dice_.between(-1, 1), dice_.between(-1, 1)};
    }
    if (kind < 800 && !boats.empty())
      return core::RemoveBoat{boats[static_cast<std::size_t>(dice_.upTo(static_cast<int>(boats.size())))].boat_id};
    const auto& parameter = parameters_[static_cast<std::size_t>(dice_.upTo(static_cast<int>(parameters_.size())))];
    double value = dice_.between(parameter.min(), parameter.max());
    if (parameter.step() >= 1) value = std::round(value);
    return core::SetParameter{parameter.path(), value};
  }

  v1::Scene scene_;
  std::vector<v1::ParameterDescription> parameters_;
  Dice dice_{20231121};
};

TEST_F(Endurance, ThousandsOfRandomCommandsLeaveAHealthyHarbor) {
  const int commands = wanted("SPINDRIFT_COMMANDS", 1500);
  const int ticks = std::max(commands * 36 / 100, 600);  // 10,000 in a minute
  const v1::Scene scene = shipped("harbor");
  sim::WaterSim& water = make(stream::toCore(scene));
  Crowd crowd(scene);
  int sent = 0;
  int accepted = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    for (; sent < static_cast<int>(static_cast<std::int64_t>(commands) * (tick + 1) / ticks); ++sent)
      accepted += crowd.send(water) ? 1 : 0;
    water.step();
    (void)water.requestFrame({.surface = true, .particles = true, .foam = true, .bodies = true});
    for (const core::FrameView& frame : water.takeFrames())
      ASSERT_LE(frame.particles->count, scene.particles().count());
    ASSERT_EQ(water.health().volume_error_units, 0) << "tick " << tick;
    ASSERT_EQ(water.escapedCount(), 0u) << "tick " << tick;
    if (tick % 100 == 0) {
      const sim::StateCopy state = water.copyState();
      ASSERT_TRUE(allFinite(state.position) && allFinite(state.velocity) && allFinite(state.flow_m2ps) &&
                  allFinite(state.boats));
    }
  }
  std::printf("%d commands in %d ticks, %d of them accepted; guard stepped in %llu times\n", commands, ticks, accepted,
              static_cast<unsigned long long>(water.recoveredCount()));
  EXPECT_GT(accepted, commands / 3);
  EXPECT_EQ(water.recoveredCount(), 0u);
  // And it goes on.
  for (int tick = 0; tick < 120; ++tick) water.step();
  EXPECT_EQ(water.recoveredCount(), 0u);
  EXPECT_EQ(water.nonfiniteCount(), 0u);
}

TEST_F(Endurance, TheLedgerOfSurfaceAndParticlesIsExact) {
  const int ticks = wanted("SPINDRIFT_LEDGER_TICKS", 1500);
  core::Scene scene = stream::toCore(shipped("harbor"));
  scene.wave->resolution_count = 96;
  scene.storm->level_ratio = 1.0;
  scene.coupling->droplet_spacing_m = 0.25;
  sim::WaterSim& water = make(scene);
  for (int tick = 0; tick < ticks; ++tick) {
    if (tick % 90 == 0) {
      ASSERT_TRUE(water.start(core::Splash{0.0, -6.0, 1.6, 1.0, 0.2}));
    }
    water.step();
    ASSERT_EQ(water.health().volume_error_units, 0) << "tick " << tick;
  }
  std::printf("%d ticks: %u particles emitted, %u absorbed, %lld units through the open sides, ledger exact\n", ticks,
              water.health().emitted_count, water.health().absorbed_count,
              static_cast<long long>(water.health().outflow_units));
  EXPECT_GT(water.health().emitted_count, 100u);
  EXPECT_EQ(water.recoveredCount(), 0u);
}

/// Root mean square speed of the particles. [m/s]
double rootMeanSquareSpeed(const sim::WaterSim& water) {
  const double mass_kg = water.derived().particles->mass_kg * water.particleCount();
  return std::sqrt(2 * water.health().kinetic_energy_j / mass_kg);
}

TEST_F(Endurance, StillPoolStaysStillForAMinute) {
  const int ticks = 3600;
  core::Scene scene = stream::toCore(shipped("still_pool"));
  sim::WaterSim& water = make(scene);
  double first_mps = 0;
  double later_mps = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    water.step();
    (tick < 900 ? first_mps : later_mps) = std::max(tick < 900 ? first_mps : later_mps, rootMeanSquareSpeed(water));
    ASSERT_EQ(water.health().max_elevation_m, 0.0);
  }
  std::printf("still pool: at most %.4f m/s in the first 15 s, %.4f m/s after (root mean square)\n", first_mps,
              later_mps);
  // The jittered lattice buckles into a looser order in the first seconds; they move at most a particle's
  // spacing (0.46 m) a second, and from then on a twentieth of it.
  EXPECT_LE(first_mps, 0.5);
  EXPECT_LE(later_mps, 0.025);
  EXPECT_EQ(water.recoveredCount(), 0u);
}

TEST_F(Endurance, StillPoolStaysStillWithPositionsSolvedFor) {
  core::Scene scene = stream::toCore(shipped("still_pool"));
  scene.particles->solver = core::PressureSolver::kPositionBased;
  sim::WaterSim& water = make(scene);
  for (int tick = 0; tick < 900; ++tick) water.step();
  EXPECT_LE(rootMeanSquareSpeed(water), 0.05);
  EXPECT_EQ(water.health().max_elevation_m, 0.0);
  EXPECT_EQ(water.recoveredCount(), 0u);
}

TEST_F(Endurance, NoParticleStaysBelowTheSurfaceOrInARock) {
  core::Scene scene = stream::toCore(shipped("harbor"));
  sim::WaterSim& water = make(scene);
  const auto n = static_cast<int>(scene.wave->resolution_count);
  const double cell_m = scene.wave->side_m / n;
  const auto surface = [&](const sim::StateCopy& state, double x_m, double z_m) {
    const auto at = [&](double p) { return std::clamp((p + scene.wave->side_m / 2) / cell_m - 0.5, 0.0, n - 1.001); };
    const double u = at(x_m);
    const double v = at(z_m);
    const auto i = static_cast<std::size_t>(u);
    const auto k = static_cast<std::size_t>(v);
    const auto row = [&](std::size_t z) {
      return std::lerp(state.elevation_m[i + n * z], state.elevation_m[i + 1 + n * z], u - static_cast<double>(i));
    };
    return std::lerp(row(k), row(k + 1), v - static_cast<double>(k));
  };
  double deepest_m = -1e9;
  std::size_t seen = 0;
  for (int tick = 0; tick < 360; ++tick) {
    if (tick % 60 == 0) {
      ASSERT_TRUE(water.start(core::Splash{-7.0, 3.5, 1.5, 1.0, 0.2}));  // beside the rocks
    }
    water.step();
    const sim::StateCopy state = water.copyState();
    for (std::size_t i = 0; i < state.position.size(); i += 4) {
      if (state.position[i + 3] < 0) continue;  // became water in this step
      ++seen;
      const double x = state.position[i];
      const double y = state.position[i + 1];
      const double z = state.position[i + 2];
      deepest_m = std::max(deepest_m, surface(state, x, z) - y);
      for (const core::Obstacle& obstacle : scene.obstacles) {
        const auto* rock = std::get_if<core::Rock>(&obstacle);
        if (!rock || y > rock->height_m) continue;
        ASSERT_GT(std::hypot(x - rock->x_m, z - rock->z_m), rock->radius_m - 1.5 * cell_m);
      }
    }
  }
  EXPECT_GT(seen, 1000u);
  std::printf("%zu sightings, the deepest %.3f m below the surface\n", seen, deepest_m);
  // The particles met the surface as it was at the start of the tick; what others took from it or gave it since is not
  // yet theirs. A splash of 1 m in 0.2 s moves it by at most 0.13 m in a tick.
  EXPECT_LE(deepest_m, 0.13);
}

}  // namespace
}  // namespace spindrift
