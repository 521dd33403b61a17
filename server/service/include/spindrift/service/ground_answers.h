// The ground of a room's water for clients that draw it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include <spindrift/rooms/room.h>

namespace spindrift::service {

/// Any thread.
class GroundAnswers {
 public:
  /// Returns a serialized v1::Ground of the room's present scene; null if it has no wave. Keeps the newest answer of
  /// each room, because all clients of a room ask for the same one.
  [[nodiscard]] std::shared_ptr<const std::string> of(const std::shared_ptr<const rooms::Room>& room);

 private:
  struct Kept {
    std::weak_ptr<const rooms::Room> room;  ///< another room may have the name later
    std::uint64_t scene_version = 0;
    double depth_m = 0.0;  ///< of the wave: the parameter that moves the ground while a scene runs
    std::shared_ptr<const std::string> bytes;
    std::uint64_t used = 0;  ///< use_count_ at the last answer
  };
  std::mutex mutex_;
  std::map<std::string, Kept> kept_;  ///< by room; at most kKeptMaxCount, those that were asked for last
  std::uint64_t use_count_ = 0;
};

}  // namespace spindrift::service
