// What commands do in a room: to its water, its time, and to boats, gauges and their owners.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <spindrift/rooms/command.h>
#include <spindrift/rooms/room_data.h>
#include <spindrift/water/room_water.h>

namespace spindrift::rooms {

/// Each action writes what it does to the diary first, and is rejected if the disk refuses.
class RoomActions {
 public:
  using Outcome = water::RoomWater::Outcome;
  using TimePoint = std::chrono::steady_clock::time_point;

  explicit RoomActions(RoomData& room) : room_(room) {}

  /// Applies a command that changes nothing but the water.
  Outcome applyToWater(const Command& command);
  /// A parameter has another value: updates what follows from it.
  void parameterChanged(const v1::SetParameter& change);
  /// Boats were added or removed: ends the ownership of removed boats and announces the boats.
  void boatsChanged();

  /// Other water: ends the ownership of boats that it lacks, and puts the gauges that people have placed into it if it
  /// continues the same water.
  void waterChanged(bool continues);
  /// Takes out the gauges of people who have left the room.
  void removeGaugesOfGone();

  /// Moves the game on after a tick: starts the boats of a race, and puts the ball where it belongs.
  void advanceGame();
  /// Ends the game, and takes its ball out of the water.
  void clearGame();

  /// Stops a boat whose owner has left, or may not steer now.
  void stopBoat(std::uint32_t boat_id);

  /// Takes the clock from holders who have left, who are not alone any more, or who are silent for too long. `is_busy`:
  /// the room is still occupied with commands of this sender.
  void reviewClock(TimePoint now, const std::function<bool(const core::Sender&)>& is_busy);
  /// Ends all steps that are still to come. `why`: for those who wait for theirs.
  void dropSteps(const std::string& why);

  // One per kind of command that does more; see the table in command_desk.cpp.
  Outcome reset(const Command& command);
  Outcome setPaused(const Command& command);
  Outcome setSpeed(const Command& command);
  Outcome advance(const Command& command);
  Outcome takeClock(const Command& command);
  Outcome releaseClock(const Command& command);
  Outcome draw(const Command& command);
  Outcome spawnBoat(const Command& command);
  Outcome controlBoat(const Command& command);
  Outcome removeBoat(const Command& command);
  Outcome takeBoat(const Command& command);
  Outcome spawnFloater(const Command& command);
  Outcome holdFloater(const Command& command);
  Outcome removeFloater(const Command& command);
  Outcome setLesson(const Command& command);
  Outcome mutePerson(const Command& command);
  Outcome setTeam(const Command& command);
  Outcome startGame(const Command& command);
  Outcome endGame(const Command& command);
  Outcome placeGauge(const Command& command);
  Outcome removeGauge(const Command& command);
  /// Enters a query into the room's book, or ends a stream.
  Outcome ask(const Command& command);

  /// Returns the ids that the last command gave out, once, in an Ack without anything else.
  [[nodiscard]] v1::Ack takeNewIds() { return std::exchange(new_ids_, {}); }

 private:
  [[nodiscard]] Outcome writeAhead(const Command& command) { return room_.diary.writeAhead(command.message); }
  [[nodiscard]] bool isOnTheWater(std::uint32_t boat_id) const { return room_.water->boatIds().contains(boat_id); }

  [[nodiscard]] std::string holderNames() const;
  /// Rejects what changes the time of a room whose clock somebody holds.
  [[nodiscard]] Outcome refuseHeld(const char* field) const;
  /// Takes the clock from the holders for which `holds` returns true. `how`: what they did, for people. `person_id`:
  /// whose command it was; 0: nobody's.
  void loseClock(const std::function<bool(const HeldClock::Holder&)>& holds, const std::string& how,
                 std::uint32_t person_id);
  void tellClock(const std::string& what, std::uint32_t person_id);

  [[nodiscard]] bool isHeld(const Command& command) const {
    return room_.referee.holdsBoats() && command.sender.role < core::Role::kOperator;
  }
  /// Returns whether the lesson lets the owner of a boat steer.
  [[nodiscard]] bool maySteer(const Roster::BoatOwner& owner) const;
  void stopBoatsOfIdle();
  /// Stops the boats of players before a race; releaseBoats() gives them the throttles that their owners hold.
  void holdBoats();
  void releaseBoats();
  void putBall(const Referee::Position& spot);
  void removeBall();
  /// Returns whether a player means the ball of the game.
  [[nodiscard]] bool isBall(const Command& command, std::uint32_t floater_id) const;
  static wire::CommandRejection notTheBall(const char* field);
  /// Moves a new boat to the next free place of the grid behind the start and returns that place; leaves the boat where
  /// it is when no place is left. A place is free when no boat on the water was launched there.
  std::optional<std::uint32_t> placeOnGrid(v1::Boat& boat);

  /// Replaces the gauges that people have placed; a refusal changes nothing.
  Outcome putGauges(std::vector<PlacedGauge> gauges);

  RoomData& room_;
  v1::Ack new_ids_;
  std::uint32_t last_gauge_id_ = 0;
  std::map<std::uint32_t, v1::ControlBoat> levers_;  ///< by boat: as their owners hold them, also before a start
  std::map<std::uint32_t, std::uint32_t> grid_;      ///< places by boat
};

}  // namespace spindrift::rooms
