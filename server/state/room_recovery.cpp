#include "room_recovery.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "file_format.h"
#include "file_names.h"
#include "posix_file.h"

namespace spindrift::state {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kForeignNotesMaxCount = 16;

class Recovery {
 public:
  Recovery(fs::path folder, bool is_forced) : folder_(std::move(folder)), is_forced_(is_forced) {}

  core::Result<RecoveredFolder> run();

 private:
  core::Result<void> listFiles();
  core::Result<core::Bytes> readFile(const FolderEntry& entry, std::uint64_t max_bytes,
                                     std::optional<Fault>& fault) const;
  core::Result<void> findSnapshot();
  core::Result<void> readLogs();
  core::Result<bool> readLog(const FolderEntry& entry, std::uint64_t generation);
  core::Result<void> completeLogs();
  core::Result<void> cutLog(const fs::path& path, const ParsedLog& log);
  core::Result<void> keepWholePart(const fs::path& path, const RoomFiles::Log& file, const ParsedLog& log);
  core::Result<void> setAside(const FolderEntry& entry, const Fault& fault);
  void note(const std::string& name, const std::string& text) { out_.content.notes.push_back(name + ": " + text); }

  const fs::path folder_;
  const bool is_forced_;
  std::map<std::uint64_t, FolderEntry, std::greater<>> snapshots_;  ///< newest first
  std::map<std::uint64_t, FolderEntry> logs_;
  bool is_changed_ = false;
  RecoveredFolder out_;
};

std::string placeOf(const Fault& fault) {
  return fault.reason + ", at byte " + std::to_string(fault.at_byte);
}

core::Result<RecoveredFolder> Recovery::run() {
  if (auto done = listFiles(); !done) return done.error();
  if (auto done = findSnapshot(); !done) return done.error();
  if (auto done = readLogs(); !done) return done.error();
  if (auto done = completeLogs(); !done) return done.error();
  if (is_changed_ && is_forced_) {
    if (auto done = syncFolder(folder_); !done) return done.error();
  }
  return std::move(out_);
}

core::Result<void> Recovery::listFiles() {
  auto entries = listFolder(folder_);
  if (!entries) return entries.error();
  std::size_t foreign_count = 0;
  for (FolderEntry& entry : *entries) {
    const FileName name = parseFileName(entry.name);
    switch (name.kind) {
      case FileKind::kSnapshot:
        snapshots_.emplace(name.generation, std::move(entry));
        break;
      case FileKind::kLog:
        logs_.emplace(name.generation, std::move(entry));
        break;
      case FileKind::kTemporary:
        if (auto removed = removeFile(folder_ / entry.name); !removed) return removed;
        is_changed_ = true;
        break;
      case FileKind::kSetAside:
        break;  // noted when it was set aside
      case FileKind::kForeign:
        if (++foreign_count <= kForeignNotesMaxCount) note(entry.name, "it is none of the room's files; left alone");
        break;
    }
  }
  if (foreign_count > kForeignNotesMaxCount) {
    note(folder_.string(),
         std::to_string(foreign_count - kForeignNotesMaxCount) + " more files are none of the room's; left alone");
  }
  return {};
}

core::Result<void> Recovery::setAside(const FolderEntry& entry, const Fault& fault) {
  const auto aside = nameToSetAside(folder_ / entry.name);
  if (!aside) return aside.error();
  if (auto renamed = renameFile(folder_ / entry.name, *aside); !renamed) return renamed;
  is_changed_ = true;
  note(entry.name, placeOf(fault) + "; set aside as " + aside->filename().string());
  return {};
}

/// Reads the bytes of a file; sets `fault` instead when it cannot be one that this program wrote.
core::Result<core::Bytes> Recovery::readFile(const FolderEntry& entry, std::uint64_t max_bytes,
                                             std::optional<Fault>& fault) const {
  if (!entry.is_regular_file) {
    fault = Fault{"it is a folder, a link or a device, not a regular file", 0};
    return core::Bytes();
  }
  const auto file = File::openToRead(folder_ / entry.name);
  if (!file) return file.error();
  const auto size = file->size_bytes();
  if (!size) return size.error();
  if (*size > max_bytes) {
    fault = Fault{"it has " + std::to_string(*size) + " bytes (at most " + std::to_string(max_bytes) + " are possible)",
                  max_bytes};
    return core::Bytes();
  }
  return file->read(max_bytes);
}

core::Result<void> Recovery::findSnapshot() {
  for (const auto& [generation, entry] : snapshots_) {
    std::optional<Fault> fault;
    auto bytes = readFile(entry, kSnapshotHeaderBytes + kSnapshotMaxBytes, fault);
    if (!bytes) return bytes.error();
    if (!fault) fault = parseSnapshot(*bytes, generation).fault;
    if (!fault) {
      out_.content.generation = generation;
      out_.snapshot_bytes = bytes->size();
      bytes->erase(bytes->begin(), bytes->begin() + kSnapshotHeaderBytes);
      out_.content.snapshot = std::move(*bytes);
      return {};
    }
    if (auto aside = setAside(entry, *fault); !aside) return aside;
  }
  return {};
}

/// Reads logs as long as one follows the other and is whole.
core::Result<void> Recovery::readLogs() {
  out_.last_generation = out_.content.generation;
  bool goes_on = true;
  for (std::uint64_t generation = std::max<std::uint64_t>(out_.content.generation, 1); goes_on; ++generation) {
    const auto found = logs_.find(generation);
    if (found == logs_.end()) break;
    const auto is_whole = readLog(found->second, generation);
    if (!is_whole) return is_whole.error();
    goes_on = *is_whole;
  }
  return {};
}

/// Returns whether the log is whole, so that the next one may follow.
core::Result<bool> Recovery::readLog(const FolderEntry& entry, std::uint64_t generation) {
  RoomFiles::Log log;
  std::optional<Fault> unusable;
  auto bytes = readFile(entry, kLogMaxBytes, unusable);
  if (!bytes) return bytes.error();
  log.generation = generation;
  log.file = std::move(*bytes);
  ParsedLog parsed;
  if (!unusable) {
    parsed = parseLog(log.file, generation);
    if (parsed.whole_bytes == 0) unusable = parsed.fault;
  }
  if (unusable) {
    if (auto aside = setAside(entry, *unusable); !aside) return aside.error();
    logs_.erase(generation);
    return false;
  }
  if (parsed.fault) {
    // A log that was continued in the next one was whole at that time: then a torn end is damage as well.
    const bool is_newest = logs_.upper_bound(generation) == logs_.end();
    const fs::path path = folder_ / entry.name;
    auto repaired = parsed.fault->is_torn_end && is_newest ? cutLog(path, parsed) : keepWholePart(path, log, parsed);
    if (!repaired) return repaired.error();
  }
  log.records = std::move(parsed.records);
  out_.content.logs.push_back(std::move(log));
  out_.last_generation = generation;
  return !parsed.fault;
}

core::Result<void> Recovery::cutLog(const fs::path& path, const ParsedLog& log) {
  const auto file = File::openToWrite(path);
  if (!file) return file.error();
  if (auto cut = file->resize(log.whole_bytes); !cut) return cut;
  if (is_forced_) {
    if (auto synced = file->sync(); !synced) return synced;
  }
  note(path.filename().string(), placeOf(*log.fault) + ", because writing was interrupted; cut there");
  return {};
}

/// Replaces a damaged log by its whole records and keeps all of it under another name.
core::Result<void> Recovery::keepWholePart(const fs::path& path, const RoomFiles::Log& file, const ParsedLog& log) {
  const auto aside = nameToSetAside(path);
  if (!aside) return aside.error();
  // A second name, then the replacement: at no moment is the log without a file.
  if (auto linked = linkFile(path, *aside); !linked) return linked;
  const core::ByteView whole = core::ByteView(file.file).first(log.whole_bytes);
  if (auto written = writeWhole(path, whole, {}, is_forced_); !written) return written;
  note(path.filename().string(), placeOf(*log.fault) + "; its " + std::to_string(log.records.size()) +
                                     " records before are used, the whole file is kept as " +
                                     aside->filename().string());
  return {};
}

/// The next log must follow without a gap, also when a log of the snapshot's own generation is missing.
core::Result<void> Recovery::completeLogs() {
  const std::uint64_t snapshot = out_.content.generation;
  for (auto later = logs_.upper_bound(out_.last_generation); later != logs_.end(); ++later) {
    const Fault fault{"what it continues is missing or damaged (the last whole generation is " +
                          std::to_string(out_.last_generation) + ")",
                      0};
    if (auto aside = setAside(later->second, fault); !aside) return aside;
  }
  if (snapshot == 0 || !out_.content.logs.empty()) return {};
  note(logName(snapshot), "it is missing or unusable, so what happened after the snapshot of generation " +
                              std::to_string(snapshot) + " is lost");
  RoomFiles::Log log;
  log.generation = snapshot;
  out_.content.logs.push_back(std::move(log));
  return makeEmptyLog(folder_, snapshot, is_forced_);
}

}  // namespace

core::Result<void> makeEmptyLog(const fs::path& folder, std::uint64_t generation, bool is_forced) {
  return writeWhole(folder / logName(generation), logHeader(generation), {}, is_forced);
}

core::Result<RecoveredFolder> recoverFolder(const fs::path& folder, bool is_forced) {
  return Recovery(folder, is_forced).run();
}

}  // namespace spindrift::state
