#include <algorithm>

#include <spindrift/rooms/tick_cost.h>

namespace spindrift::rooms {
namespace {

double ratio(double wanted, double now) {
  return now > 0.0 ? wanted / now : 1.0;
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
    const double side_count = derived.wave->resolution_count;
    out.wave_step_count = side_count * side_count * derived.wave->substeps_count;
  }
  return out;
}

void TickCost::note(double tick_ms) {
  constexpr double kNewShare = 0.1;
  tick_ms_ = tick_ms_ == 0.0 ? tick_ms : (1.0 - kNewShare) * tick_ms_ + kNewShare * tick_ms;
}

double TickCost::predict_ms(const TickWork& now, const TickWork& wanted) const {
  return tick_ms_ * std::max({1.0, ratio(wanted.particle_step_count, now.particle_step_count),
                              ratio(wanted.wave_step_count, now.wave_step_count)});
}

}  // namespace spindrift::rooms
