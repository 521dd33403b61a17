#include <condition_variable>
#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/history/state_keeper.h>

namespace spindrift::history {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// After a failed write the next snapshot is tried this much later.
constexpr auto kRetryPause = 1s;
constexpr auto kSameErrorPause = 60s;
/// Of the records since the newest state in memory. Beyond it, a device that fails costs the room its state.
constexpr std::size_t kRememberedMaxBytes = 16u << 20;

using core::viewOf;

}  // namespace

struct StateKeeper::Shared {
  std::string room;
  state::FolderLock room_lock;  ///< before the files, which end first
  std::unique_ptr<state::RoomFiles> files;
  mutable std::mutex mutex;
  std::condition_variable finished;
  bool is_writing = false;
  core::Result<void> outcome;  ///< of the last snapshot
  /// Why the log lacks something that happened. A snapshot of a later state holds it.
  std::optional<std::string> gap;
  std::uint64_t gap_count = 0;               ///< gaps since the start
  std::optional<Clock::time_point> retry{};  ///< of the snapshot, after one failed or a gap opened
  std::string logged_error;
  std::string logged_removal;
  Clock::time_point logged_at{};
  std::uint64_t snapshot_count = 0;
  std::uint64_t failure_count = 0;
  Clock::time_point newest_copy = Clock::now();
  double copy_s = 0.0;
  double write_s = 0.0;

  /// `known_gap_count`: gaps that had opened when the state was copied.
  void write(const state::StatePoint& point, const v1::KeptState& state, Clock::time_point copied,
             std::uint64_t known_gap_count) {
    const auto begin = Clock::now();
    auto written = files->writeSnapshot(point, viewOf(state.SerializeAsString()));
    const double duration_s = std::chrono::duration<double>(Clock::now() - begin).count();
    const auto removed = written ? files->removeOldGenerations() : core::Result<void>();
    const std::lock_guard lock(mutex);
    write_s = duration_s;
    if (written) {
      ++snapshot_count;
      newest_copy = copied;
      if (known_gap_count == gap_count) {
        gap.reset();
        retry.reset();
      }
    }
    end(std::move(written));
    const std::string removal = removed ? "" : removed.error().message;
    if (std::exchange(logged_removal, removal) == removal || removed) return;
    ++failure_count;
    spdlog::error("room {}: older files of its state are left behind: {}", room, removal);
  }

  /// The mutex is held.
  void end(core::Result<void> how) {
    if (how) {
      if (!std::exchange(logged_error, {}).empty()) spdlog::info("room {}: its state is kept on disk again", room);
    } else {
      note(how.error());
      retry = Clock::now() + kRetryPause;
    }
    outcome = std::move(how);
    is_writing = false;
    finished.notify_all();
  }

  /// The mutex is held.
  void note(const core::Error& error) {
    ++failure_count;
    const auto now = Clock::now();
    if (logged_error == error.message && now - logged_at < kSameErrorPause) return;
    logged_error = error.message;
    logged_at = now;
    spdlog::error("room {}: its state cannot be kept on disk: {}", room, error.message);
  }
};

StateKeeper::StateKeeper(std::string room, std::unique_ptr<state::RoomFiles> files, std::chrono::milliseconds interval,
                         core::Worker& writer, state::FolderLock lock)
    : room_(std::move(room)), interval_(interval), writer_(writer), shared_(std::make_shared<Shared>()) {
  shared_->room = room_;
  shared_->room_lock = std::move(lock);
  shared_->files = std::move(files);
}

StateKeeper::~StateKeeper() {
  finish();
}

void StateKeeper::finish() const {
  std::unique_lock lock(shared_->mutex);
  shared_->finished.wait(lock, [this] { return !shared_->is_writing; });
}

std::optional<core::Result<void>> StateKeeper::outcome(TimePoint deadline) const {
  std::unique_lock lock(shared_->mutex);
  if (!shared_->finished.wait_until(lock, deadline, [this] { return !shared_->is_writing; })) return std::nullopt;
  return shared_->outcome;
}

core::Result<void> StateKeeper::append(const v1::Record& record) {
  const std::string bytes = record.SerializeAsString();
  auto appended = shared_->files->append(viewOf(bytes));
  if (appended) {
    records_bytes_ += bytes.size();
    if (records_bytes_ > kRememberedMaxBytes) newest_ = {};
    if (newest_.state) newest_.records.push_back(record);
    return appended;
  }
  const std::lock_guard lock(shared_->mutex);
  shared_->note(appended.error());
  return appended;
}

void StateKeeper::appendWhatHappened(const v1::Record& record) {
  auto appended = append(record);
  if (appended) return;
  shared_->files->skipRecord();
  openGap(appended.error().message);
}

core::Result<void> StateKeeper::flush() {
  auto flushed = shared_->files->flush();
  if (!flushed) {
    {
      const std::lock_guard lock(shared_->mutex);
      shared_->note(flushed.error());
    }
    openGap(flushed.error().message);
  }
  return flushed;
}

void StateKeeper::openGap(const std::string& why) {
  const std::lock_guard lock(shared_->mutex);
  shared_->gap = why;
  ++shared_->gap_count;
  if (!shared_->retry) shared_->retry = Clock::now() + kRetryPause;
}

std::optional<std::string> StateKeeper::gap() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->gap;
}

bool StateKeeper::isDue(TimePoint now, bool has_water_changed) const {
  const std::lock_guard lock(shared_->mutex);
  if (shared_->is_writing) return false;
  if (is_asked_) return true;
  if (shared_->retry) return now >= *shared_->retry;
  const bool is_up_to_date = newest_.state && newest_.records.empty() && !has_water_changed;
  return now >= next_ && !is_up_to_date;
}

void StateKeeper::save(v1::KeptState state, TimePoint now, double copy_s) {
  finish();
  is_asked_ = false;
  next_ = now + interval_;
  const auto point = shared_->files->beginGeneration();
  std::uint64_t gap_count = 0;
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->copy_s = copy_s;
    if (!point) return shared_->end(point.error());
    shared_->is_writing = true;
    gap_count = shared_->gap_count;
  }
  newest_ = {std::make_shared<const v1::KeptState>(std::move(state)), {}};
  records_bytes_ = 0;
  writer_.push([shared = shared_, point = *point, now, gap_count, kept = newest_.state](bool) {
    shared->write(point, *kept, now, gap_count);  // also when the server ends: the state is there
  });
}

std::optional<KeptRoom> StateKeeper::newest() const {
  if (!newest_.state || gap()) return std::nullopt;
  return newest_;
}

StateKeeper::Status StateKeeper::status() const {
  const std::lock_guard lock(shared_->mutex);
  return {.files = shared_->files->status(),
          .snapshot_count = shared_->snapshot_count,
          .failure_count = shared_->failure_count,
          .since_snapshot_s = std::chrono::duration<double>(Clock::now() - shared_->newest_copy).count(),
          .copy_s = shared_->copy_s,
          .write_s = shared_->write_s};
}

}  // namespace spindrift::history
