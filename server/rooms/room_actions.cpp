#include <set>
#include <utility>

#include <fmt/format.h>

#include <spindrift/rooms/room_actions.h>

namespace spindrift::rooms {
namespace {

/// The rejection for a boat that belongs to another person or to none.
wire::CommandRejection notYours(std::string field, std::uint32_t boat_id, std::uint32_t owner_id) {
  return wire::rejection(v1::REJECT_REASON_NOT_YOURS, std::move(field),
                         owner_id == 0 ? fmt::format("boat {} is nobody's: take it first", boat_id)
                                       : fmt::format("boat {} is person {}'s", boat_id, owner_id));
}

}  // namespace

RoomActions::Outcome RoomActions::applyToWater(const Command& command) {
  if (auto refused = writeAhead(command)) return refused;
  return room_.water->apply(command.message);
}

void RoomActions::parameterChanged(const v1::SetParameter& change) {
  room_.tick_cost.workChanged(room_.water->work());
  room_.schedule.restart();  // the frame rate may have changed; by the old rate the next frame could be a second away
  room_.news.parameters[change.path()] = change.value();
}

void RoomActions::boatsChanged() {
  const std::set<std::uint32_t> on_the_water = room_.water->boatIds();
  room_.roster.keepOnly(on_the_water);
  std::erase_if(levers_, [&](const auto& entry) { return !on_the_water.contains(entry.first); });
  std::erase_if(grid_, [&](const auto& entry) { return !on_the_water.contains(entry.first); });
  room_.news.boats = true;
}

void RoomActions::stopBoat(std::uint32_t boat_id) {
  Command stop;
  stop.message.mutable_control_boat()->set_boat_id(boat_id);
  levers_.erase(boat_id);
  (void)applyToWater(stop);  // the boat may be gone already
}

RoomActions::Outcome RoomActions::reset(const Command& command) {
  if (auto rejected = applyToWater(command)) return rejected;
  room_.referee.end();
  levers_.clear();
  room_.schedule.restart();
  room_.schedule.setIdleDue({});
  dropSteps("the scene began again: the steps have ended");
  if (command.message.reset().has_seed()) room_.roster.keepOnly({});  // other boats have the numbers now
  room_.news.reset = true;
  room_.news.reset_person_id = command.sender.person_id;
  boatsChanged();
  return {};
}

// Strokes

RoomActions::Outcome RoomActions::draw(const Command& command) {
  Command signed_command = command;
  signed_command.message.mutable_stroke()->set_person_id(command.sender.person_id);
  return applyToWater(signed_command);
}

// Boats

RoomActions::Outcome RoomActions::spawnBoat(const Command& command) {
  const core::Sender& sender = command.sender;
  if (sender.role < core::Role::kOperator && room_.roster.hasBoat(sender.person_id)) {
    return wire::rejection(v1::REJECT_REASON_HAS_BOAT, "spawn_boat",
                           "you have a boat: remove it before you launch another");
  }
  Command launch = command;
  v1::Boat& boat = *launch.message.mutable_spawn_boat()->mutable_boat();
  std::optional<std::uint32_t> place;
  if (command.is_placed_by_room && room_.water->scene().has_course()) place = placeOnGrid(boat);
  v1::ControlBoat lever;
  lever.set_throttle_ratio(boat.throttle_ratio());
  lever.set_rudder_ratio(boat.rudder_ratio());
  if (isHeld(command)) boat.set_throttle_ratio(0.0);
  if (auto rejected = applyToWater(launch)) return rejected;
  boatsChanged();
  const std::uint32_t boat_id = room_.water->spawnedId();
  if (place) grid_[boat_id] = *place;
  lever.set_boat_id(boat_id);
  levers_[boat_id] = std::move(lever);
  new_ids_.set_boat_id(boat_id);
  room_.roster.give(boat_id, sender.person_id);
  return {};
}

RoomActions::Outcome RoomActions::controlBoat(const Command& command) {
  const std::uint32_t boat_id = command.message.control_boat().boat_id();
  const std::uint32_t owner_id = room_.roster.ownerOf(boat_id);
  const bool is_free_to_operators = owner_id == 0 && command.sender.role >= core::Role::kOperator;
  const bool is_own = owner_id != 0 && owner_id == command.sender.person_id;
  if (!is_own && !is_free_to_operators && isOnTheWater(boat_id)) {
    return notYours("control_boat.boat_id", boat_id, owner_id);
  }
  Command control = command;
  if (isHeld(command)) control.message.mutable_control_boat()->set_throttle_ratio(0.0);
  if (auto rejected = applyToWater(control)) return rejected;
  levers_[boat_id] = command.message.control_boat();
  return {};
}

RoomActions::Outcome RoomActions::removeBoat(const Command& command) {
  const std::uint32_t boat_id = command.message.remove_boat().boat_id();
  const std::uint32_t owner_id = room_.roster.ownerOf(boat_id);
  const bool is_own = owner_id != 0 && owner_id == command.sender.person_id;
  if (!is_own && command.sender.role < core::Role::kOperator && isOnTheWater(boat_id)) {
    return notYours("remove_boat.boat_id", boat_id, owner_id);
  }
  if (auto rejected = applyToWater(command)) return rejected;
  boatsChanged();
  return {};
}

RoomActions::Outcome RoomActions::takeBoat(const Command& command) {
  const core::Sender& sender = command.sender;
  const std::uint32_t boat_id = command.message.take_boat().boat_id();
  const char* const kField = "take_boat.boat_id";
  if (!isOnTheWater(boat_id)) {
    return wire::rejection(v1::REJECT_REASON_UNKNOWN_BOAT, kField,
                           fmt::format("there is no boat {} on the water", boat_id));
  }
  if (sender.person_id == 0) {
    return wire::rejection(v1::REJECT_REASON_FORBIDDEN, kField,
                           "only somebody in the room can take a boat: connect first");
  }
  const std::uint32_t owner_id = room_.roster.ownerOf(boat_id);
  if (owner_id == sender.person_id) return {};
  const bool is_operator = sender.role >= core::Role::kOperator;
  if (owner_id != 0 && !is_operator) return notYours(kField, boat_id, owner_id);
  if (!is_operator && room_.roster.hasBoat(sender.person_id)) {
    return wire::rejection(v1::REJECT_REASON_HAS_BOAT, kField, "you have a boat: remove it before you take another");
  }
  room_.roster.give(boat_id, sender.person_id);
  return {};
}

RoomActions::Outcome RoomActions::spawnFloater(const Command& command) {
  if (auto rejected = applyToWater(command)) return rejected;
  new_ids_.set_floater_id(room_.water->spawnedId());
  return {};
}

RoomActions::Outcome RoomActions::ask(const Command& command) {
  const core::Sender& sender = command.sender;
  const v1::Query& asked = command.message.query();
  // Streams end with their session, and the roster knows when that is.
  if (asked.interval_ticks() > 0 && !room_.roster.isConnected(sender.person_id, sender.session_id)) {
    return wire::rejection(v1::REJECT_REASON_FORBIDDEN, "query.interval_ticks",
                           "only somebody in the room's list of people can ask for a stream: ask for one answer (0)");
  }
  return room_.queries.enter(sender, asked, room_.water->tick());
}

}  // namespace spindrift::rooms
