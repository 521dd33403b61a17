// What the parts of a room work on.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <spindrift/classroom/referee.h>
#include <spindrift/core/demand_table.h>
#include <spindrift/history/diary.h>
#include <spindrift/rooms/frame_schedule.h>
#include <spindrift/rooms/held_clock.h>
#include <spindrift/rooms/placed_gauge.h>
#include <spindrift/rooms/query_book.h>
#include <spindrift/rooms/room_outlets.h>
#include <spindrift/rooms/room_rules.h>
#include <spindrift/rooms/room_time.h>
#include <spindrift/rooms/roster.h>
#include <spindrift/rooms/step_book.h>
#include <spindrift/rooms/tick_meter.h>
#include <spindrift/v1/kept_state.pb.h>
#include <spindrift/v1/scene.pb.h>
#include <spindrift/water/room_water.h>
#include <spindrift/water/tick_cost.h>
#include <spindrift/water/water_builder.h>

namespace spindrift::rooms {

/// Load of the server, as of this round of a room.
struct ServerLoad {
  std::size_t people_count = 0;  ///< present ones, in all rooms
  double thread_share = 0.0;     ///< share of its time that the simulation thread was busy lately
};

/// Changes that the clients have not been told about yet.
struct News {
  bool state = false;  ///< pause, speed, or who holds the clock
  bool boats = false;
  bool gauges = false;  ///< those that people have placed
  bool reset = false;
  std::uint32_t state_person_id = 0;  ///< who changed that last; 0: nobody in the room
  std::uint32_t reset_person_id = 0;
  bool lesson = false;
  std::map<std::string, double> parameters{};  ///< current values by path
  std::string recovered{};                     ///< one line for people, after the device failed
  std::string fidelity{};                      ///< the same, after the fidelity changed
  std::string clock{};                         ///< the same: who took the clock, or does not hold it any more
  std::uint32_t clock_person_id = 0;           ///< whose command that was; 0: nobody's
};

/// Belongs to a room, and outlives its parts. For the simulation thread, except for name, access, roster and demand.
struct RoomData {
  const Room& self;  ///< whose data it is
  const std::string name;
  v1::RoomAccess access;  ///< set by Room::begin() and restoreUntil() only
  const RoomRules& rules;
  water::WaterBuilder& builder;
  RoomOutlets& outlets;
  std::unique_ptr<water::RoomWater> water;  ///< null after Room::releaseDevice()
  history::Diary diary;
  Roster roster;
  const std::shared_ptr<core::DemandTable> demand = std::make_shared<core::DemandTable>();
  RoomTime time{water->sim().derived().tick_s};
  HeldClock clock{};
  StepBook steps{};
  water::TickCost tick_cost{};
  TickMeter tick_meter{};
  FrameSchedule schedule{};
  Referee referee{};                  ///< of the game in the room
  std::vector<PlacedGauge> gauges{};  ///< that people have placed, oldest first
  QueryBook queries{};
  ServerLoad load{};
  v1::Fidelity chosen_fidelity = water->scene().fidelity();  ///< or chosen by a person; adapting never goes above it
  News news{};
};

}  // namespace spindrift::rooms
