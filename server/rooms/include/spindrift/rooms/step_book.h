// Step commands with `waits`: they are answered when their ticks are done, or when something ends them before.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <spindrift/rooms/command.h>

namespace spindrift::rooms {

/// Limit of those that wait, of one session and of all requests.
inline constexpr std::size_t kWaitingStepMaxCount = 64;

class StepBook {
 public:
  [[nodiscard]] bool isFull(const core::Sender& sender) const {
    return std::ranges::count(waiting_, sender.session_id, [](const Waiting& one) {
             return one.command.sender.session_id;
           }) >= static_cast<std::ptrdiff_t>(kWaitingStepMaxCount);
  }
  /// `tick_count`: until the last of its ticks.
  void enter(Command command, std::uint32_t tick_count) { waiting_.push_back({std::move(command), tick_count}); }
  /// A tick was made.
  void ticked() {
    for (Waiting& one : waiting_) --one.ticks_to_come;
  }
  /// Ends those for which `holds` returns true. `why`: one line for their senders.
  void endIf(const std::string& why, const std::function<bool(const core::Sender&)>& holds) {
    for (Command& command : take([&](const Waiting& one) { return holds(one.command.sender); }))
      ended_.push_back({std::move(command), why});
  }
  void endAll(const std::string& why) {
    endIf(why, [](const core::Sender&) { return true; });
  }

  /// Takes those whose ticks are done, oldest first.
  [[nodiscard]] std::vector<Command> takeDone() {
    return take([](const Waiting& one) { return one.ticks_to_come == 0; });
  }
  struct Ended {
    Command command;
    std::string why;
  };
  [[nodiscard]] std::vector<Ended> takeEnded() { return std::exchange(ended_, {}); }

 private:
  struct Waiting {
    Command command;
    std::uint32_t ticks_to_come = 0;
  };
  std::vector<Command> take(const std::function<bool(const Waiting&)>& is_taken) {
    const auto taken =
        std::stable_partition(waiting_.begin(), waiting_.end(), [&](const Waiting& one) { return !is_taken(one); });
    std::vector<Command> out;
    for (auto one = taken; one != waiting_.end(); ++one) out.push_back(std::move(one->command));
    waiting_.erase(taken, waiting_.end());
    return out;
  }

  std::vector<Waiting> waiting_;  ///< oldest first
  std::vector<Ended> ended_;      ///< of which nobody was told
};

}  // namespace spindrift::rooms
