#include "room_recording.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <spdlog/spdlog.h>

namespace spindrift::service {
namespace {

using WallClock = recording::WaterRecorder::WallClock;

/// Chunks that have waited long enough are written this often, and the time is looked at.
constexpr std::chrono::milliseconds kReviewInterval{100};

}  // namespace

RoomRecording::RoomRecording(RoomRecordingSetup setup, std::unique_ptr<recording::WaterRecorder> recorder,
                             const core::SharedBytes& greeting)
    : setup_(std::move(setup)), recorder_(std::move(recorder)) {
  for (const codec::Stream stream : setup_.streams) slots_.push_back({.stream = stream});
  state_.set_name(setup_.name);
  state_.set_room(setup_.room);
  state_.set_running(true);
  setCounts();
  push(greeting);
  setup_.demand->addSessions(1);  // the room stays awake
  for (const Slot& slot : slots_) tellNeed(slot);
  thread_ = std::thread([this] { loop(); });
}

RoomRecording::~RoomRecording() {
  end("the server ended");
  thread_.join();
}

bool RoomRecording::isRunning() const {
  const std::lock_guard lock(mutex_);
  return state_.running();
}

v1::Recording RoomRecording::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

void RoomRecording::end(const std::string& why, std::function<void()> done) {
  {
    const std::lock_guard lock(mutex_);
    if (state_.running()) {
      if (!end_) {
        end_ = why;
        end_by_ = std::chrono::steady_clock::now() + kEndMax;
      }
      if (done) done_.push_back(std::exchange(done, nullptr));
    }
  }
  wake_.notify_one();
  if (done) done();
}

// From the room

bool RoomRecording::push(const core::SharedBytes& message) {
  if (waiting_.size() >= kWaitingMaxCount || waiting_bytes_ + message->size() > kWaitingMaxBytes) {
    state_.set_dropped_count(state_.dropped_count() + 1);
    return false;
  }
  waiting_.push_back(message);
  waiting_bytes_ += message->size();
  return true;
}

void RoomRecording::tell(const core::SharedBytes& message) {
  {
    const std::lock_guard lock(mutex_);
    if (!state_.running() || end_) return;
    push(message);
  }
  wake_.notify_one();
}

void RoomRecording::publish(codec::Stream stream, const codec::EncodedFrame& frame, const core::FrameLevels& levels) {
  if (!levels.isOf(setup_.level)) return;
  {
    const std::lock_guard lock(mutex_);
    const auto slot = std::ranges::find(slots_, codec::indexOf(stream),
                                        [](const Slot& known) { return codec::indexOf(known.stream); });
    if (slot == slots_.end() || !state_.running() || end_) return;
    const bool can_follow = slot->follows && slot->level == levels.level && frame.delta;
    const bool takes_delta = can_follow && !(slot->wants_keyframe && frame.keyframe);
    const core::SharedBytes& message = takes_delta ? frame.delta : frame.keyframe;
    slot->follows = message && levels.due.contains(setup_.level) && push(message);
    slot->level = levels.level;
    if (slot->follows && !takes_delta) slot->wants_keyframe = false;
    tellNeed(*slot);
  }
  wake_.notify_one();
}

void RoomRecording::tellNeed(const Slot& slot) {
  core::DemandTable::Need need{.level = setup_.level};
  const bool has_room = waiting_bytes_ < kWaitingMaxBytes / 2 && waiting_.size() < kWaitingMaxCount / 2;
  if ((!slot.follows || slot.wants_keyframe) && has_room) need.keyframe_from = core::DemandTable::TimePoint{};
  setup_.demand->set(codec::indexOf(slot.stream), &slot, need);
}

// The thread

void RoomRecording::setCounts() {
  const auto counts = recorder_->counts();
  state_.set_message_count(counts.message_count);
  state_.set_skipped_count(counts.skipped_count);
  state_.set_written_bytes(counts.written_bytes);
  const auto& files = recorder_->files();
  for (auto k = static_cast<std::size_t>(state_.files_size()); k < files.size(); ++k) state_.add_files(files[k]);
}

core::Result<std::string> RoomRecording::record() {
  auto next_review = std::chrono::steady_clock::now();
  while (true) {
    core::SharedBytes message;
    {
      std::unique_lock lock(mutex_);
      wake_.wait_until(lock, next_review, [&] { return end_ || !waiting_.empty(); });
      if (end_ && (waiting_.empty() || std::chrono::steady_clock::now() >= end_by_)) {
        state_.set_dropped_count(state_.dropped_count() + waiting_.size());
        return *end_;
      }
      if (!waiting_.empty()) {
        message = std::move(waiting_.front());
        waiting_.pop_front();
        waiting_bytes_ -= message->size();
      }
    }
    if (message) {
      if (auto taken = recorder_->take(*message, WallClock::now()); !taken) return taken.error();
    }
    if (const auto now = std::chrono::steady_clock::now(); now >= next_review) {
      next_review = now + kReviewInterval;
      if (auto reviewed = recorder_->review(WallClock::now()); !reviewed) return reviewed.error();
      const std::lock_guard lock(mutex_);
      setCounts();
    }
    if (recorder_->takeKeyframeWish()) {
      const std::lock_guard lock(mutex_);
      for (Slot& slot : slots_) {
        slot.wants_keyframe = true;
        tellNeed(slot);
      }
    }
    if (recorder_->end()) return *recorder_->end();
  }
}

void RoomRecording::loop() {
  const auto recorded = record();
  const auto finished = recorder_->finish();
  const bool failed = !recorded || !finished;
  const std::string why = !recorded ? recorded.error().message : failed ? finished.error().message : *recorded;
  std::vector<std::function<void()>> done;
  {
    const std::lock_guard lock(mutex_);
    state_.set_running(false);
    state_.set_ended(why);
    state_.set_failed(failed);
    setCounts();
    for (const Slot& slot : slots_) setup_.demand->set(codec::indexOf(slot.stream), &slot, std::nullopt);
    setup_.demand->addSessions(-1);
    waiting_.clear();
    waiting_bytes_ = 0;
    done = std::move(done_);
  }
  const v1::Recording now = state();
  spdlog::log(failed ? spdlog::level::err : spdlog::level::info,
              "room {}: the recording {} has ended: {}; {} messages, {} bytes, {} files, {} dropped", setup_.room,
              now.name(), why, now.message_count(), now.written_bytes(), now.files_size(), now.dropped_count());
  for (const auto& call : done) call();
}

}  // namespace spindrift::service
