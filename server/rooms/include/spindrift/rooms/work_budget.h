// How much of a room's wall time a kind of work may take: plain arithmetic on a time that the caller passes in.
#pragma once

#include <algorithm>
#include <chrono>

namespace spindrift::rooms {

/// A bucket of time. `share` seconds flow in per second, at most `burst` stays. Work begins while something is left and
/// may overdraw: its cost is known only afterwards, and the next work waits until the debt is paid.
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
