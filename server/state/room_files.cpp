#include <functional>
#include <iterator>
#include <new>
#include <set>
#include <utility>

#include <spindrift/state/room_files.h>

#include "file_format.h"
#include "file_names.h"
#include "posix_file.h"
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

RoomFiles::RoomFiles(fs::path folder, Options options) : folder_(std::move(folder)), options_(options) {}
RoomFiles::~RoomFiles() = default;

core::Result<std::unique_ptr<RoomFiles>> RoomFiles::open(const fs::path& folder, Options options) {
  if (options.kept_generation_count < 1)
    return Error{ErrorCode::kInvalidInput, "0 generations of a room's state cannot be kept: keep at least 1"};
  if (options.log_max_bytes > kLogMaxBytes) {
    return Error{ErrorCode::kInvalidInput, "a log of " + std::to_string(options.log_max_bytes) +
                                               " bytes cannot be read again: at most " + std::to_string(kLogMaxBytes) +
                                               " bytes are possible"};
  }
  if (auto made = makeFolder(folder); !made) return made.error();
  return std::unique_ptr<RoomFiles>(new RoomFiles(folder, options));
}

core::Result<RoomFiles::Recovered> RoomFiles::recover() try {
  const std::lock_guard lock(log_mutex_);
  if (log_) return wrongOrder("recover() comes before beginGeneration()");
  auto found = recoverFolder(folder_, options_.sync != Sync::kNever);
  if (!found) return found.error();
  last_generation_ = found->last_generation;
  snapshot_generation_ = found->content.generation;
  snapshot_bytes_ = found->snapshot_bytes;
  is_recovered_ = true;
  return std::move(found->content);
} catch (const std::bad_alloc&) {
  return Error{ErrorCode::kUnavailable, "there is not enough memory to read the files in " + folder_.string() +
                                            ": snapshots and logs take as much as they have bytes"};
}

core::Result<std::uint64_t> RoomFiles::beginGeneration() {
  const std::lock_guard lock(log_mutex_);
  if (!is_recovered_) return wrongOrder("beginGeneration() comes after recover()");
  if (last_generation_ >= snapshot_generation_ + kLogsWithoutSnapshotMaxCount) {
    return Error{ErrorCode::kUnavailable, "no further log is begun in " + folder_.string() + ": " +
                                              std::to_string(kLogsWithoutSnapshotMaxCount) +
                                              " logs wait for a snapshot; see why none could be written"};
  }
  if (is_torn_) {
    if (auto cut = cutToWholeRecords(); !cut) return cut.error();
  }
  const bool is_forced = options_.sync == Sync::kAlways;
  // A log that the disk refuses must not keep the room from the next one: flush() reports it.
  if (is_forced && log_ && !log_->sync()) raise(needed_snapshot_generation_, last_generation_ + 1);
  const std::uint64_t next = last_generation_ + 1;
  if (auto made = makeEmptyLog(folder_, next, is_forced); !made) return made.error();
  auto log = File::openToWrite(folder_ / logName(next));
  if (!log) return log.error();
  log_ = std::make_shared<File>(std::move(*log));
  last_generation_ = next;
  log_bytes_ = kLogHeaderBytes;
  generation_ = next;
  return next;
}

core::Result<void> RoomFiles::cutToWholeRecords() {
  if (auto cut = log_->resize(log_bytes_); !cut) return cut;
  is_torn_ = false;
  return {};
}

core::Result<void> RoomFiles::append(core::ByteView record) {
  if (record.empty() || record.size() > kRecordMaxBytes) {
    return Error{ErrorCode::kInvalidInput, "a record of " + std::to_string(record.size()) +
                                               " bytes cannot be logged: 1 to " + std::to_string(kRecordMaxBytes) +
                                               " bytes are possible"};
  }
  const auto header = recordHeader(record);
  const std::lock_guard lock(log_mutex_);
  if (!log_) return wrongOrder("append() comes after beginGeneration()");
  if (is_torn_) {
    if (auto cut = cutToWholeRecords(); !cut) return cut;
  }
  if (log_bytes_ + header.size() + record.size() > options_.log_max_bytes) {
    return Error{ErrorCode::kUnavailable, "the log " + log_->path().string() + " is full at " +
                                              std::to_string(log_bytes_) + " of at most " +
                                              std::to_string(options_.log_max_bytes) + " bytes: a snapshot is due"};
  }
  auto written = log_->writeAt(log_bytes_, header, record);
  if (!written) {
    is_torn_ = true;
    (void)cutToWholeRecords();  // is_torn_ stays, and the next call tries again
    return written;
  }
  log_bytes_ += header.size() + record.size();
  return {};
}

core::Result<void> RoomFiles::flush() {
  if (options_.sync != Sync::kAlways) return {};
  std::shared_ptr<File> log;
  std::uint64_t generation = 0;
  {
    const std::lock_guard lock(log_mutex_);
    log = log_;
    generation = last_generation_;
  }
  if (!log) return wrongOrder("flush() comes after beginGeneration()");
  if (auto synced = log->sync(); !synced) {
    raise(needed_snapshot_generation_, generation + 1);
    return synced;
  }
  if (needed_snapshot_generation_ > snapshot_generation_) {
    return Error{ErrorCode::kUnavailable, "the disk refused records of " + folder_.string() +
                                              " before: check the disk; a snapshot of generation " +
                                              std::to_string(needed_snapshot_generation_) + " makes up for it"};
  }
  return {};
}

core::Result<void> RoomFiles::writeSnapshot(std::uint64_t generation, core::ByteView payload) {
  const std::lock_guard lock(snapshot_mutex_);
  if (generation < 1 || generation > generation_)
    return wrongOrder("generation " + std::to_string(generation) + " has not begun");
  if (payload.size() > kSnapshotMaxBytes) {
    return Error{ErrorCode::kInvalidInput, "a snapshot of " + std::to_string(payload.size()) +
                                               " bytes cannot be written: at most " +
                                               std::to_string(kSnapshotMaxBytes) + " bytes are possible"};
  }
  const auto header = snapshotHeader(generation, payload);
  const fs::path path = folder_ / snapshotName(generation);
  if (auto written = writeWhole(path, header, payload, options_.sync != Sync::kNever); !written) return written;
  if (generation >= snapshot_generation_) {
    snapshot_generation_ = generation;
    snapshot_bytes_ = header.size() + payload.size();
  }
  if (auto removed = removeOldGenerations(); !removed) {
    return Error{removed.error().code, "the snapshot of generation " + std::to_string(generation) +
                                           " is written, but an older file is still there: " + removed.error().message};
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
