#include "outbox.h"

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
  if (!slot.gate) return {};
  const bool is_pending = slot.frame != nullptr;
  const bool can_continue = slot.follows && !is_pending && frame.continuing;
  const core::SharedBytes& message = can_continue ? frame.continuing : frame.whole;
  if (!message) {
    slot.follows = false;
    if (!is_pending) return {};
    slot.frame.reset();
    slot.lost_turn = turn_count_;
    return {.dropped = true};
  }
  if (!slot.gate->pass(now)) {
    slot.follows = false;  // an unsent frame goes out, this one does not
    return {};
  }
  slot.frame = message;
  slot.follows = true;
  slot.lost_turn.reset();
  return {.wake = takeWake(), .dropped = is_pending};
}

bool Outbox::wantsWhole(LayerIndex layer, Clock::time_point now) const {
  const std::lock_guard lock(mutex_);
  if (close_ || shut_ || layer >= kMaxLayerCount) return false;
  const Slot& slot = slots_[layer];
  return slot.gate && !slot.frame && !slot.follows && slot.lost_turn != turn_count_ && slot.gate->isOpen(now);
}

void Outbox::setWatch(LayerIndex layer, std::optional<double> max_rate_hz) {
  const std::lock_guard lock(mutex_);
  if (layer >= kMaxLayerCount) return;
  slots_[layer] = {};  // whoever asks again, perhaps for want of a frame, begins with a whole one
  if (max_rate_hz) slots_[layer].gate.emplace(*max_rate_hz);
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
