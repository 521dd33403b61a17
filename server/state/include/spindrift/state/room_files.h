// The files of one room's state: snapshots, and logs of what happened after each. docs/state_files.md describes them.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <spindrift/core/bytes.h>
#include <spindrift/core/result.h>

namespace spindrift::state {

/// Content of a snapshot.
inline constexpr std::uint64_t kSnapshotMaxBytes = 1ull << 30;
/// Content of one record of a log. A record has at least one byte.
inline constexpr std::uint32_t kRecordMaxBytes = 8u << 20;
/// The file of a log.
inline constexpr std::uint64_t kLogMaxBytes = 1ull << 30;
/// Logs after the newest snapshot. Then a snapshot is tried without a new log.
inline constexpr std::uint64_t kLogsWithoutSnapshotMaxCount = 64;

/// When written bytes are forced to the disk. A killed process loses nothing with any of them, because the operating
/// system has the bytes; a power failure may lose what was not forced.
enum class Sync {
  kNever,
  kSnapshots,  ///< snapshots, before older files are removed
  kAlways,     ///< also the log, at each flush()
};

class File;

/// Position of a state in the logs.
struct StatePoint {
  std::uint64_t generation = 0;   ///< of the log that holds what follows
  std::uint64_t next_number = 0;  ///< of the first record that follows, counted from 1 since the room began
};

/// The files of one room: NNNNNNNNNNNN.snapshot and NNNNNNNNNNNN.log, one pair per generation. The log of a generation
/// holds what happened after the state of its snapshot was copied. Each file says of which room it is. A folder has one
/// RoomFiles at a time (FolderLock).
///
/// recover() comes first, then beginGeneration(), then the rest. All functions may be called by any thread at the same
/// time; a flush or a snapshot does not delay append(). Only flush(), writeSnapshot() and recover() wait for the disk.
/// An error names the file, the reason and what to do; its code is kUnavailable when the file system refused something,
/// kInvalidInput when a size is out of bounds, kInternal when the order of the calls is wrong.
class RoomFiles {
 public:
  struct Options {
    Sync sync = Sync::kSnapshots;
    /// Newest snapshots that stay, at least 1, with the logs that follow the oldest of them.
    std::uint32_t kept_generation_count = 2;
    /// A log takes no records beyond this size; at most kLogMaxBytes.
    std::uint64_t log_max_bytes = kLogMaxBytes;
  };

  /// Makes the folder, with mode 0700, if necessary. `room` has at most 255 bytes.
  static core::Result<std::unique_ptr<RoomFiles>> open(const std::filesystem::path& folder, std::string room,
                                                       Options options);
  RoomFiles(const RoomFiles&) = delete;
  RoomFiles& operator=(const RoomFiles&) = delete;
  ~RoomFiles();

  /// A log with its whole records in order.
  struct Log {
    std::uint64_t generation = 0;
    core::Bytes file;  ///< what the records view; moving a Log keeps them valid
    std::vector<core::ByteView> records;

    Log() = default;
    Log(Log&&) = default;
    Log& operator=(Log&&) = default;
  };

  struct Recovered {
    std::uint64_t generation = 0;  ///< of the snapshot; 0: no snapshot
    core::Bytes snapshot;
    /// The log of the snapshot's generation, always, and the following ones, without a gap. Without a snapshot from
    /// generation 1 on, whose log begins with the new room.
    std::vector<Log> logs;
    /// One line for each file that was set aside, cut or ignored: file, reason, byte, what was done.
    std::vector<std::string> notes;
  };

  static constexpr std::uint64_t kNewest = ~0ull;
  /// Finds the newest whole snapshot and the logs after it. Files that are damaged, foreign, of another room or of
  /// another format get the name NAME.damaged (.damaged.2 and so on) and are never deleted. A log is used up to its
  /// last whole record, and those that follow a damaged one are set aside, because they continue what is missing. What
  /// an interrupted write left is removed. Files of other names are ignored. An error means that the file system
  /// refused something; then nothing can be said about the room's state.
  ///
  /// A caller that cannot use the snapshot calls it again with `before` = its generation, to get an older one with all
  /// logs after that. Newer snapshots stay as they are until beginGeneration() sets them aside.
  core::Result<Recovered> recover(std::uint64_t before = kNewest);

  /// Returns where a state stands that is copied now; later records follow it. Begins a new log, unless the newest one
  /// still waits for its snapshot: then a snapshot that could not be written is tried again without further files.
  /// Older logs and snapshots stay until removeOldGenerations(), so that recover() finds a snapshot and all logs after
  /// it at any moment. After an error append() continues in the log that there was.
  core::Result<StatePoint> beginGeneration();

  /// Appends a record, whole or not at all; when it returns the operating system has the bytes. After a failed write
  /// the log is cut back to its last whole record, and the next call tries again. A log that has
  /// Options::log_max_bytes refuses records; after beginGeneration() the new log takes them.
  core::Result<void> append(core::ByteView record);
  /// Counts a record that could not be appended although what it says happened, so that recover() finds it missing.
  void skipRecord();

  /// Forces, with Sync::kAlways, all records to the disk that were appended before the call; otherwise does nothing.
  /// One call for a batch of records is enough. After the disk has refused, every flush fails until a snapshot of a
  /// newer generation is written: the operating system does not keep what it could not write.
  core::Result<void> flush();

  /// Writes the state that was copied at `point`. The file appears under its name when it is whole. An error leaves all
  /// files as they were.
  core::Result<void> writeSnapshot(const StatePoint& point, core::ByteView payload);
  /// Removes generations that are no longer kept. Call it after writeSnapshot().
  core::Result<void> removeOldGenerations() const;

  struct Status {
    std::uint64_t generation = 0;           ///< of the log that is written; 0 before beginGeneration()
    std::uint64_t log_bytes = 0;            ///< of that log
    std::uint64_t snapshot_generation = 0;  ///< newest that is written; 0: none
    std::uint64_t snapshot_bytes = 0;       ///< of its file
  };
  [[nodiscard]] Status status() const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

 private:
  RoomFiles(std::filesystem::path folder, std::string room, Options options,
            std::vector<std::filesystem::path> new_names);

  core::Result<void> cutToWholeRecords();
  core::Result<void> setRefusedAside();
  core::Result<void> forceNames(std::uint64_t generation);

  const std::filesystem::path folder_;
  const std::string room_;
  const Options options_;
  const std::vector<std::filesystem::path> new_names_;  ///< folders in which open() has made folders
  std::atomic<std::uint64_t> generation_ = 0;
  std::atomic<std::uint64_t> log_bytes_ = 0;
  std::atomic<std::uint64_t> snapshot_generation_ = 0;
  std::atomic<std::uint64_t> snapshot_bytes_ = 0;
  /// Flushes fail until a snapshot of this generation or a later one is written.
  std::atomic<std::uint64_t> needed_snapshot_generation_ = 0;
  /// The names of the files up to this generation are on the disk.
  std::atomic<std::uint64_t> forced_names_generation_ = 0;
  std::uint64_t last_generation_ = 0;  ///< newest generation that has a log
  std::uint64_t refused_from_ = kNewest;
  bool is_recovered_ = false;

  std::mutex log_mutex_;                              ///< the log that is written
  std::shared_ptr<File> log_;                         ///< null before beginGeneration()
  std::vector<std::shared_ptr<File>> unforced_logs_;  ///< older ones that the next flush has to force
  std::uint64_t next_number_ = 1;                     ///< of the next record
  bool is_torn_ = false;  ///< bytes of a record that could not be written follow the whole ones
  bool is_full_ = false;  ///< a record found no space in the log

  std::mutex snapshot_mutex_;  ///< one snapshot is written at a time
};

}  // namespace spindrift::state
