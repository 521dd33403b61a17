#include "room_recovery.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>

#include <spindrift/state/posix_file.h>

namespace spindrift::state {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kForeignNotesMaxCount = 16;

std::string placeOf(const Fault& fault) {
  return fmt::format("{}, at byte {}", fault.reason, fault.at_byte);
}

class Recovery {
 public:
  Recovery(fs::path folder, std::string_view room, std::uint64_t before, bool is_forced)
      : folder_(std::move(folder)), room_(room), before_(before), is_forced_(is_forced) {}

  core::Result<RecoveredFolder> run() {
    if (auto done = listFiles(); !done) return done.error();
    if (auto done = findSnapshot(); !done) return done.error();
    if (auto done = readLogs(); !done) return done.error();
    if (auto done = completeLogs(); !done) return done.error();
    if (is_changed_ && is_forced_) {
      if (auto done = syncFolder(folder_); !done) return done.error();
    }
    std::size_t record_count = 0;
    for (const RoomFiles::Log& log : out_.content.logs) record_count += log.records.size();
    out_.next_number = next_number_.value_or(1 + record_count);
    return std::move(out_);
  }

 private:
  core::Result<void> listFiles() {
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
          if (++foreign_count <= kForeignNotesMaxCount) note(entry.name, "not one of the room's files; left alone");
          break;
      }
    }
    if (foreign_count > kForeignNotesMaxCount) {
      note(folder_.string(),
           fmt::format("{} more files are not the room's; left alone", foreign_count - kForeignNotesMaxCount));
    }
    return {};
  }

  core::Result<void> setAside(const FolderEntry& entry, const Fault& fault) {
    const auto aside = state::setAside(folder_ / entry.name);
    if (!aside) return aside.error();
    is_changed_ = true;
    note(entry.name, placeOf(fault) + "; set aside as " + aside->filename().string());
    return {};
  }

  /// Reads the bytes of a file; sets `fault` instead when it cannot be one that this program wrote.
  core::Result<core::Bytes> readFile(const FolderEntry& entry, std::uint64_t max_bytes,
                                     std::optional<Fault>& fault) const {
    if (!entry.is_regular_file) {
      fault = Fault{"it is a folder, a link or a device, not a regular file", 0};
      return core::Bytes();
    }
    const auto file = File::open(folder_ / entry.name, O_RDONLY);
    if (!file) return file.error();
    const auto size = file->size_bytes();
    if (!size) return size.error();
    if (*size > max_bytes) {
      fault = Fault{fmt::format("it has {} bytes (at most {} are possible)", *size, max_bytes), max_bytes};
      return core::Bytes();
    }
    return file->read(max_bytes);
  }

  core::Result<void> findSnapshot() {
    for (const auto& [generation, entry] : snapshots_) {
      if (generation >= before_) continue;
      std::optional<Fault> fault;
      auto bytes = readFile(entry, kSnapshotHeaderBytes + kNameMaxBytes + kSnapshotMaxBytes, fault);
      if (!bytes) return bytes.error();
      ParsedSnapshot parsed;
      if (!fault) {
        parsed = parseSnapshot(*bytes, {room_, generation});
        fault = parsed.fault;
      }
      if (!fault) {
        out_.content.generation = generation;
        out_.snapshot_bytes = bytes->size();
        next_number_ = parsed.next_number;
        bytes->erase(bytes->begin(), bytes->end() - static_cast<std::ptrdiff_t>(parsed.payload.size()));
        out_.content.snapshot = std::move(*bytes);
        return {};
      }
      if (auto aside = setAside(entry, *fault); !aside) return aside;
    }
    return {};
  }

  /// Reads logs as long as one follows the other and is whole.
  core::Result<void> readLogs() {
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
  core::Result<bool> readLog(const FolderEntry& entry, std::uint64_t generation) {
    RoomFiles::Log log;
    std::optional<Fault> unusable;
    auto bytes = readFile(entry, kLogMaxBytes, unusable);
    if (!bytes) return bytes.error();
    log.generation = generation;
    log.file = std::move(*bytes);
    ParsedLog parsed;
    if (!unusable) {
      parsed = parseLog(log.file, {room_, generation});
      unusable = parsed.whole_bytes == 0 ? parsed.fault : connect(parsed, generation == out_.content.generation);
    }
    if (unusable) {
      if (auto aside = setAside(entry, *unusable); !aside) return aside.error();
      logs_.erase(generation);
      return false;
    }
    if (parsed.fault) {
      if (auto repaired = repair(entry, log, parsed); !repaired) return repaired.error();
    }
    next_number_.reset();
    if (parsed.first_number) next_number_ = *parsed.first_number + parsed.records.size();
    log.records = std::move(parsed.records);
    out_.content.logs.push_back(std::move(log));
    out_.last_generation = generation;
    return !parsed.fault;
  }

  /// Returns why the records do not follow what was read so far. Those of the log of the snapshot's generation,
  /// `is_first`, that are older than the snapshot are left out.
  [[nodiscard]] std::optional<Fault> connect(ParsedLog& log, bool is_first) const {
    if (!log.first_number || !next_number_) return std::nullopt;  // of version 1
    const std::uint64_t first = *log.first_number, expected = *next_number_, end = first + log.records.size();
    if (first > expected)
      return Fault{fmt::format("the records {} to {} before it are missing", expected, first - 1), 0};
    if (first == expected) return std::nullopt;
    if (!is_first) {
      return Fault{fmt::format("it begins with record {}, but record {} follows", first, expected), 0};
    }
    if (end < expected) {
      return Fault{fmt::format("the records {} to {}, which the snapshot follows, are missing in it{}", end,
                               expected - 1, log.fault ? ": " + log.fault->reason : ""),
                   log.whole_bytes};
    }
    log.records.erase(log.records.begin(), log.records.begin() + static_cast<std::ptrdiff_t>(expected - first));
    log.first_number = expected;
    return std::nullopt;
  }

  /// Leaves the whole records of a damaged log under its name.
  core::Result<void> repair(const FolderEntry& entry, const RoomFiles::Log& file, const ParsedLog& log) {
    // A log that was continued in the next one was whole at that time: then a torn end is damage as well.
    const bool is_newest = logs_.upper_bound(file.generation) == logs_.end();
    const fs::path path = folder_ / entry.name;
    return log.fault->is_torn_end && is_newest ? cutLog(path, log) : keepWholePart(path, file, log);
  }

  core::Result<void> cutLog(const fs::path& path, const ParsedLog& log) {
    const auto file = File::open(path, O_WRONLY);
    if (!file) return file.error();
    if (auto cut = file->resize(log.whole_bytes); !cut) return cut;
    if (is_forced_) {
      if (auto synced = file->sync(); !synced) return synced;
    }
    note(path.filename().string(), placeOf(*log.fault) + ", because writing was interrupted; cut there");
    return {};
  }

  /// Replaces a damaged log by its whole records and keeps all of it under another name.
  core::Result<void> keepWholePart(const fs::path& path, const RoomFiles::Log& file, const ParsedLog& log) {
    const auto aside = nameToSetAside(path);
    if (!aside) return aside.error();
    // A second name, then the replacement: at no moment is the log without a file.
    if (auto linked = linkFile(path, *aside); !linked) return linked;
    const core::ByteView whole = core::ByteView(file.file).first(log.whole_bytes);
    if (auto written = writeWhole(path, whole, {}, is_forced_); !written) return written;
    is_changed_ = true;
    note(path.filename().string(), fmt::format("{}; its {} records before are used, the whole file is kept as {}",
                                               placeOf(*log.fault), log.records.size(), aside->filename().string()));
    return {};
  }

  /// The next log must follow without a gap, also when a log of the snapshot's own generation is missing.
  core::Result<void> completeLogs() {
    const std::uint64_t snapshot = out_.content.generation;
    for (auto later = logs_.upper_bound(out_.last_generation); later != logs_.end(); ++later) {
      const auto fault = whyNotUsed(later->second, later->first);
      if (!fault) return fault.error();
      if (auto aside = setAside(later->second, *fault); !aside) return aside;
    }
    if (snapshot == 0 || !out_.content.logs.empty()) return {};
    note(logName(snapshot),
         fmt::format("it is missing or unusable, so what happened after the snapshot of generation {} is lost",
                     snapshot));
    RoomFiles::Log log;
    log.generation = snapshot;
    out_.content.logs.push_back(std::move(log));
    is_changed_ = true;
    return makeEmptyLog(folder_, {room_, snapshot}, next_number_.value_or(1), is_forced_);
  }

  /// Returns why a log after the last that is used cannot be used, and how much is in it.
  [[nodiscard]] core::Result<Fault> whyNotUsed(const FolderEntry& entry, std::uint64_t generation) const {
    std::optional<Fault> unusable;
    const auto bytes = readFile(entry, kLogMaxBytes, unusable);
    if (!bytes) return bytes.error();
    if (unusable) return *unusable;
    const ParsedLog parsed = parseLog(*bytes, {room_, generation});
    if (parsed.whole_bytes == 0) return *parsed.fault;
    return Fault{
        fmt::format(
            "what it continues is missing or damaged (the last whole generation is {}); its {} records are not used",
            out_.last_generation, parsed.records.size()),
        0};
  }

  void note(const std::string& name, const std::string& text) { out_.content.notes.push_back(name + ": " + text); }

  const fs::path folder_;
  const std::string_view room_;
  const std::uint64_t before_;
  const bool is_forced_;
  std::map<std::uint64_t, FolderEntry, std::greater<>> snapshots_;  ///< newest first
  std::map<std::uint64_t, FolderEntry> logs_;
  std::optional<std::uint64_t> next_number_ = 1;  ///< nullopt while only files of version 1 were read
  bool is_changed_ = false;
  RecoveredFolder out_;
};

}  // namespace

core::Result<void> makeEmptyLog(const fs::path& folder, const FileOwner& owner, std::uint64_t first_number,
                                bool is_forced) {
  return writeWhole(folder / logName(owner.generation), logHeader(owner, first_number), {}, is_forced);
}

core::Result<RecoveredFolder> recoverFolder(const fs::path& folder, std::string_view room, std::uint64_t before,
                                            bool is_forced) {
  return Recovery(folder, room, before, is_forced).run();
}

}  // namespace spindrift::state
