#include "outbox.h"

#include <algorithm>
#include <utility>

namespace spindrift::net {

Outbox::Outcome Outbox::pushControl(core::SharedBytes message) {
  const std::lock_guard lock(mutex_);
  if (close_ || shut_) return {};
  if (control_.size() >= control_queue_count_) {
    close_ = SessionEnd{static_cast<std::uint16_t>(CloseCode::kTryAgainLater),
                        "more than " + std::to_string(control_queue_count_) + " control messages wait: read faster"};
    for (Slot& slot : slots_) slot.frame.reset();
    return {.wake = takeWake(), .overflow = true};
  }
  control_.push_back(std::move(message));
  return {.wake = takeWake()};
}

Outbox::Outcome Outbox::offerFrame(LayerIndex layer, const LayerBytes& frame, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (close_ || shut_ || layer >= kMaxLayerCount) return {};
  Slot& slot = slots_[layer];
  if (!slot.watch) return {};
  const core::Level wanted = levelOf(slot);
  if (core::effectiveLevel(wanted, frame.reduced_count) != frame.level) return {};
  slot.reduced_count = frame.reduced_count;
  const bool is_pending = slot.frame != nullptr;
  const bool is_due = isOpen(slot, wanted, frame.level, now);
  if (slot.watch->adapts && is_due) ladder_.noteFrame(is_pending || slot.lost_turn);
  const bool can_continue = slot.follows && slot.level == frame.level && !is_pending && frame.continuing;
  const core::SharedBytes& message = can_continue ? frame.continuing : frame.whole;
  if (!message) {
    slot.follows = false;
    if (!is_pending) return {};
    slot.frame.reset();
    slot.lost_turn = turn_count_;
    return {.dropped = true};
  }
  if (!is_due) {
    slot.follows = false;  // an unsent frame goes out, this one does not
    return {};
  }
  slot.gate.pass(now);
  if (wanted != frame.level) slot.level_gates[indexOf(wanted)].pass(now);
  slot.frame = message;
  slot.level = frame.level;
  slot.follows = true;
  slot.lost_turn.reset();
  return {.wake = takeWake(), .dropped = is_pending};
}

Outbox::Demand Outbox::demand(LayerIndex layer, std::uint32_t reduced_count, Clock::time_point now) const {
  const std::lock_guard lock(mutex_);
  if (layer >= kMaxLayerCount || !slots_[layer].watch) return {};
  const Slot& slot = slots_[layer];
  const core::Level wanted = levelOf(slot);
  const core::Level level = core::effectiveLevel(wanted, reduced_count);
  if (close_ || shut_) return {.level = level};
  const bool has_ground = slot.follows && slot.level == level;
  return {
      .level = level,
      .wants_whole = !slot.frame && !has_ground && slot.lost_turn != turn_count_ && isOpen(slot, wanted, level, now)};
}

core::Level Outbox::levelOf(const Slot& slot) const {
  return slot.watch->adapts ? std::min(slot.watch->level, ladder_.level()) : slot.watch->level;
}

bool Outbox::isOpen(const Slot& slot, core::Level wanted, core::Level effective, Clock::time_point now) {
  return slot.gate.isOpen(now) && (wanted == effective || slot.level_gates[indexOf(wanted)].isOpen(now));
}

void Outbox::setWatch(LayerIndex layer, const std::optional<Watch>& watch) {
  const std::lock_guard lock(mutex_);
  if (layer >= kMaxLayerCount) return;
  Slot& slot = slots_[layer];
  slot = {};  // whoever asks again, perhaps for want of a frame, begins with a whole one
  if (!watch) return;
  slot.watch = watch;
  slot.gate = RateGate(watch->max_rate_hz);
  for (std::size_t k = 0; k < slot.level_gates.size(); ++k)
    slot.level_gates[k] = RateGate(core::kLevelBudgets[k].rate_hz);
}

std::optional<core::Level> Outbox::reviewLevel(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  std::uint32_t reduced_count = 0;
  for (const Slot& slot : slots_) {
    if (slot.watch && slot.watch->adapts) reduced_count = std::max(reduced_count, slot.reduced_count);
  }
  return ladder_.review(now, reduced_count);
}

core::Level Outbox::level() const {
  const std::lock_guard lock(mutex_);
  return ladder_.level();
}

void Outbox::clearFrames() {
  const std::lock_guard lock(mutex_);
  for (Slot& slot : slots_) {
    slot.frame.reset();
    slot.follows = false;
  }
}

bool Outbox::requestClose(CloseCode code, std::string reason) {
  const std::lock_guard lock(mutex_);
  if (close_ || shut_) return false;
  close_ = SessionEnd{static_cast<std::uint16_t>(code), std::move(reason)};
  for (Slot& slot : slots_) slot.frame.reset();
  return true;
}

void Outbox::shut() {
  const std::lock_guard lock(mutex_);
  shut_ = true;
  control_.clear();
  for (Slot& slot : slots_) slot = {};
}

Outbox::Next Outbox::next() {
  const std::lock_guard lock(mutex_);
  writer_sleeps_ = false;
  ++turn_count_;
  if (shut_) return {Kind::kShut, nullptr};
  if (!control_.empty()) {
    Next out{Kind::kControl, std::move(control_.front())};
    control_.pop_front();
    return out;
  }
  if (close_) return {Kind::kClose, nullptr};
  for (std::size_t k = 0; k < slots_.size(); ++k) {
    const std::size_t layer = (turn_ + k) % slots_.size();
    if (!slots_[layer].frame) continue;
    turn_ = (layer + 1) % slots_.size();
    return {Kind::kFrame, std::exchange(slots_[layer].frame, nullptr)};
  }
  writer_sleeps_ = true;
  return {};
}

Outbox::Waiting Outbox::waiting() const {
  const std::lock_guard lock(mutex_);
  Waiting out{.control_count = control_.size()};
  for (const Slot& slot : slots_) out.frame_count += slot.frame ? 1 : 0;
  return out;
}

bool Outbox::closing() const {
  const std::lock_guard lock(mutex_);
  return close_.has_value();
}

std::optional<SessionEnd> Outbox::closeRequest() const {
  const std::lock_guard lock(mutex_);
  return close_;
}

bool Outbox::takeWake() {
  return std::exchange(writer_sleeps_, false);
}

}  // namespace spindrift::net
