#include <algorithm>

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
  TickWork out;
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

}  // namespace spindrift::water
