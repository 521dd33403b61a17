// Whatever clients and weather do, no cell holds a negative amount of water: the surface stays above the bed.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

#include <shared/fixed_point.h>

#include <spindrift/sim_setup/basin.h>
#include <spindrift/sim_setup/fill_up.h>
#include <spindrift/sim_setup/scene_parts.h>

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

Extremes extremesOf(sim::WaterSim& water) {
  const sim::Basin basin = sim::layOutBasin(water.scene(), *water.derived().wave);
  const sim::StateCopy state = water.copyState();
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
/// water at rocks and walls (harbor: 15.4 m in 400 ticks); full storm and boats at full speed do not.
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
      if (tick % look_every == 0) out.add(extremesOf(water));
      if (HasFailure()) break;
    }
    std::printf("elevations from %.2f to %.2f m, thinnest column %.6f m, watchdog stepped in %llu times\n",
                out.lowest_m, out.highest_m, static_cast<double>(out.thinnest_units) * double{ELEVATION_UNIT_M},
                static_cast<unsigned long long>(water.recoveredCount()));
    EXPECT_EQ(water.recoveredCount(), 0u);
    EXPECT_EQ(water.nonfiniteCount(), 0u);
    return out;
  }

  static v1::Scene stormyHarbor() {
    v1::Scene scene = shipped("harbor");
    scene.mutable_storm()->set_level_ratio(1.0);
    return scene;
  }
};

TEST_F(Storm, SplashesWavesAndBoatsNeverEmptyTheHarborBelowItsBed) {
  const int ticks = wanted("SPINDRIFT_STORM_TICKS", 400);
  const Extremes extremes = run(stormyHarbor(), Crowd::Sends::kEffectsAndBoats, ticks);
  EXPECT_GE(extremes.thinnest_units, 0);
  EXPECT_LE(extremes.highest_m, kHighestOfCrowd_m);
  EXPECT_GT(extremes.highest_m, 0.5) << "a storm that moves no water proves nothing";
}

TEST_F(Storm, WeatherAndBoatsAloneStayLow) {
  const int ticks = wanted("SPINDRIFT_STORM_TICKS", 600);
  const Extremes extremes = run(stormyHarbor(), Crowd::Sends::kEffectsAndBoats, ticks, 0.0);
  EXPECT_GE(extremes.thinnest_units, 0);
  EXPECT_LE(extremes.highest_m, kHighestOfWeather_m);
  EXPECT_GT(extremes.highest_m, 0.1) << "no weather";
}

/// Every scene whose waves disperse, with all its live parameters over their whole ranges as well. Many values make a
/// tick slow, so the longest runs may do without: SPINDRIFT_STORM_PARAMETERS=0.
class StormWhereWavesDisperse : public Storm, public ::testing::WithParamInterface<const char*> {};

TEST_P(StormWhereWavesDisperse, KeepsItsVolumeAndStaysBounded) {
  v1::Scene scene = shipped(GetParam());
  ASSERT_EQ(scene.wave().dispersion(), v1::DISPERSION_AIRY);
  if (scene.has_storm()) scene.mutable_storm()->set_level_ratio(1.0);
  const int ticks = wanted("SPINDRIFT_STORM_TICKS", 150);
  const double commands_per_tick = 0.01 * wanted("SPINDRIFT_STORM_COMMANDS_PER_100_TICKS", 280);
  const auto sends =
      wanted("SPINDRIFT_STORM_PARAMETERS", 1) ? Crowd::Sends::kEverything : Crowd::Sends::kEffectsAndBoats;
  const Extremes extremes = run(scene, sends, ticks, commands_per_tick);
  EXPECT_GE(extremes.thinnest_units, 0);
  EXPECT_LE(extremes.highest_m, kHighestOfParameters_m);
  EXPECT_GT(extremes.highest_m, 0.1) << "a storm that moves no water proves nothing";
}

INSTANTIATE_TEST_SUITE_P(Scenes, StormWhereWavesDisperse,
                         ::testing::Values("harbor", "splash", "boat_wake", "open_water", "kelvin", "rain_rings",
                                           "beach", "island", "river_mouth"),
                         [](const auto& scene) { return std::string(scene.param); });

}  // namespace
}  // namespace spindrift
