// Keeps the state of one room on disk: a log of what happens, and snapshots from time to time (state/room_files.h).
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/core/worker.h>
#include <spindrift/state/folders.h>
#include <spindrift/state/room_files.h>
#include <spindrift/v1/kept_state.pb.h>

namespace spindrift::history {

/// A room as it is kept: a state, and what happened after it.
struct KeptRoom {
  std::shared_ptr<const v1::KeptState> state;  ///< never null
  std::vector<v1::Record> records;             ///< after the state, in order
};

/// Lives on the room's thread, except for the functions marked "any thread".
class StateKeeper {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Takes over files that recover() was called on. `writer` writes the snapshots; it outlives this. `lock` is held as
  /// long as the files are; it may be null.
  StateKeeper(std::string room, std::unique_ptr<state::RoomFiles> files, std::chrono::milliseconds interval,
              core::Worker& writer, state::FolderLock lock = nullptr);
  /// Waits for a snapshot that is being written.
  ~StateKeeper();
  StateKeeper(const StateKeeper&) = delete;
  StateKeeper& operator=(const StateKeeper&) = delete;

  /// Appends what is about to happen; when it returns, a killed process does not lose it. After an error it must not
  /// happen.
  core::Result<void> append(const v1::Record& record);
  /// The same for what has happened already. A failure opens a gap().
  void appendWhatHappened(const v1::Record& record);
  /// Call before the senders of appended commands get their answers: with Sync::kAlways, forces the log to the disk. A
  /// failure opens a gap().
  core::Result<void> flush();
  /// The log does not say what happened just now. A snapshot of a later state closes the gap.
  void openGap(const std::string& why);
  /// Why the log does not say everything, and what to do; nullopt if it does.
  [[nodiscard]] std::optional<std::string> gap() const;

  /// Returns whether a snapshot is due now: somebody asked; one second has passed since the last one failed or a gap
  /// opened; or the interval has passed and there is something new, in the log or, `has_water_changed`, in the water.
  /// Never while one is being written.
  [[nodiscard]] bool isDue(TimePoint now, bool has_water_changed) const;
  /// Any thread. A snapshot as soon as possible.
  void ask() { is_asked_ = true; }
  /// Writes a snapshot beside the room, and begins a new log where one is needed. `state` is of this moment; copying it
  /// took `copy_s`.
  void save(v1::KeptState state, TimePoint now, double copy_s);
  /// Returns how the last save() ended; nullopt if it is being written still at the deadline.
  [[nodiscard]] std::optional<core::Result<void>> outcome(TimePoint deadline) const;

  /// Waits for a snapshot that is being written.
  void finish() const;
  /// Returns what a restart would find; nullopt if more happened since than this remembers, or there is a gap.
  [[nodiscard]] std::optional<KeptRoom> newest() const;

  /// Any thread.
  struct Status {
    state::RoomFiles::Status files;
    std::uint64_t snapshot_count = 0;  ///< written since the start
    std::uint64_t failure_count = 0;   ///< failed snapshots and records
    double since_snapshot_s = 0.0;     ///< since the state of the newest one was copied; since the start without one
    double copy_s = 0.0;               ///< for which the room stood still for the last snapshot
    double write_s = 0.0;              ///< duration of the last write, beside the room
  };
  [[nodiscard]] Status status() const;

 private:
  /// On the writer's thread. `known_gap_count`: gaps that had opened when the state was copied.
  void write(const state::StatePoint& point, const v1::KeptState& state, TimePoint copied,
             std::uint64_t known_gap_count);
  /// A snapshot has ended; call it with the mutex held.
  void end(core::Result<void> how);
  /// Counts and logs the error; call it with the mutex held.
  void note(const core::Error& error);

  const std::string room_;
  const state::FolderLock lock_;  ///< before the files, which end first
  const std::unique_ptr<state::RoomFiles> files_;
  const std::chrono::milliseconds interval_;
  core::Worker& writer_;
  TimePoint next_{};
  std::atomic<bool> is_asked_ = false;
  KeptRoom newest_{};  ///< without a state if there was too much since
  std::size_t records_bytes_ = 0;

  mutable std::mutex mutex_;  ///< guards all below
  mutable std::condition_variable finished_;
  bool is_writing_ = false;
  core::Result<void> outcome_;  ///< of the last snapshot
  /// Why the log lacks something that happened. A snapshot of a later state holds it.
  std::optional<std::string> gap_;
  std::uint64_t gap_count_ = 0;       ///< gaps since the start
  std::optional<TimePoint> retry_{};  ///< of the snapshot, after one failed or a gap opened
  std::string logged_error_;
  std::string logged_removal_;
  TimePoint logged_at_{};
  std::uint64_t snapshot_count_ = 0;
  std::uint64_t failure_count_ = 0;
  TimePoint newest_copy_ = std::chrono::steady_clock::now();
  double copy_s_ = 0.0;
  double write_s_ = 0.0;
};

}  // namespace spindrift::history
