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

StateKeeper::StateKeeper(std::string room, std::unique_ptr<state::RoomFiles> files, std::chrono::milliseconds interval,
                         core::Worker& writer, state::FolderLock lock)
    : room_(std::move(room)), lock_(std::move(lock)), files_(std::move(files)), interval_(interval), writer_(writer) {}

StateKeeper::~StateKeeper() {
  finish();
}

void StateKeeper::write(const state::StatePoint& point, const v1::KeptState& state, TimePoint copied,
                        std::uint64_t known_gap_count) {
  const auto begin = Clock::now();
  auto written = files_->writeSnapshot(point, viewOf(state.SerializeAsString()));
  const double duration_s = std::chrono::duration<double>(Clock::now() - begin).count();
  const auto removed = written ? files_->removeOldGenerations() : core::Result<void>();
  const std::lock_guard lock(mutex_);
  write_s_ = duration_s;
  if (written) {
    ++snapshot_count_;
    newest_copy_ = copied;
    if (known_gap_count == gap_count_) {
      gap_.reset();
      retry_.reset();
    }
  }
  end(std::move(written));
  const std::string removal = removed ? "" : removed.error().message;
  if (std::exchange(logged_removal_, removal) == removal || removed) return;
  ++failure_count_;
  spdlog::error("room {}: older files of its state are left behind: {}", room_, removal);
}

void StateKeeper::end(core::Result<void> how) {
  if (how) {
    if (!std::exchange(logged_error_, {}).empty()) spdlog::info("room {}: its state is kept on disk again", room_);
  } else {
    note(how.error());
    retry_ = Clock::now() + kRetryPause;
  }
  outcome_ = std::move(how);
  is_writing_ = false;
  finished_.notify_all();
}

void StateKeeper::note(const core::Error& error) {
  ++failure_count_;
  const auto now = Clock::now();
  if (logged_error_ == error.message && now - logged_at_ < kSameErrorPause) return;
  logged_error_ = error.message;
  logged_at_ = now;
  spdlog::error("room {}: its state cannot be kept on disk: {}", room_, error.message);
}

void StateKeeper::finish() const {
  std::unique_lock lock(mutex_);
  finished_.wait(lock, [this] { return !is_writing_; });
}

std::optional<core::Result<void>> StateKeeper::outcome(TimePoint deadline) const {
  std::unique_lock lock(mutex_);
  if (!finished_.wait_until(lock, deadline, [this] { return !is_writing_; })) return std::nullopt;
  return outcome_;
}

core::Result<void> StateKeeper::append(const v1::Record& record) {
  const std::string bytes = record.SerializeAsString();
  auto appended = files_->append(viewOf(bytes));
  if (appended) {
    records_bytes_ += bytes.size();
    if (records_bytes_ > kRememberedMaxBytes) newest_ = {};
    if (newest_.state) newest_.records.push_back(record);
    return appended;
  }
  const std::lock_guard lock(mutex_);
  note(appended.error());
  return appended;
}

void StateKeeper::appendWhatHappened(const v1::Record& record) {
  auto appended = append(record);
  if (appended) return;
  files_->skipRecord();
  openGap(appended.error().message);
}

core::Result<void> StateKeeper::flush() {
  auto flushed = files_->flush();
  if (!flushed) {
    {
      const std::lock_guard lock(mutex_);
      note(flushed.error());
    }
    openGap(flushed.error().message);
  }
  return flushed;
}

void StateKeeper::openGap(const std::string& why) {
  const std::lock_guard lock(mutex_);
  gap_ = why;
  ++gap_count_;
  if (!retry_) retry_ = Clock::now() + kRetryPause;
}

std::optional<std::string> StateKeeper::gap() const {
  const std::lock_guard lock(mutex_);
  return gap_;
}

bool StateKeeper::isDue(TimePoint now, bool has_water_changed) const {
  const std::lock_guard lock(mutex_);
  if (is_writing_) return false;
  if (is_asked_) return true;
  if (retry_) return now >= *retry_;
  const bool is_up_to_date = newest_.state && newest_.records.empty() && !has_water_changed;
  return now >= next_ && !is_up_to_date;
}

void StateKeeper::save(v1::KeptState state, TimePoint now, double copy_s) {
  finish();
  is_asked_ = false;
  next_ = now + interval_;
  const auto point = files_->beginGeneration();
  std::uint64_t gap_count = 0;
  {
    const std::lock_guard lock(mutex_);
    copy_s_ = copy_s;
    if (!point) return end(point.error());
    is_writing_ = true;
    gap_count = gap_count_;
  }
  newest_ = {std::make_shared<const v1::KeptState>(std::move(state)), {}};
  records_bytes_ = 0;
  writer_.push([this, point = *point, now, gap_count, kept = newest_.state](bool) {
    write(point, *kept, now, gap_count);  // also when the server ends: the state is there
  });
}

std::optional<KeptRoom> StateKeeper::newest() const {
  if (!newest_.state || gap()) return std::nullopt;
  return newest_;
}

StateKeeper::Status StateKeeper::status() const {
  const std::lock_guard lock(mutex_);
  return {.files = files_->status(),
          .snapshot_count = snapshot_count_,
          .failure_count = failure_count_,
          .since_snapshot_s = std::chrono::duration<double>(Clock::now() - newest_copy_).count(),
          .copy_s = copy_s_,
          .write_s = write_s_};
}

}  // namespace spindrift::history
