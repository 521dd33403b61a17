// Commands on their way to one room. Each sender has a lane, lanes take turns, so that nobody waits behind what another
// one sent; within a lane commands keep their order.
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

#include <spindrift/core/command.h>

namespace spindrift::rooms {

/// Commands that rebuild or upload water (reset, scene, parameters, boats that come and go): they have a budget of
/// time.
[[nodiscard]] bool isHeavy(const core::Action& action);

/// Many producers on any thread, one consumer on the simulation thread.
class CommandQueue {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  struct Bounds {
    std::size_t max_count = 4096;                    ///< commands waiting in all lanes
    std::size_t lane_max_count = 512;                ///< commands of one sender: above its burst
    std::size_t lane_heavy_max_count = 64;           ///< heavy commands of one sender
    std::chrono::milliseconds heavy_wait_max{1000};  ///< heavy commands that wait longer are given up
  };

  CommandQueue() = default;
  explicit CommandQueue(const Bounds& bounds) : bounds_(bounds) {}

  /// Queues the command, or returns one line that says which bound it met.
  [[nodiscard]] std::optional<std::string> tryPush(core::Command command, TimePoint now);

  /// Commands that one piece of work answers: in order of arrival, at least one. All are alike in kind: one command; or
  /// values for the same parameter that one sender sent in a row; or the same reset or scene change by any senders.
  using Batch = std::vector<core::Command>;

  /// What may be taken now besides the light commands.
  struct Allowed {
    bool heavy = true;
    bool scene_change = true;  ///< needs `heavy` as well
  };
  /// The next batch, from the lane whose turn it is; nullopt when no lane has a command that may go.
  [[nodiscard]] std::optional<Batch> next(const Allowed& allowed);

  /// No command of the batch's senders is taken until release(): they sent it after this one, which takes a while.
  void hold(const Batch& batch);
  void release(const Batch& batch);

  /// Takes the first commands of lanes that equal `action`, held or not: they are answered with it.
  [[nodiscard]] Batch takeEqual(const core::Action& action);
  /// Takes heavy commands that have waited for longer than `heavy_wait_max` and do not belong to a held lane.
  [[nodiscard]] Batch takeExpired(TimePoint now);
  /// Takes everything.
  [[nodiscard]] Batch drain();

  [[nodiscard]] std::size_t size() const;

 private:
  /// A session's lane is its number; requests have a lane each, beyond those.
  using LaneKey = std::uint64_t;
  struct Entry {
    core::Command command;
    TimePoint arrived;
  };
  struct Lane {
    std::deque<Entry> entries;
    std::size_t heavy_count = 0;
    bool is_held = false;
  };

  static LaneKey keyOf(const core::Sender& sender);
  // With the mutex held:
  core::Command pop(Lane& lane);
  void takeEqual(const core::Action& action, Batch& out);
  /// Forgets a lane without commands, unless it is held.
  void tidy(LaneKey key);

  const Bounds bounds_{};
  mutable std::mutex mutex_;
  std::map<LaneKey, Lane> lanes_;
  std::deque<LaneKey> turns_;  ///< lanes with commands, the next one first
  std::size_t count_ = 0;
};

}  // namespace spindrift::rooms
