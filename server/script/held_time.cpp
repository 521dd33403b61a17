#include "held_time.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace spindrift::script {
namespace {

/// As many ticks as one Step can ask for.
constexpr std::uint64_t kStepMaxCount = 600;
/// A script waits for its ticks on a machine of any speed. What ends sooner is the connection.
constexpr double kTickHeldAnswerPatience_s = 10.0;
constexpr double kHeldAnswerPatience_s = 60.0;
/// The longest time-out that TakeClock has.
constexpr double kTimeout_s = 600.0;

Outcome failure(const std::string& what, const v1::ServerMessage& answer) {
  return {false,
          fmt::format("{}: {} {}", what, v1::RejectReason_Name(answer.reject().reason()), answer.reject().message())};
}

}  // namespace

Outcome HeldTime::begin() {
  Outcome out;
  v1::Command take;
  take.mutable_take_clock()->set_timeout_s(kTimeout_s);
  const v1::ServerMessage* answer = ask_(holder_, std::move(take), kHeldAnswerPatience_s, out);
  if (!answer) return out;
  if (!answer->has_ack()) return failure("the clock was not given", *answer);
  v1::Command reset;
  reset.mutable_reset()->set_seed(seed_);
  answer = ask_(holder_, std::move(reset), kHeldAnswerPatience_s, out);
  if (!answer) return out;
  if (!answer->has_ack()) return failure("the scene did not begin again", *answer);
  commandApplied(answer->ack().applied_tick());
  return {true, ""};
}

Outcome HeldTime::advanceTo(double at_s) {
  return advanceBy(at_s - made_s_);
}

Outcome HeldTime::advanceBy(double duration_s) {
  const long long count = std::llround(duration_s / tick_s());
  return make(count > 0 ? static_cast<std::uint64_t>(count) : 0);
}

Outcome HeldTime::settle() {
  return make(has_changed_ ? 1 : 0);
}

void HeldTime::commandApplied(std::uint64_t tick) {
  tick_ = std::max(tick_, tick);
  has_changed_ = true;
}

Outcome HeldTime::make(std::uint64_t tick_count) {
  while (tick_count > 0) {
    const std::uint64_t count = std::min(tick_count, kStepMaxCount);
    v1::Command command;
    command.mutable_step()->set_tick_count(static_cast<std::uint32_t>(count));
    command.mutable_step()->set_waits(true);
    Outcome out;
    const v1::ServerMessage* answer =
        ask_(holder_, std::move(command),
             kHeldAnswerPatience_s + kTickHeldAnswerPatience_s * static_cast<double>(count), out);
    if (!answer) return out;
    if (!answer->has_ack()) return failure(fmt::format("{} ticks were not made", count), *answer);
    if (!answer->ack().has_state_hash()) return {false, "the server does not tell the hash of its state: update it"};
    tick_ = answer->ack().applied_tick();
    hash_ = answer->ack().state_hash();
    has_changed_ = false;
    made_count_ += count;
    made_s_ += static_cast<double>(count) * tick_s();
    tick_count -= count;
  }
  return {true, ""};
}

}  // namespace spindrift::script
