// Changes live parameters of every shipped scene while its water moves: with the storm at its height, with boats,
// effects and wave-makers as the scene has them. Each change is one step, to an end of a parameter's range or to ends
// of two at once; then back; some with a change of fidelity between. The water stays finite, its ledger is exact,
// the watchdog never acts, and the waves become no higher than waves can.
// The default form changes each parameter to both ends, and a few pairs, at DRAFT. Longer: SPINDRIFT_SEA_TICKS ticks
// after each step at the scene's own level, SPINDRIFT_SEA_PAIRS pairs per scene, SPINDRIFT_SEA_FIDELITIES changes of
// fidelity. An hour on two cores: SPINDRIFT_SEA_PAIRS=60 SPINDRIFT_SEA_TICKS=60 SPINDRIFT_SEA_FIDELITIES=8.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/sim_setup/sea_state.h>

#include "parameter_sweep.h"

namespace spindrift {
namespace {

using Settings = std::vector<std::pair<std::string, double>>;

/// Time until the waves of a storm have crossed most of the water.
constexpr double kRise_s = 8.0;
/// What a splash that is under way may add when the depth rises to 100 m: 0.26 m in splash_wave. Under 0.01 m/s^2 waves
/// used to grow to 2.9 m in a second.
constexpr double kRise_m = 0.4;
/// Gravity is the parameter that everything in the water depends on: each pair of the short form has it.
constexpr const char* kGravity = "gravity_mps2";

class SeaParameters : public Endurance, public ::testing::WithParamInterface<std::string> {
 protected:
  /// Runs `ticks` ticks and checks each; fewer where parameters need many substeps.
  void run(int ticks) {
    const auto substeps = static_cast<int>(water_->derived().substeps_count);
    for (int tick = 0; tick < std::clamp(8 * ticks / substeps, 1, ticks); ++tick) {
      water_->step();
      ASSERT_EQ(water_->health().volume_error_units, 0) << "tick " << tick;
      ASSERT_EQ(water_->recoveredCount(), recovered_count_) << "the watchdog stepped in at tick " << tick;
    }
  }

  void check() {
    const sim::StateCopy state = water_->copyState();
    for (const auto* values : {&state.position, &state.velocity, &state.flow_m2ps, &state.boats})
      ASSERT_TRUE(std::ranges::all_of(*values, [](float value) { return std::isfinite(value); }));
    if (state.elevation_m.empty()) return;
    const double highest_m = water_->health().max_elevation_m;
    if (highest_m > highest_seen_m_) {
      highest_seen_m_ = highest_m;
      highest_at_ = what_;
    }
  }

  bool takes(const v1::Scene& base, const Settings& settings) {
    v1::Scene changed = base;
    for (const auto& [path, value] : settings)
      if (scene::setParameter(changed, path, value)) return false;
    const core::Scene scene = scene::toCore(changed);
    if (!water_->setScene(scene)) return false;
    if (scene.wave)
      highest_sea_m_ = std::max(highest_sea_m_, sim::seaState(scene, *water_->derived().wave).significant_height_m);
    return true;
  }

  /// The water continues at the level `to`, with the parameters as they are.
  void changeFidelity(const Settings& settings, v1::Fidelity to) {
    auto loaded = scene::loadSceneFile(sceneFolder() / (GetParam() + ".textproto"), to);
    ASSERT_TRUE(loaded) << loaded.error().message;
    v1::Scene scene = unsettled(*loaded);
    scene::keepParameters(base_, scene);
    for (const auto& [path, value] : settings) (void)scene::setParameter(scene, path, value);
    auto next = sim::WaterSim::create(*ctx_, scene::toCore(scene));
    if (!next) return;  // this level needs more than there is: a deep one may need too many steps
    const auto taken = (*next)->takeOver(water_->carriedState());
    ASSERT_TRUE(taken) << taken.error().message;
    water_ = *std::move(next);
    recovered_count_ = 0;
    ++fidelity_count_;
  }

  v1::Scene base_;
  std::uint64_t recovered_count_ = 0;
  double highest_seen_m_ = 0.0;
  double highest_sea_m_ = 0.0;  ///< significant height of the highest sea that the parameters ask for
  std::string what_, highest_at_;
  int fidelity_count_ = 0;
};

std::string textOf(const Settings& settings) {
  std::string out;
  for (const auto& [path, value] : settings) out += path + " = " + std::to_string(value) + " ";
  return out;
}

TEST_P(SeaParameters, KeepTheWaterHealthyWhileItMoves) {
  const auto level = levelFor("SPINDRIFT_SEA_TICKS");
  base_ = unsettled(shipped(GetParam(), level));
  if (base_.has_storm()) base_.mutable_storm()->set_level_ratio(1.0);
  const core::Scene base = scene::toCore(base_);
  make(base);
  // Particles alone have no sea, and many substeps.
  const int ticks = wanted("SPINDRIFT_SEA_TICKS", base.wave ? 6 : 2);
  const double rise_s = base_.has_storm() ? kRise_s : 0.25 * kRise_s;
  for (int tick = 0; tick < rise_s / water_->derived().tick_s; ++tick) water_->step();
  if (base.wave) (void)water_->start(core::Splash{0.0, 0.0, 0.2 * core::waveCellsOf(*base.wave).width_m / 4, 0.2, 0.2});
  ASSERT_NO_FATAL_FAILURE(run(ticks));
  ASSERT_NO_FATAL_FAILURE(check());
  const double usual_m = highest_seen_m_;
  const sim::SavedState start = water_->savedState();

  // Both ends of each parameter that this room takes.
  std::vector<Settings> moves;
  const auto takesAlone = [&](const std::string& path, double value) { return takes(base_, {{path, value}}); };
  for (const v1::ParameterDescription& parameter : scene::describeParameters(base_)) {
    for (double value : {parameter.min(), parameter.max()}) {
      if (parameter.path() == "particles.count") value = std::min<double>(value, wanted("SPINDRIFT_COUNT_MAX", 12000));
      if (!takesAlone(parameter.path(), value)) value = nearestTaken(parameter, value, takesAlone);
      if (value != parameter.value()) moves.push_back({{parameter.path(), value}});
    }
  }
  ASSERT_TRUE(water_->setScene(base));
  const std::size_t single_count = moves.size();
  std::mt19937 random(static_cast<unsigned>(base_.seed()));
  const int pairs = wanted("SPINDRIFT_SEA_PAIRS", 4);
  for (int k = 0; k < pairs; ++k) {
    const Settings& one = moves[random() % single_count];
    const Settings& other = moves[random() % single_count];
    Settings both = {one.front(), other.front()};
    if (k % 2 == 0) both.front() = {kGravity, k % 4 == 0 ? 0.0 : 0.01};
    if (both[0].first != both[1].first) moves.push_back(both);
  }

  const int fidelities = wanted("SPINDRIFT_SEA_FIDELITIES", 1);
  int run_count = 0;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    what_ = textOf(moves[k]);
    SCOPED_TRACE(what_);
    ASSERT_TRUE(water_->setScene(base));
    const auto restored = water_->restore(start);
    ASSERT_TRUE(restored) << restored.error().message;
    recovered_count_ = water_->recoveredCount();
    if (!takes(base_, moves[k])) continue;  // a pair that the room refuses
    ++run_count;
    ASSERT_NO_FATAL_FAILURE(run(ticks));
    ASSERT_NO_FATAL_FAILURE(check());
    ASSERT_TRUE(water_->setScene(base)) << "back";
    ASSERT_NO_FATAL_FAILURE(run(ticks));
    ASSERT_NO_FATAL_FAILURE(check());
  }
  for (int k = 0; k < fidelities; ++k) {
    make(base);
    const auto restored = water_->restore(start);
    ASSERT_TRUE(restored) << restored.error().message;
    recovered_count_ = 0;
    const Settings move = k == 0 ? Settings{{kGravity, 0.0}} : moves[random() % moves.size()];
    const v1::Fidelity to = k % 2 == 1 ? v1::FIDELITY_FINE : level ? v1::FIDELITY_BALANCED : v1::FIDELITY_DRAFT;
    what_ = textOf(move) + "and " + v1::Fidelity_Name(to);
    SCOPED_TRACE(what_);
    if (!takes(base_, move)) continue;
    ASSERT_NO_FATAL_FAILURE(run(ticks));
    ASSERT_NO_FATAL_FAILURE(changeFidelity(move, to));
    ASSERT_NO_FATAL_FAILURE(run(ticks));
    ASSERT_NO_FATAL_FAILURE(check());
  }
  std::printf("%d changes, %d of fidelity; %.2f m high before, at most %.2f m (%s)\n", run_count, fidelity_count_,
              usual_m, highest_seen_m_, highest_at_.c_str());
  EXPECT_LE(highest_seen_m_, 1.2 * usual_m + highest_sea_m_ + kRise_m) << highest_at_;
  EXPECT_GE(run_count, 4);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SeaParameters, ::testing::ValuesIn(sceneNames(Which::kAll)),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace spindrift
