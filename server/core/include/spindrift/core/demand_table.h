// Which streams of a room are watched, and how: sessions change it, the simulation and the encoder read it.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <unordered_map>

#include <spindrift/core/level.h>

namespace spindrift::core {

/// Demand for the next frame of a layer, at one level, by the sessions that watch it.
struct LevelDemand {
  std::size_t watcher_count = 0;
  /// At least one session can take the next frame only as a keyframe: it is new, lost a frame, or skips frames.
  bool wants_keyframe = false;
  bool has_newcomer = false;  ///< at least one session has had no frame of the layer yet
};
/// Indexed by Level.
using StreamDemand = std::array<LevelDemand, kLevelCount>;

/// Returns the demand for the data of each level by a frame that only the levels in `due` take. `asked`: by the level
/// that sessions ask for, which has the data of kFull where it does not downsample the layer (`reduced_count`).
constexpr StreamDemand demandOfFrame(const StreamDemand& asked, std::uint32_t reduced_count,
                                     LevelSet due = LevelSet::all()) {
  StreamDemand out{};
  for (const Level level : kLevels) {
    if (!due.contains(level)) continue;
    const LevelDemand& one = asked[indexOf(level)];
    LevelDemand& of_data = out[indexOf(effectiveLevel(level, reduced_count))];
    of_data.watcher_count += one.watcher_count;
    of_data.wants_keyframe = of_data.wants_keyframe || one.wants_keyframe;
    of_data.has_newcomer = of_data.has_newcomer || one.has_newcomer;
  }
  return out;
}

/// A stream is a number below kStreamMaxCount. Any thread.
class DemandTable {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  static constexpr std::size_t kStreamMaxCount = 16;

  /// Need of a reader: the next frame of a stream, and in which form.
  struct Need {
    Level level = Level::kFull;                ///< that it asks for
    std::size_t watcher_count = 1;             ///< more than 1 for a reader that passes frames on
    bool is_newcomer = false;                  ///< it has had no frame of the layer yet
    std::optional<TimePoint> keyframe_from{};  ///< frames from this time on are of use as keyframes only
    bool operator==(const Need&) const = default;
  };
  /// Replaces what a reader needs of a stream; nullopt: nothing. `reader` is an address of its own, and not followed.
  void set(std::size_t stream, const void* reader, const std::optional<Need>& need);
  /// Adds to the number of sessions in the room; negative: subtracts.
  void addSessions(std::ptrdiff_t count);

  /// Returns the demand for a frame of the stream that comes at this time, by the level that readers ask for;
  /// demandOfFrame() gives it by the data of each level.
  [[nodiscard]] StreamDemand of(std::size_t stream, TimePoint when) const;
  [[nodiscard]] std::size_t sessionCount() const;

 private:
  struct Stream {
    std::array<std::size_t, kLevelCount> watcher_counts{};
    std::array<std::size_t, kLevelCount> newcomer_counts{};
    std::size_t keyframe_need_count = 0;  ///< needs with keyframe_from
    std::unordered_map<const void*, Need> needs;
  };

  mutable std::mutex mutex_;
  std::array<Stream, kStreamMaxCount> streams_;
  std::size_t session_count_ = 0;
};

}  // namespace spindrift::core
