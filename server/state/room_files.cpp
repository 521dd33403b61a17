#include <functional>
#include <iterator>
#include <new>
#include <set>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

#include <spindrift/state/posix_file.h>
#include <spindrift/state/room_files.h>

#include "file_format.h"
#include "room_recovery.h"

namespace spindrift::state {
namespace {

namespace fs = std::filesystem;
using core::Error;
using core::ErrorCode;

Error wrongOrder(const std::string& text) {
  return {ErrorCode::kInternal, "the files of a room were used in the wrong order: " + text};
}

void raise(std::atomic<std::uint64_t>& value, std::uint64_t least) {
  std::uint64_t known = value;
  while (known < least && !value.compare_exchange_weak(known, least)) {
  }
}

}  // namespace

RoomFiles::RoomFiles(fs::path folder, std::string room, Options options, std::vector<fs::path> new_names)
    : folder_(std::move(folder)), room_(std::move(room)), options_(options), new_names_(std::move(new_names)) {}
RoomFiles::~RoomFiles() = default;

core::Result<std::unique_ptr<RoomFiles>> RoomFiles::open(const fs::path& folder, std::string room, Options options) {
  if (room.size() > kNameMaxBytes) {
    return core::invalid(
        fmt::format("a room's name of {} bytes does not fit into its files: at most {} bytes are possible", room.size(),
                    kNameMaxBytes));
  }
  if (options.kept_generation_count < 1)
    return core::invalid("0 generations of a room's state cannot be kept: keep at least 1");
  if (options.log_max_bytes > kLogMaxBytes) {
    return core::invalid(fmt::format("a log of {} bytes cannot be read again: at most {} bytes are possible",
                                     options.log_max_bytes, kLogMaxBytes));
  }
  auto made = makeFolder(folder);
  if (!made) return made.error();
  return std::unique_ptr<RoomFiles>(new RoomFiles(folder, std::move(room), options, *std::move(made)));
}

core::Result<RoomFiles::Recovered> RoomFiles::recover(std::uint64_t before) try {
  const std::lock_guard lock(log_mutex_);
  if (log_) return wrongOrder("recover() comes before beginGeneration()");
  auto found = recoverFolder(folder_, room_, before, options_.sync != Sync::kNever);
  if (!found) return found.error();
  last_generation_ = found->last_generation;
  next_number_ = found->next_number;
  snapshot_generation_ = found->content.generation;
  snapshot_bytes_ = found->snapshot_bytes;
  refused_from_ = before;
  is_recovered_ = true;
  return std::move(found->content);
} catch (const std::bad_alloc&) {
  return core::unavailable("there is not enough memory to read the files in " + folder_.string() +
                           ": snapshots and logs take as much as they have bytes");
}

core::Result<StatePoint> RoomFiles::beginGeneration() {
  const std::lock_guard lock(log_mutex_);
  if (!is_recovered_) return wrongOrder("beginGeneration() comes after recover()");
  if (auto aside = setRefusedAside(); !aside) return aside.error();
  if (is_torn_) {
    if (auto cut = cutToWholeRecords(); !cut) return cut.error();
  }
  const bool waits_for_snapshot = log_ && last_generation_ > snapshot_generation_;
  const bool is_unfit = is_full_ || needed_snapshot_generation_ > last_generation_;
  const bool has_too_many = last_generation_ >= snapshot_generation_ + kLogsWithoutSnapshotMaxCount;
  if (waits_for_snapshot && (!is_unfit || has_too_many)) return StatePoint{last_generation_, next_number_};
  const std::uint64_t next = last_generation_ + 1;
  if (auto made = makeEmptyLog(folder_, {room_, next}, next_number_, false); !made) return made.error();
  auto log = File::open(folder_ / logName(next), O_WRONLY);
  if (!log) return log.error();
  if (options_.sync == Sync::kAlways && log_) unforced_logs_.push_back(log_);
  log_ = std::make_shared<File>(std::move(*log));
  last_generation_ = next;
  log_bytes_ = kStartBytes + room_.size();
  generation_ = next;
  is_full_ = false;
  return StatePoint{next, next_number_};
}

/// Sets the snapshots aside that the caller of recover() could not use. The mutex is held.
core::Result<void> RoomFiles::setRefusedAside() {
  if (refused_from_ == kNewest) return {};
  const auto entries = listFolder(folder_);
  if (!entries) return entries.error();
  for (const FolderEntry& entry : *entries) {
    const FileName name = parseFileName(entry.name);
    if (name.kind != FileKind::kSnapshot || name.generation < refused_from_) continue;
    if (const auto aside = setAside(folder_ / entry.name); !aside) return aside.error();
  }
  refused_from_ = kNewest;
  return {};
}

core::Result<void> RoomFiles::cutToWholeRecords() {
  if (auto cut = log_->resize(log_bytes_); !cut) return cut;
  is_torn_ = false;
  return {};
}

core::Result<void> RoomFiles::append(core::ByteView record) {
  if (record.empty() || record.size() > kRecordMaxBytes) {
    return core::invalid(fmt::format("a record of {} bytes cannot be logged: 1 to {} bytes are possible", record.size(),
                                     kRecordMaxBytes));
  }
  const std::lock_guard lock(log_mutex_);
  if (!log_) return wrongOrder("append() comes after beginGeneration()");
  if (is_torn_) {
    if (auto cut = cutToWholeRecords(); !cut) return cut;
  }
  const auto header = recordHeader(next_number_, record);
  if (log_bytes_ + header.size() + record.size() > options_.log_max_bytes) {
    is_full_ = true;
    return core::unavailable(fmt::format("the log {} is full at {} of at most {} bytes: a snapshot is due",
                                         log_->path().string(), log_bytes_.load(), options_.log_max_bytes));
  }
  auto written = log_->writeAt(log_bytes_, header, record);
  if (!written) {
    is_torn_ = true;
    (void)cutToWholeRecords();  // is_torn_ stays, and the next call tries again
    return written;
  }
  log_bytes_ += header.size() + record.size();
  ++next_number_;
  return {};
}

void RoomFiles::skipRecord() {
  const std::lock_guard lock(log_mutex_);
  ++next_number_;
}

core::Result<void> RoomFiles::flush() {
  if (options_.sync != Sync::kAlways) return {};
  std::vector<std::shared_ptr<File>> logs;
  std::uint64_t generation = 0;
  {
    const std::lock_guard lock(log_mutex_);
    if (!log_) return wrongOrder("flush() comes after beginGeneration()");
    logs = std::exchange(unforced_logs_, {});
    logs.push_back(log_);
    generation = last_generation_;
  }
  core::Result<void> forced;
  for (const auto& log : logs) {
    if (auto synced = log->sync(); !synced && forced) forced = synced;
  }
  if (forced && forced_names_generation_ < generation) forced = forceNames(generation);
  if (!forced) {
    raise(needed_snapshot_generation_, generation + 1);
    return forced;
  }
  if (needed_snapshot_generation_ > snapshot_generation_) {
    return core::unavailable(
        fmt::format("the disk refused records of {} before: check the disk; a snapshot of generation {} makes "
                    "up for it",
                    folder_.string(), needed_snapshot_generation_.load()));
  }
  return {};
}

/// Forces the names of the files up to `generation` to the disk, and the first time those of new folders.
core::Result<void> RoomFiles::forceNames(std::uint64_t generation) {
  if (auto synced = syncFolder(folder_); !synced) return synced;
  if (forced_names_generation_ == 0) {
    for (const fs::path& parent : new_names_) {
      if (auto synced = syncFolder(parent); !synced) return synced;
    }
  }
  raise(forced_names_generation_, generation);
  return {};
}

core::Result<void> RoomFiles::writeSnapshot(const StatePoint& point, core::ByteView payload) {
  const std::lock_guard lock(snapshot_mutex_);
  const std::uint64_t generation = point.generation;
  if (generation < 1 || generation > generation_)
    return wrongOrder(fmt::format("generation {} has not begun", generation));
  if (payload.size() > kSnapshotMaxBytes) {
    return core::invalid(fmt::format("a snapshot of {} bytes cannot be written: at most {} bytes are possible",
                                     payload.size(), kSnapshotMaxBytes));
  }
  const bool is_forced = options_.sync != Sync::kNever;
  const core::Bytes header = snapshotHeader({room_, generation}, point.next_number, payload);
  if (auto written = writeWhole(folder_ / snapshotName(generation), header, payload, is_forced); !written)
    return written;
  if (is_forced) {
    if (auto forced = forceNames(generation); !forced) return forced;
  }
  if (generation >= snapshot_generation_) {
    snapshot_generation_ = generation;
    snapshot_bytes_ = header.size() + payload.size();
  }
  return {};
}

core::Result<void> RoomFiles::removeOldGenerations() const {
  const auto entries = listFolder(folder_);
  if (!entries) return entries.error();
  std::set<std::uint64_t, std::greater<>> snapshots;
  for (const FolderEntry& entry : *entries) {
    if (const FileName name = parseFileName(entry.name); name.kind == FileKind::kSnapshot)
      snapshots.insert(name.generation);
  }
  if (snapshots.size() < options_.kept_generation_count) return {};
  const std::uint64_t oldest_kept = *std::next(snapshots.begin(), options_.kept_generation_count - 1);
  for (const FolderEntry& entry : *entries) {
    const FileName name = parseFileName(entry.name);
    const bool is_generation = name.kind == FileKind::kSnapshot || name.kind == FileKind::kLog;
    if (!is_generation || name.generation >= oldest_kept) continue;
    if (auto removed = removeFile(folder_ / entry.name); !removed) return removed;
  }
  return {};
}

RoomFiles::Status RoomFiles::status() const {
  return {generation_, log_bytes_, snapshot_generation_, snapshot_bytes_};
}

}  // namespace spindrift::state
