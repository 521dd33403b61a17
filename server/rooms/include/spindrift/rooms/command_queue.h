// Commands waiting for one room. Each sender has a lane, and lanes take turns, so that no sender waits behind the
// backlog of another; within a lane commands keep their order.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <spindrift/rooms/command.h>

namespace spindrift::rooms {

/// Many producers on any thread, one consumer on the simulation thread.
class CommandQueue {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  struct Bounds {
    std::size_t max_count = 4096;                    ///< commands waiting in all lanes
    std::size_t lane_max_count = 512;                ///< commands of one sender; more than its burst
    std::size_t lane_heavy_max_count = 64;           ///< heavy commands of one sender
    std::chrono::milliseconds heavy_wait_max{1000};  ///< heavy commands that wait longer are rejected
  };

  CommandQueue() = default;
  explicit CommandQueue(const Bounds& bounds) : bounds_(bounds) {}

  /// Queues the command; otherwise returns one line that names the bound that was reached.
  [[nodiscard]] std::optional<std::string> tryPush(Command command, TimePoint now);

  /// Commands that are carried out together, in order of arrival, at least one: one command; or consecutive values of
  /// one sender for the same parameter; or the same reset or scene change from any senders.
  using Batch = std::vector<Command>;

  /// Kinds of commands that may be taken now in addition to light ones.
  struct Allowed {
    bool heavy = true;
    bool scene_change = true;  ///< requires `heavy` too
    /// Values of one sender for the same parameter may be taken together. How many there are depends on how fast they
    /// are taken.
    bool joined_values = true;
  };
  /// Returns the next batch, from the lane whose turn it is; nullopt when no lane has an allowed command.
  [[nodiscard]] std::optional<Batch> next(const Allowed& allowed);

  /// Blocks the lanes of the batch's senders until release(), because this batch takes a while and later commands must
  /// wait.
  void hold(const Batch& batch);
  void release(const Batch& batch);
  /// Returns whether commands of this sender wait, or its lane is blocked.
  [[nodiscard]] bool isBusyWith(const core::Sender& sender) const;

  /// Takes the first commands of lanes, held or not, that equal `command`: they get the same answer.
  [[nodiscard]] Batch takeEqual(const v1::Command& command);
  /// Takes heavy commands that have waited for longer than `heavy_wait_max` and do not belong to a held lane.
  [[nodiscard]] Batch takeExpired(TimePoint now);
  /// Takes all commands.
  [[nodiscard]] Batch drain();

  [[nodiscard]] std::size_t size() const;

 private:
  /// The lane of a session is its number; each HTTP request has a lane of its own with a larger number.
  using LaneKey = std::uint64_t;
  struct Entry {
    Command command;
    TimePoint arrived;
  };
  struct Lane {
    std::deque<Entry> entries;
    std::size_t heavy_count = 0;
    bool is_held = false;
  };

  static LaneKey keyOf(const core::Sender& sender);
  // Call with the mutex held:
  Command pop(Lane& lane);
  void takeEqual(const v1::Command& command, Batch& out);
  /// Removes a lane without commands, unless it is held.
  void tidy(LaneKey key);

  const Bounds bounds_{};
  mutable std::mutex mutex_;
  std::map<LaneKey, Lane> lanes_;
  std::deque<LaneKey> turns_;  ///< lanes with commands, in the order of their turns
  std::size_t count_ = 0;
};

}  // namespace spindrift::rooms
