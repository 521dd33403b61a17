// Opens a room at once: waits until it is where it was.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <spindrift/rooms/room.h>

namespace spindrift::test {

inline core::Result<std::shared_ptr<rooms::Room>> openRoom(std::string name, std::unique_ptr<water::Water> water,
                                                           const rooms::RoomRules& rules, water::WaterBuilder& builder,
                                                           rooms::RoomOutlets& outlets, history::RoomPlace place) {
  auto room = rooms::Room::begin(std::move(name), std::move(water), rules, builder, outlets, std::move(place), {});
  if (!room) return room;
  using TimePoint = rooms::Room::TimePoint;
  if (const auto restored = (*room)->restoreUntil(TimePoint::max()); !restored) return restored.error();
  if (const auto kept = (*room)->isOnDisk(TimePoint::max()); !kept) return kept.error();
  return room;
}

}  // namespace spindrift::test
