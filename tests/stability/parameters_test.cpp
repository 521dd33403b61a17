// Sweeps every live parameter of every shipped scene over its whole range, with every kind of side: the water stays
// finite and above its bed, the ledger is exact, and the watchdog never acts. Parameters come from their descriptions
// and scenes from the folder, so new ones are included. The default form is short: both ends of each range, depths at
// which absorbing sides used to be unstable, few ticks, and DRAFT for other sides than the scene's. Longer:
// SPINDRIFT_SWEEP_VALUES values between the ends, SPINDRIFT_SWEEP_TICKS ticks each, SPINDRIFT_SWEEP_SIDES=1 for every
// kind of side in every scene, SPINDRIFT_COUNT_MAX particles.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include <shared/fixed_point.h>

#include <spindrift/scene/scene_rules.h>
#include <spindrift/sim_setup/basin.h>

#include "parameter_sweep.h"

namespace spindrift {
namespace {

/// Both ends of a parameter's range, `between` values between them, and values that a scene adds for a path.
std::vector<double> valuesOf(const v1::ParameterDescription& parameter, int between, const std::vector<double>& more) {
  std::vector<double> values = {parameter.min(), parameter.max()};
  // Ranges over several decades are divided by ratio, others evenly.
  const bool by_ratio = parameter.min() > 0 && parameter.max() > 30 * parameter.min();
  for (int i = 1; i <= between; ++i) {
    const double share = static_cast<double>(i) / (between + 1);
    const double value = by_ratio ? parameter.min() * std::pow(parameter.max() / parameter.min(), share)
                                  : std::lerp(parameter.min(), parameter.max(), share);
    values.push_back(parameter.step() >= 1 ? std::round(value) : value);
  }
  for (const double value : more) {
    if (value > parameter.min() && value < parameter.max()) values.push_back(value);
  }
  return values;
}

/// Depths for which the step of the rule is close to its bound in scenes with absorbing sides.
const std::vector<double> kBadDepths_m = {1.2, 2.05, 3.5};
/// These are for basins of 6 m and more; smaller ones have smaller splashes and bounds in proportion (basinRatio).
/// A splash of 0.5 m ends in rings a third as high. An unstable wave exceeds this height within a second; it grows to
/// about the depth and no further, because no cell gives more than it holds.
constexpr double kHighest_m = 0.5;
/// Spray that falls back into the middle of the splash lifts the surface after 0.8 to 1.2 s: 0.59 m in boat_wake with
/// particles of at most 0.5 m/s, and as much with half the step.
constexpr double kRebound_m = 0.75;
constexpr double kReboundBegin_s = 0.7;
/// Without gravity there are no waves, and nothing levels what the splash has moved: its rim stays 0.78 m high where it
/// stands on the 5 cm of water at the shore of river_mouth.
constexpr double kWeightless_m = 1.0;
/// Root mean square over the basin. A splash lifts a few cells, an unstable wave a large part of them.
constexpr double kRoughest_m = 0.1;

class Parameters : public Endurance, public ::testing::WithParamInterface<std::string> {
 protected:
  /// Runs the water from its start with a splash of at most 0.5 m.
  void run(sim::WaterSim& water, const core::Scene& scene, int ticks, const std::string& what) {
    SCOPED_TRACE(what);
    water.reset();
    const std::uint64_t recovered = water.recoveredCount();
    const double depth_m = scene.wave ? scene.wave->depth_m : scene.particles->headroom_m;
    // A narrow channel takes a smaller one.
    const double across_m =
        scene.wave ? std::min(core::waveCellsOf(*scene.wave).length_m, core::waveCellsOf(*scene.wave).width_m) : 8.0;
    const double ratio = scene.wave ? basinRatio(core::waveCellsOf(*scene.wave).length_m) : 1.0;
    const double radius_m = std::min(ratio * 1.6, 0.2 * across_m);
    ASSERT_TRUE(water.start(
        core::Splash{ratio * 0.3, ratio * -0.2, radius_m, std::min({ratio * 0.5, 0.9 * depth_m, radius_m}), 0.22}));
    if (scene.wave) {
      // A sharp splash at a corner excites instabilities at the sides at once.
      const core::WaveCells cells = core::waveCellsOf(*scene.wave);
      const double cell_m = water.derived().wave->cell_m;
      ASSERT_TRUE(water.start(core::Splash{0.5 * cells.length_m - 6 * cell_m, 0.5 * cells.width_m - 6 * cell_m,
                                           1.5 * cell_m, std::min(ratio * 0.1, 0.5 * depth_m), 0.05}));
    }
    // The fastest sound speed needs hundreds of substeps per tick.
    const int most = std::max(ticks / static_cast<int>(water.derived().substeps_count), 2);
    for (int tick = 0; tick < most; ++tick) {
      water.step();
      ASSERT_EQ(water.health().volume_error_units, 0) << "tick " << tick;
    }
    ++run_count_;
    EXPECT_EQ(water.recoveredCount(), recovered) << "the watchdog stepped in";
    EXPECT_EQ(water.nonfiniteCount(), 0u);
    const sim::StateCopy state = water.copyState();
    for (const auto* values : {&state.position, &state.velocity, &state.flow_m2ps, &state.boats})
      ASSERT_TRUE(std::ranges::all_of(*values, [](float value) { return std::isfinite(value); }));
    if (!scene.wave) return;
    const sim::Basin basin = sim::layOutBasin(scene, *water.derived().wave);
    const bool may_rebound = scene.particles && water.time_s() > kReboundBegin_s;
    const double highest_m =
        ratio * (scene.gravity_mps2 == 0.0 ? kWeightless_m : (may_rebound ? kRebound_m : kHighest_m));
    double squares_m2 = 0.0;
    for (std::size_t i = 0; i < state.elevation_m.size(); ++i) {
      if (basin.depth_m[i] <= 0) continue;
      ASSERT_GE(state.elevation_m[i], -double{basin.depth_m[i]} - 1e-6) << "below the bed";
      ASSERT_LE(state.elevation_m[i], highest_m);
      highest_seen_m_ = std::max(highest_seen_m_, state.elevation_m[i]);
      squares_m2 += state.elevation_m[i] * state.elevation_m[i];
    }
    const double rms_m = std::sqrt(squares_m2 / static_cast<double>(state.elevation_m.size()));
    ASSERT_LE(rms_m, ratio * kRoughest_m);
    roughest_seen_m_ = std::max(roughest_seen_m_, rms_m);
  }

  /// Sweeps each live parameter of a room in turn, the others as in the scene. If the scene or its room refuses an end
  /// of the range (a boat needs a depth, a pool's drops need a column of water), the nearest accepted value is used
  /// instead.
  void sweep(const v1::Scene& scene, int between, int ticks, int bad_depth_ticks) {
    sim::WaterSim& water = make(scene::toCore(scene));
    v1::Scene changed;
    const auto takes = [&](const std::string& path, double value) {
      changed = scene;
      return !scene::setParameter(changed, path, value) && water.setScene(scene::toCore(changed));
    };
    for (const v1::ParameterDescription& parameter : scene::describeParameters(scene)) {
      const std::string& path = parameter.path();
      const bool is_depth = path == "wave.depth_m";
      int taken_count = 0;
      for (double value : valuesOf(parameter, between, is_depth ? kBadDepths_m : std::vector<double>{})) {
        if (path == "particles.count") value = std::min<double>(value, wanted("SPINDRIFT_COUNT_MAX", 12000));
        if (!takes(path, value)) value = nearestTaken(parameter, value, takes);
        if (!takes(path, value) || value == parameter.value()) continue;
        ++taken_count;
        const int value_ticks = is_depth && value < 10 ? std::max(ticks, bad_depth_ticks) : ticks;
        ASSERT_NO_FATAL_FAILURE(run(water, scene::toCore(changed), value_ticks, path + " = " + std::to_string(value)));
      }
      ASSERT_TRUE(takes(path, parameter.value())) << "back from " << path;
      if (taken_count == 0) refused_.insert(path);
    }
  }

  int run_count_ = 0;
  double highest_seen_m_ = 0.0;
  double roughest_seen_m_ = 0.0;
  std::set<std::string> refused_;  ///< every value needs another room
};

class WaveParameters : public Parameters {};

TEST_P(Parameters, KeepTheWaterHealthyOverTheirWholeRanges) {
  const v1::Scene scene = unsettled(shipped(GetParam()));
  sweep(scene, wanted("SPINDRIFT_SWEEP_VALUES", 0), wanted("SPINDRIFT_SWEEP_TICKS", 8), 24);
  std::printf("%d runs, elevations of up to %.3f m, %.4f m root mean square\n", run_count_, highest_seen_m_,
              roughest_seen_m_);
  EXPECT_GE(run_count_, 8);
  // Fixed parameters: the size of a pool, and values for which the room has no shaders.
  const std::set<std::string> may_refuse = {"particles.count", "wave.steepening_ratio", "foam.neighbours_count"};
  for (const std::string& path : refused_) EXPECT_TRUE(may_refuse.contains(path)) << path;
}

/// The wave of a scene alone, with one kind of side everywhere.
v1::Scene withSides(v1::Scene scene, v1::WaveBoundary side) {
  v1::WaveScene& wave = *scene.mutable_wave();
  wave.set_boundary_minus_x(side);
  wave.set_boundary_plus_x(side);
  wave.set_boundary_minus_z(side);
  wave.set_boundary_plus_z(side);
  const core::WaveCells cells = scene::waveCellsOf(wave);
  wave.set_sponge_width_m(std::min(wave.sponge_width_m(), 0.5 * std::min(cells.length_m, cells.width_m)));
  if (side != v1::WAVE_BOUNDARY_REFLECT) scene.clear_wave_makers();  // they stand at closed sides
  if (side == v1::WAVE_BOUNDARY_PERIODIC) {
    scene.clear_beaches();  // beaches need sides that are not periodic
    // Dispersion halves the cells between periodic sides four times.
    if (cells.count.x % 16 != 0 || cells.count.z % 16 != 0) wave.clear_dispersion();
  }
  return scene;
}

TEST_P(WaveParameters, KeepTheWaveHealthyWithEveryKindOfSide) {
  v1::Scene scene = shipped(GetParam(), levelFor("SPINDRIFT_SWEEP_SIDES"));
  scene.clear_particles();
  scene.clear_coupling();
  scene.clear_course();  // needs sides that boats cannot cross
  if (!scene.foam().surface()) scene.clear_foam();
  constexpr std::array kSides = {v1::WAVE_BOUNDARY_ABSORB, v1::WAVE_BOUNDARY_REFLECT, v1::WAVE_BOUNDARY_PERIODIC};
  const int between = wanted("SPINDRIFT_SWEEP_VALUES", 0);
  const int ticks = wanted("SPINDRIFT_SWEEP_TICKS", 8);
  // The short form: absorbing sides in every scene, and one of the other kinds in turn.
  const std::vector<std::string> names = sceneNames(Which::kWithWave);
  const auto turn = static_cast<std::size_t>(std::ranges::find(names, GetParam()) - names.begin()) % 2;
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    if (wanted("SPINDRIFT_SWEEP_SIDES", 0) == 0 && i != 0 && i != 1 + turn) continue;
    SCOPED_TRACE(v1::WaveBoundary_Name(kSides[i]));
    sweep(withSides(scene, kSides[i]), between, ticks, 70);
  }
  std::printf("%d runs, elevations of up to %.3f m, %.4f m root mean square\n", run_count_, highest_seen_m_,
              roughest_seen_m_);
  EXPECT_GE(run_count_, 15);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Parameters, ::testing::ValuesIn(sceneNames(Which::kAll)),
                         [](const auto& scene) { return scene.param; });
INSTANTIATE_TEST_SUITE_P(Scenes, WaveParameters, ::testing::ValuesIn(sceneNames(Which::kWithWave)),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace spindrift
