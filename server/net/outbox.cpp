#include "outbox.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace spindrift::net {

Outbox::Outcome Outbox::pushAnswer(core::SharedBytes message) {
  const std::lock_guard lock(mutex_);
  if (close_ || shut_) return {};
  if (answer_count_ >= answer_max_count_) {
    beginClose(CloseCode::kTryAgainLater, std::to_string(answer_max_count_) + " answers wait to be read: read faster");
    return {.wake = takeWake(), .overflow = true};
  }
  control_.push_back({std::move(message), std::nullopt});
  ++answer_count_;
  return {.wake = takeWake()};
}

Outbox::Outcome Outbox::pushState(const StateTopic& topic, core::SharedBytes message) {
  using Scope = StateTopic::Scope;
  const std::lock_guard lock(mutex_);
  if (close_ || shut_) return {};
  const auto is_replaced = [&](const Control& waiting) {
    if (!waiting.topic) return false;
    return waiting.topic->name == topic.name || (topic.scope == Scope::kWhole && waiting.topic->scope == Scope::kPart);
  };
  if (topic.scope == Scope::kWhole) whole_state_waits_ = true;
  const auto place = std::ranges::find_if(control_, is_replaced);
  if (place == control_.end()) {
    control_.push_back({std::move(message), topic});
  } else {
    *place = {std::move(message), topic};
    control_.erase(std::remove_if(std::next(place), control_.end(), is_replaced), control_.end());
  }
  return {.wake = takeWake()};
}

Outbox::Outcome Outbox::offerFrame(StreamIndex stream, const FrameBytes& frame, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (close_ || shut_ || stream >= kMaxStreamCount || !slots_[stream].watch) return {};
  const Outcome out = put(stream, frame, now);
  tellNeed(stream);
  return out;
}

Outbox::Outcome Outbox::put(StreamIndex stream, const FrameBytes& frame, Clock::time_point now) {
  Slot& slot = slots_[stream];
  const core::Level wanted = levelOf(slot);
  const core::FrameLevels& levels = frame.levels;
  if (!levels.isOf(wanted)) return {};
  slot.reduced_count = levels.reduced_count;
  const bool is_pending = slot.frame != nullptr;
  const bool is_due = levels.due.contains(wanted) && slot.gate.isOpen(now);
  if (slot.watch->adapts && is_due) ladder_.noteFrame(is_pending || slot.lost_turn);
  const bool can_continue = slot.follows && slot.level == levels.level && !is_pending && frame.delta;
  const core::SharedBytes& message = can_continue ? frame.delta : frame.keyframe;
  if (!message) {
    slot.follows = false;
    if (!is_pending) return {};
    slot.frame.reset();
    slot.lost_turn = turn_count_;
    has_lost_turns_ = true;
    return {.dropped = true};
  }
  if (!is_due) {
    slot.follows = false;  // an unsent frame is still sent, this one is not
    return {};
  }
  slot.gate.pass(now);
  slot.lost_turn.reset();
  fill(stream, frame, message);
  return {.dropped = is_pending};
}

bool Outbox::wakeForFrames() {
  const std::lock_guard lock(mutex_);
  return nextStream() && takeWake();
}

Outbox::Outcome Outbox::offerNewest(StreamIndex stream, const FrameBytes& frame) {
  const std::lock_guard lock(mutex_);
  if (close_ || shut_ || stream >= kMaxStreamCount || !slots_[stream].watch) return {};
  const Outcome out = putNewest(stream, frame);
  tellNeed(stream);
  return out;
}

Outbox::Outcome Outbox::putNewest(StreamIndex stream, const FrameBytes& frame) {
  Slot& slot = slots_[stream];
  if (!slot.is_newcomer || !frame.keyframe || !frame.levels.isOf(levelOf(slot))) return {};
  slot.reduced_count = frame.levels.reduced_count;
  fill(stream, frame, frame.keyframe);
  return {.wake = takeWake()};
}

void Outbox::fill(StreamIndex stream, const FrameBytes& frame, const core::SharedBytes& message) {
  Slot& slot = slots_[stream];
  slot.frame = message;
  slot.level = frame.levels.level;
  slot.follows = true;
  slot.is_newcomer = false;
  filled_slots_ |= static_cast<StreamBits>(1U << stream);
}

// What the session needs

void Outbox::enterRoom(std::shared_ptr<core::DemandTable> demand) {
  const std::lock_guard lock(mutex_);
  if (demand_) {
    for (std::size_t stream = 0; stream < kMaxStreamCount; ++stream) {
      if (std::exchange(told_needs_[stream], std::nullopt)) demand_->set(stream, &slots_[stream], std::nullopt);
    }
    demand_->addSessions(-1);
    for (Slot& slot : slots_) {
      slot.frame.reset();
      slot.follows = slot.is_newcomer = false;
    }
  }
  demand_ = std::move(demand);
  if (!demand_) return;
  demand_->addSessions(1);
  tellNeeds();
}

std::optional<core::DemandTable::Need> Outbox::need(StreamIndex stream) const {
  const std::lock_guard lock(mutex_);
  return stream < kMaxStreamCount ? needOf(slots_[stream]) : std::nullopt;
}

std::optional<core::DemandTable::Need> Outbox::needOf(const Slot& slot) const {
  if (!slot.watch) return std::nullopt;
  core::DemandTable::Need out{.level = levelOf(slot), .is_newcomer = slot.is_newcomer};
  const bool has_ground = slot.follows && slot.level == core::effectiveLevel(out.level, slot.reduced_count);
  if (!close_ && !slot.frame && !has_ground && slot.lost_turn != turn_count_) out.keyframe_from = slot.gate.opens();
  return out;
}

void Outbox::tellNeed(std::size_t stream) {
  if (!demand_) return;
  auto need = needOf(slots_[stream]);
  if (need == told_needs_[stream]) return;
  demand_->set(stream, &slots_[stream], need);
  told_needs_[stream] = need;
}

void Outbox::tellNeeds() {
  for (std::size_t stream = 0; stream < kMaxStreamCount; ++stream) tellNeed(stream);
}

core::Level Outbox::levelOf(const Slot& slot) const {
  return slot.watch->adapts ? std::min(slot.watch->level, ladder_.level()) : slot.watch->level;
}

void Outbox::setWatch(StreamIndex stream, const std::optional<Watch>& watch) {
  const std::lock_guard lock(mutex_);
  if (stream >= kMaxStreamCount) return;
  Slot& slot = slots_[stream];
  slot = {};  // a new watch, also one to recover from a loss, starts with a keyframe
  if (watch) {
    slot.watch = watch;
    slot.is_newcomer = watch->is_first;
    slot.gate = RateGate(watch->max_rate_hz);
  }
  tellNeed(stream);
}

std::optional<core::Level> Outbox::reviewLevel(Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (!ladder_.isDue(now)) return std::nullopt;
  std::uint32_t reduced_count = 0;
  for (const Slot& slot : slots_) {
    if (slot.watch && slot.watch->adapts) reduced_count = std::max(reduced_count, slot.reduced_count);
  }
  const auto changed = ladder_.review(now, reduced_count);
  if (changed) tellNeeds();
  return changed;
}

bool Outbox::requestClose(CloseCode code, std::string reason) {
  const std::lock_guard lock(mutex_);
  if (close_ || shut_) return false;
  beginClose(code, std::move(reason));
  return true;
}

void Outbox::beginClose(CloseCode code, std::string reason) {
  close_ = SessionEnd{static_cast<std::uint16_t>(code), std::move(reason)};
  for (Slot& slot : slots_) slot.frame.reset();
  tellNeeds();
}

void Outbox::shut() {
  const std::lock_guard lock(mutex_);
  shut_ = true;
  control_.clear();
  answer_count_ = 0;
  whole_state_waits_ = false;
  for (Slot& slot : slots_) slot = {};
  tellNeeds();
}

Outbox::Next Outbox::next() {
  const std::lock_guard lock(mutex_);
  writer_sleeps_ = false;
  ++turn_count_;
  if (std::exchange(has_lost_turns_, false)) tellNeeds();
  if (shut_) return {Kind::kShut, nullptr};
  const auto stream = nextStream();
  if (stream && isFrameBeforeControl()) return takeFrame(*stream);
  if (!control_.empty()) return takeControl();
  if (close_) return {Kind::kClose, nullptr};
  if (stream) return takeFrame(*stream);
  writer_sleeps_ = true;
  return {};
}

std::optional<Outbox::Next> Outbox::nextAlong(std::size_t max_bytes) {
  const std::lock_guard lock(mutex_);
  if (shut_) return std::nullopt;
  const auto stream = nextStream();
  if (control_.empty() || (stream && isFrameBeforeControl())) {
    if (!stream || slots_[*stream].frame->size() > max_bytes) return std::nullopt;
    return takeFrame(*stream);
  }
  if (control_.front().message->size() > max_bytes) return std::nullopt;
  return takeControl();
}

bool Outbox::isFrameBeforeControl() const {
  // A frame may belong to the scene of a waiting greeting, so it must not overtake the greeting.
  return control_run_count_ >= kControlRunMaxCount && !whole_state_waits_ && !close_;
}

Outbox::Next Outbox::takeControl() {
  const Control taken = std::move(control_.front());
  control_.pop_front();
  ++control_run_count_;
  if (!taken.topic) --answer_count_;
  if (taken.topic && taken.topic->scope == StateTopic::Scope::kWhole) whole_state_waits_ = false;
  return {Kind::kControl, taken.message};
}

std::optional<std::size_t> Outbox::nextStream() {
  while (filled_slots_ != 0) {
    const auto ahead = static_cast<std::size_t>(std::countr_zero(std::rotr(filled_slots_, static_cast<int>(turn_))));
    const std::size_t stream = (turn_ + ahead) % slots_.size();
    if (slots_[stream].frame) return stream;
    filled_slots_ &= static_cast<StreamBits>(~(1U << stream));
  }
  return std::nullopt;
}

Outbox::Next Outbox::takeFrame(std::size_t stream) {
  turn_ = (stream + 1) % slots_.size();
  control_run_count_ = 0;
  Next out{Kind::kFrame, std::exchange(slots_[stream].frame, nullptr)};
  tellNeed(stream);
  return out;
}

Waiting Outbox::waiting() const {
  const std::lock_guard lock(mutex_);
  Waiting out{.answer_count = answer_count_, .state_count = control_.size() - answer_count_};
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
