#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/sim_setup/derive.h>
#include <spindrift/water/level_costs.h>

namespace spindrift::water {

core::Result<v1::Scene> sceneAt(const SceneCatalog& scenes, const v1::Scene& now, v1::Fidelity level) {
  auto scene = scenes.load(now.name(), level);
  if (scene) scene::keepParameters(now, *scene);
  return scene;
}

core::Result<LevelWork> workAt(const SceneCatalog& scenes, const v1::Scene& now, v1::Fidelity level) {
  const auto scene = sceneAt(scenes, now, level);
  if (!scene) return scene.error();
  const core::Scene wanted = scene::toCore(*scene);
  const auto derived = sim::derive(wanted);
  if (!derived) return derived.error();
  return LevelWork{workOf(wanted, *derived), derived->tick_s};
}

LevelCosts::LevelCosts(const SceneCatalog& scenes, const v1::Scene& now) : present_(now.fidelity()) {
  if (!scenes.has(now.name())) return;
  const v1::FidelityErrorsOfScene* const errors = scenes.errorsOf(now.name());
  if (errors) levels_.set_errors_measured_on(scenes.errorsMeasuredOn());
  for (const v1::Fidelity level : scene::kFidelities) {
    const auto work = workAt(scenes, now, level);
    if (!work) continue;
    works_.push_back(*work);
    v1::FidelityLevel& out = *levels_.add_levels();
    out.set_fidelity(level);
    if (errors) out.set_error_ratio(errors->error_ratios(static_cast<int>(scene::rankOf(level))));
  }
}

v1::FidelityLevels LevelCosts::predict(const TickCost& cost) const {
  v1::FidelityLevels out = levels_;
  for (int i = 0; i < out.levels_size(); ++i) {
    v1::FidelityLevel& level = *out.mutable_levels(i);
    const LevelWork& work = works_[static_cast<std::size_t>(i)];
    const bool is_present = level.fidelity() == present_;
    level.set_cost_ms_per_s((is_present ? cost.tick_ms() : cost.estimate_ms(work.per_tick)) / work.tick_s);
  }
  return out;
}

}  // namespace spindrift::water
