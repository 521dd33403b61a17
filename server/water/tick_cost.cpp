#include <algorithm>

#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/water/tick_cost.h>

namespace spindrift::water {
namespace {

/// 0 if neither has this part.
double ratio(double wanted, double now) {
  return now > 0.0 ? wanted / now : wanted > 0.0 ? 1.0 : 0.0;
}

bool isAtMost(const TickWork& a, const TickWork& b) {
  return a.particle_step_count <= b.particle_step_count && a.wave_step_count <= b.wave_step_count;
}

}  // namespace

TickWork workOf(const core::Scene& scene, const sim::Derived& derived) {
  TickWork out{.tick_s = derived.tick_s};
  if (derived.particles && scene.particles) {
    const bool iterates = scene.particles->solver == core::PressureSolver::kPositionBased;
    const double passes_count = 1.0 + (iterates ? scene.particles->iterations_count : 0);
    out.particle_step_count = passes_count * static_cast<double>(derived.particles->count) * derived.substeps_count;
  }
  if (derived.wave) {
    out.wave_step_count = static_cast<double>(derived.wave->counts().total()) * derived.wave->substeps_count;
  }
  return out;
}

void TickCost::restart(double tick_ms, const TickWork& now) {
  tick_ms_ = most_ms_ = tick_ms;
  work_ = most_work_ = now;
}

void TickCost::note(double tick_ms) {
  constexpr double kNewShare = 0.1;
  tick_ms_ = tick_ms_ == 0.0 ? tick_ms : (1.0 - kNewShare) * tick_ms_ + kNewShare * tick_ms;
  if (!isAtMost(most_work_, work_)) return;
  most_work_ = work_;
  most_ms_ = tick_ms_;
}

void TickCost::workChanged(const TickWork& now) {
  tick_ms_ = estimate_ms(now);
  work_ = now;
}

double TickCost::predict_ms(const TickWork& wanted) const {
  return std::max(tick_ms_, estimate_ms(wanted));
}

double TickCost::estimate_ms(const TickWork& wanted) const {
  const double share = std::max(ratio(wanted.particle_step_count, work_.particle_step_count),
                                ratio(wanted.wave_step_count, work_.wave_step_count));
  const double scaled_ms = share > 0.0 ? tick_ms_ * share : tick_ms_;
  return isAtMost(wanted, most_work_) ? std::min(scaled_ms, most_ms_) : scaled_ms;
}

core::Result<v1::Scene> sceneAt(const SceneCatalog& scenes, const v1::Scene& now, v1::Fidelity level) {
  auto scene = scenes.load(now.name(), level);
  if (!scene) return scene;
  scene::keepParameters(now, *scene);
  scene->set_seed(now.seed());
  // Waters that began before their scene had floaters continue without.
  if (!now.has_floaters()) scene->clear_floaters();
  return scene;
}

core::Result<TickWork> workAt(const SceneCatalog& scenes, const v1::Scene& now, v1::Fidelity level) {
  const auto scene = sceneAt(scenes, now, level);
  if (!scene) return scene.error();
  const core::Scene wanted = scene::toCore(*scene);
  const auto derived = sim::derive(wanted);
  if (!derived) return derived.error();
  return workOf(wanted, *derived);
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
    const TickWork& work = works_[static_cast<std::size_t>(i)];
    const bool is_present = level.fidelity() == present_;
    level.set_cost_ms_per_s((is_present ? cost.tick_ms() : cost.estimate_ms(work)) / work.tick_s);
  }
  return out;
}

}  // namespace spindrift::water
