// Tells those who move boats of a room what the water did to the hulls, tick by tick.
#pragma once

#include <cstdint>
#include <deque>

#include <spindrift/rooms/room_data.h>

namespace spindrift::rooms {

class RoomHulls {
 public:
  explicit RoomHulls(RoomData& room) : room_(room) {}

  /// Notes which tick was made, and who moved boats in it. Does nothing while nobody does.
  void ticked();
  /// Passes on the forces that have come back from the device.
  void handOver();
  /// Returns whether forces are on their way from the device.
  [[nodiscard]] bool isWaiting() const { return !ticks_.empty(); }
  /// Other water: what was on its way is lost.
  void waterChanged() { ticks_.clear(); }

 private:
  struct Tick {
    std::uint64_t water_tick = 0;  ///< sim::WaterSim::tick()
    std::uint64_t tick = 0;
    double time_s = 0.0;
    std::uint64_t state_id = 0;
    Movers movers{};
  };
  void tell(const Tick& tick, const sim::HullForces& forces);

  RoomData& room_;
  std::deque<Tick> ticks_;  ///< oldest first; bounded by the ticks in flight
};

}  // namespace spindrift::rooms
