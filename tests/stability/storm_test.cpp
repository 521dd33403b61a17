// Whatever clients and weather do, no cell holds a negative amount of water: the surface stays above the bed.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <shared/boats.h>
#include <shared/fixed_point.h>
#include <shared/floaters.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/fill_up.h>
#include <spindrift/sim_setup/scene_parts.h>

#include "parameter_sweep.h"
#include "random_crowd.h"
#include "stability_scene.h"

namespace spindrift {
namespace {

/// Extremes of the water of one state, wet cells only.
struct Extremes {
  std::int64_t thinnest_units = std::numeric_limits<std::int64_t>::max();  ///< least water column, elevation + depth
  double lowest_m = 0.0;                                                   ///< elevation
  double highest_m = 0.0;                                                  ///< elevation

  void add(const Extremes& other) {
    thinnest_units = std::min(thinnest_units, other.thinnest_units);
    lowest_m = std::min(lowest_m, other.lowest_m);
    highest_m = std::max(highest_m, other.highest_m);
  }
};

Extremes extremesOf(sim::WaterSim& water, const sim::StateCopy& state) {
  const sim::Basin basin = sim::layOutBasin(water.scene(), *water.derived().wave);
  Extremes out;
  const bool is_nonlinear = sim::isNonlinear(water.scene());  // then every cell can hold water
  for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
    if (!is_nonlinear && basin.depth_m[i] <= 0) continue;
    // Both are exact: the elevation is a whole number of units, and so is the bed in the shaders.
    const std::int64_t bed_units = sim::bedUnits(basin.bed[i][2]);
    const auto units = static_cast<std::int64_t>(std::llround(state.elevation_m[i] * double{ELEVATION_UNITS_PER_M}));
    const std::int64_t held_units = bed_units + units;
    out.add({.thinnest_units = held_units});
    if (held_units != 0) out.add({held_units, state.elevation_m[i], state.elevation_m[i]});
  }
  return out;
}

/// Largest allowed elevations. 168 splashes, waves and boats per second, each as large as the scene accepts, pile up
/// water at rocks and walls (harbor: 10.2 m in 400 ticks); full storm and boats at full speed do not.
constexpr double kHighestOfCrowd_m = 16.0;
constexpr double kHighestOfWeather_m = 2.0;
/// With every depth and gravity that a scene accepts; half the range of the elevation.
constexpr double kHighestOfParameters_m = 64.0;

/// Every third tick is looked at in a short run, and about this many in a long one: reading all cells costs more than a
/// tick.
constexpr int kLooks = 2000;

class Storm : public Endurance {
 protected:
  /// Runs `ticks` of a scene with random commands and its boats at full speed. Checks the volume after every tick, and
  /// looks at all cells now and then.
  Extremes run(const v1::Scene& scene, Crowd::Sends sends, int ticks, double commands_per_tick = 2.8) {
    sim::WaterSim& water = make(scene::toCore(scene));
    Crowd crowd(scene, sends);
    Extremes out;
    double commands = 0.0;
    double most_j = 0.0;
    const int look_every = std::max(3, ticks / kLooks);
    for (const sim::BoatRecord& boat : water.boats()) EXPECT_TRUE(water.controlBoat(boat.boat_id, 1.0, 0.4));
    for (int tick = 0; tick < ticks; ++tick) {
      commands += commands_per_tick;
      while (commands >= 1.0) {
        crowd.send(water);
        commands -= 1.0;
      }
      water.step();
      EXPECT_EQ(water.health().volume_error_units, 0) << "tick " << tick;
      most_j = std::max(most_j, water.health().wave_energy_j);
      if (tick % look_every == 0) {
        const sim::StateCopy state = water.copyState();
        out.add(extremesOf(water, state));
        expectBodiesInTheBasin(*water.derived().wave, state);
      }
      if (HasFailure()) break;
    }
    std::printf(
        "elevations from %.3f to %.3f m, thinnest column %.6f m, most energy %.3g J, watchdog stepped in %llu times\n",
        out.lowest_m, out.highest_m, static_cast<double>(out.thinnest_units) * double{ELEVATION_UNIT_M}, most_j,
        static_cast<unsigned long long>(water.recoveredCount()));
    EXPECT_EQ(water.recoveredCount(), 0u);
    EXPECT_EQ(water.nonfiniteCount(), 0u);
    return out;
  }

  /// Whatever is thrown, held and drawn: what has sides, keeps its boats and floaters. The first texel of both is the
  /// position. The middle of a boat may be beyond a side by 0.3 m, that of a floater not at all.
  static void expectBodiesInTheBasin(const sim::WaveLayout& wave, const sim::StateCopy& state) {
    const auto expectInside = [&](const std::vector<float>& bodies, std::size_t words, std::size_t age,
                                  double beyond_m) {
      for (std::size_t at = 0; at < bodies.size(); at += words) {
        if (bodies[at + age] < 0) continue;
        EXPECT_LE(std::abs(bodies[at]), wave.length_m / 2 + beyond_m) << "body " << at / words;
        EXPECT_LE(std::abs(bodies[at + 2]), wave.width_m / 2 + beyond_m) << "body " << at / words;
        EXPECT_LE(std::abs(bodies[at + 1]), 60.0) << "body " << at / words;
      }
    };
    expectInside(state.boats, std::size_t{BOAT_TEXELS} * 4, 6, 0.3);
    expectInside(state.floaters, std::size_t{FLOATER_TEXELS} * 4, 3, 0.0);
  }

  struct Energies {
    double most_j = 0.0;  ///< of the waves, and of the particles that are made of their water
    double highest_m = 0.0;
  };

  /// Lets the water alone for `ticks`.
  Energies rest(int ticks) {
    Energies out;
    const auto& coupling = water_->scene().coupling;
    const bool is_two_way = coupling && coupling->mode == core::CouplingMode::kTwoWay;
    for (int tick = 0; tick < ticks; ++tick) {
      water_->step();
      const sim::Health& health = water_->health();
      EXPECT_EQ(health.volume_error_units, 0) << "calm tick " << tick;
      const double droplets_j = is_two_way ? health.kinetic_energy_j + health.potential_energy_j : 0.0;
      out.most_j = std::max(out.most_j, health.wave_energy_j + droplets_j);
      out.highest_m = std::max(out.highest_m, health.max_elevation_m);
    }
    return out;
  }

  static v1::Scene stormyHarbor(std::optional<v1::Fidelity> level = {}) {
    v1::Scene scene = shipped("harbor", level);
    scene.mutable_storm()->set_level_ratio(1.0);
    return scene;
  }
};

TEST_F(Storm, SplashesNeverEmptyTheHarborBelowItsBed) {
  const int ticks = wanted("SPINDRIFT_STORM_TICKS", 250);
  const Extremes extremes = run(stormyHarbor(), Crowd::Sends::kEffectsAndBoats, ticks);
  EXPECT_GE(extremes.thinnest_units, 0);
  EXPECT_LE(extremes.highest_m, kHighestOfCrowd_m);
  EXPECT_GT(extremes.highest_m, 0.5) << "a storm that moves no water proves nothing";
}

TEST_F(Storm, WeatherAndBoatsAloneStayLow) {
  const int ticks = wanted("SPINDRIFT_STORM_TICKS", 600);
  const v1::Scene scene = stormyHarbor(levelFor("SPINDRIFT_STORM_TICKS"));
  const Extremes extremes = run(scene, Crowd::Sends::kEffectsAndBoats, ticks, 0.0);
  EXPECT_GE(extremes.thinnest_units, 0);
  EXPECT_LE(extremes.highest_m, kHighestOfWeather_m);
  EXPECT_GT(extremes.highest_m, 0.1) << "no weather";
}

/// Backwash from breakers once began a disturbance that ran over the deep water and kept itself up: the dynamic head of
/// short waves drove them.
TEST_F(Storm, BreakersOnASlopeLeaveTheWaterBeforeItCalm) {
  v1::Scene scene = shipped("flume");
  scene.mutable_wave()->set_resolution_count(800);
  scene.mutable_wave()->set_width_m(0.25);
  v1::WaveMaker& maker = *scene.mutable_wave_makers(0);
  maker.mutable_regular()->set_height_m(0.14);
  maker.set_duration_s(10);
  sim::WaterSim& water = make(scene::toCore(scene));
  const auto energyAt_j = [&](double time_s) {
    while (water.time_s() < time_s) water.step();
    return water.health().wave_energy_j;
  };
  const double breaking_j = energyAt_j(14.0);
  const double calm_j = energyAt_j(26.0);
  std::printf("%.1f J while the last waves break, %.2f J 12 s later\n", breaking_j, calm_j);
  EXPECT_LE(calm_j, 0.1 * breaking_j);
  EXPECT_EQ(water.recoveredCount(), 0u);
}

class StormInScene : public Storm, public ::testing::WithParamInterface<std::string> {};

/// Where the waves disperse, all live parameters move over their whole ranges as well; parameters_test moves those of
/// the other scenes. Many values make a tick slow, so the longest runs may do without: SPINDRIFT_STORM_PARAMETERS=0.
TEST_P(StormInScene, KeepsTheVolumeAndStaysBounded) {
  v1::Scene scene = unsettled(shipped(GetParam(), levelFor("SPINDRIFT_STORM_TICKS")));
  if (scene.has_storm()) scene.mutable_storm()->set_level_ratio(1.0);
  const int ticks = wanted("SPINDRIFT_STORM_TICKS", 90);
  const double commands_per_tick = 0.01 * wanted("SPINDRIFT_STORM_COMMANDS_PER_100_TICKS", 280);
  const bool moves_parameters =
      scene.wave().dispersion() == v1::DISPERSION_AIRY && wanted("SPINDRIFT_STORM_PARAMETERS", 1) != 0;
  const auto sends = moves_parameters ? Crowd::Sends::kEverything : Crowd::Sends::kEffectsAndBoats;
  const Extremes extremes = run(scene, sends, ticks, commands_per_tick);
  EXPECT_GE(extremes.thinnest_units, 0);
  const double ratio = basinRatio(water_->derived().wave->length_m);
  EXPECT_LE(extremes.highest_m, ratio * kHighestOfParameters_m);
  EXPECT_GT(extremes.highest_m, ratio * 0.1) << "a storm that moves no water proves nothing";
}

/// After the last command, water can only lose energy. With dispersion the diagnostics' energy leaves out a part that
/// swings to and fro with the waves, so stretches of time are compared instead of ticks.
TEST_P(StormInScene, CalmAfterwardsGainsNoEnergy) {
  v1::Scene scene = unsettled(shipped(GetParam(), levelFor("SPINDRIFT_STORM_TICKS")));
  scene.clear_events();
  scene.clear_storm();
  if (scene.has_boats()) scene.mutable_boats()->clear_boats();
  const int ticks = wanted("SPINDRIFT_STORM_TICKS", 60);
  run(scene, Crowd::Sends::kEffectsAndBoats, ticks, 1.0);
  for (const sim::BoatRecord& boat : water_->boats()) EXPECT_TRUE(water_->removeBoat(boat.boat_id));
  // The longest effect of the crowd lasts a second.
  rest(static_cast<int>(water_->scene().tick_rate_hz));
  const Energies first = rest(std::max(ticks / 2, 45));
  const Energies second = rest(std::max(ticks / 2, 45));
  std::printf(
      "most energy %.3g J in the first part of the calm, %.3g J in the second; highest water %.3f m and %.3f m\n",
      first.most_j, second.most_j, first.highest_m, second.highest_m);
  EXPECT_GT(first.most_j, 0.0);
  EXPECT_LE(second.most_j, first.most_j);
  EXPECT_EQ(water_->recoveredCount(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, StormInScene, ::testing::ValuesIn(sceneNames(Which::kWithWave)),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace spindrift
