#include <algorithm>

#include <spindrift/rooms/fidelity_governor.h>

namespace spindrift::rooms {

FidelityGovernor::Step FidelityGovernor::note(const Observation& seen, const std::function<double()>& load_above) {
  const double now_s = seen.now_s;
  if (rose_s_ >= 0 && now_s - rose_s_ >= kHolds_s) {
    rose_s_ = -1.0;
    calm_patience_s_ = kCalmPatience_s;
  }
  if (seen.is_building) settled_s_ = std::max(settled_s_, now_s + kSettle_s);
  if (seen.pace <= 0 || now_s < settled_s_) {
    slow_since_s_ = calm_since_s_ = -1.0;
    return Step::kNone;
  }
  if (seen.pace < kSlowPace) {
    calm_since_s_ = -1.0;
    if (slow_since_s_ < 0) slow_since_s_ = now_s;
    return seen.can_fall && now_s - slow_since_s_ >= kSlowPatience_s ? Step::kDown : Step::kNone;
  }
  slow_since_s_ = -1.0;
  if (seen.pace < kFullPace) {
    calm_since_s_ = -1.0;
    return Step::kNone;
  }
  if (calm_since_s_ < 0) calm_since_s_ = now_s;
  if (!seen.can_rise || now_s - calm_since_s_ < calm_patience_s_) return Step::kNone;
  if (load_above() <= kLoadMax) return Step::kUp;
  calm_since_s_ = now_s;  // ask again after as long
  return Step::kNone;
}

void FidelityGovernor::changed(double now_s, Step step) {
  const bool did_not_hold = step == Step::kDown && rose_s_ >= 0;
  if (did_not_hold) calm_patience_s_ = std::min(2 * calm_patience_s_, kCalmPatienceMax_s);
  rose_s_ = step == Step::kUp ? now_s : -1.0;
  if (step == Step::kNone) calm_patience_s_ = kCalmPatience_s;
  settle(now_s);
}

void FidelityGovernor::failed(double now_s) {
  calm_patience_s_ = std::min(2 * calm_patience_s_, kCalmPatienceMax_s);
  settle(now_s + calm_patience_s_);
}

void FidelityGovernor::settle(double from_s) {
  settled_s_ = from_s + kSettle_s;
  slow_since_s_ = calm_since_s_ = -1.0;
}

}  // namespace spindrift::rooms
