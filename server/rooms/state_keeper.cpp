#include <condition_variable>
#include <utility>

#include <spdlog/spdlog.h>

#include <spindrift/rooms/state_keeper.h>

namespace spindrift::rooms {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// After a failed write the next snapshot is tried this much later.
constexpr auto kRetryPause = 1s;
constexpr auto kSameErrorPause = 60s;
/// Of the records since the newest state in memory. Beyond it, a device that fails costs the room its state.
constexpr std::size_t kRememberedMaxBytes = 16u << 20;

core::ByteView viewOf(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

}  // namespace

struct StateKeeper::Shared {
  std::string room;
  std::shared_ptr<state::FolderLock> room_lock;  ///< before the files, which end first
  std::unique_ptr<state::RoomFiles> files;
  mutable std::mutex mutex;
  std::condition_variable finished;
  bool is_writing = false;
  /// Why the log lacks something that happened. A newer snapshot holds it.
  std::optional<std::string> gap;
  std::uint64_t gap_generation = 0;
  std::string logged_error;
  Clock::time_point logged_at{};
  std::uint64_t snapshot_count = 0;
  std::uint64_t failure_count = 0;
  Clock::time_point newest_copy = Clock::now();
  double copy_s = 0.0;
  double write_s = 0.0;

  core::Result<void> write(std::uint64_t generation, const v1::KeptState& state, Clock::time_point copied) {
    const auto begin = Clock::now();
    auto written = files->writeSnapshot(generation, viewOf(state.SerializeAsString()));
    const std::lock_guard lock(mutex);
    write_s = std::chrono::duration<double>(Clock::now() - begin).count();
    if (written) {
      ++snapshot_count;
      newest_copy = copied;
      if (gap && generation > gap_generation) gap.reset();
      if (!std::exchange(logged_error, {}).empty()) spdlog::info("room {}: its state is kept on disk again", room);
    } else {
      note(written.error());
    }
    is_writing = false;
    finished.notify_all();
    return written;
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
                         Worker& writer, std::shared_ptr<state::FolderLock> lock)
    : room_(std::move(room)), interval_(interval), writer_(writer), shared_(std::make_shared<Shared>()) {
  shared_->room = room_;
  shared_->room_lock = std::move(lock);
  shared_->files = std::move(files);
}

StateKeeper::~StateKeeper() {
  finish();
}

void StateKeeper::finish() {
  std::unique_lock lock(shared_->mutex);
  shared_->finished.wait(lock, [this] { return !shared_->is_writing; });
}

core::Result<void> StateKeeper::append(const v1::StateRecord& record) {
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

void StateKeeper::appendWhatHappened(const v1::StateRecord& record) {
  if (auto appended = append(record); !appended) openGap(appended.error());
}

core::Result<void> StateKeeper::flush() {
  auto flushed = shared_->files->flush();
  if (!flushed) openGap(flushed.error());
  return flushed;
}

void StateKeeper::openGap(const core::Error& error) {
  const std::lock_guard lock(shared_->mutex);
  shared_->note(error);
  shared_->gap = error.message;
  shared_->gap_generation = shared_->files->status().generation;
  next_ = std::min(next_, Clock::now() + kRetryPause);
}

std::optional<std::string> StateKeeper::gap() const {
  const std::lock_guard lock(shared_->mutex);
  return shared_->gap;
}

bool StateKeeper::isDue(TimePoint now) const {
  if (now < next_ && !is_asked_) return false;
  const std::lock_guard lock(shared_->mutex);
  return !shared_->is_writing;
}

std::uint64_t StateKeeper::begin(TimePoint now) {
  is_asked_ = false;
  next_ = now + interval_;
  auto generation = shared_->files->beginGeneration();
  const std::lock_guard lock(shared_->mutex);
  if (generation) {
    shared_->is_writing = true;
    return *generation;
  }
  shared_->note(generation.error());
  next_ = now + kRetryPause;
  return 0;
}

void StateKeeper::save(v1::KeptState state, TimePoint now, double copy_s) {
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->copy_s = copy_s;
  }
  const std::uint64_t generation = begin(now);
  if (generation == 0) return;
  remember(std::move(state));
  writer_.push([shared = shared_, generation, now, kept = newest_.state](bool) {
    (void)shared->write(generation, *kept, now);  // also when the server ends: the state is there
  });
}

void StateKeeper::remember(v1::KeptState state) {
  newest_ = {std::make_shared<const v1::KeptState>(std::move(state)), {}};
  records_bytes_ = 0;
}

std::optional<KeptRoom> StateKeeper::newest() const {
  if (!newest_.state || gap()) return std::nullopt;
  return newest_;
}

core::Result<void> StateKeeper::saveAndWait(v1::KeptState state) {
  finish();
  const auto now = Clock::now();
  const std::uint64_t generation = begin(now);
  if (generation == 0) return core::Error{core::ErrorCode::kUnavailable, "no new log could be begun"};
  remember(std::move(state));
  return shared_->write(generation, *newest_.state, now);
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

}  // namespace spindrift::rooms
