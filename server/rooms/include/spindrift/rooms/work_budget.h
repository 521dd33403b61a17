// Limits the share of a room's wall time for a kind of work. The caller passes the time in; no clock is read.
#pragma once

#include <algorithm>
#include <chrono>

namespace spindrift::rooms {

/// A token bucket of time. `share` seconds are added per second, up to `burst`. Work may start while the balance is
/// positive and may overdraw it, since its cost is known only afterwards; the next work then waits until the debt is
/// paid.
class WorkBudget {
 public:
  using Clock = std::chrono::steady_clock;

  WorkBudget(double share, Clock::duration burst) : share_(share), burst_(burst), left_(burst) {}

  [[nodiscard]] bool isOpen(Clock::time_point now) {
    const auto gained = std::chrono::duration_cast<Clock::duration>((now - updated_) * share_);
    left_ = updated_ == Clock::time_point{} ? burst_ : std::min(burst_, left_ + gained);
    updated_ = now;
    return left_ > Clock::duration{};
  }
  void spend(Clock::duration cost) { left_ -= cost; }

 private:
  double share_;
  Clock::duration burst_;
  Clock::duration left_;
  Clock::time_point updated_{};
};

}  // namespace spindrift::rooms
